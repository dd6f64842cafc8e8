#pragma once

#include <vector>

#include "rift/vision/camera/frame.hpp"
#include "rift/vision/tracking/tag_options.hpp"

namespace rift::vision {

/// A tag in a picture, whoever's.
struct TagInPicture {
  TagFamily family = TagFamily::k36h11;
  int id = 0;
};

/// What a picture shows in place of the tags that were asked for, none of which was measured in it.
struct InsteadOfTag {
  std::vector<TagInPicture> others;  ///< of any family
  bool is_unmeasured = false;        ///< a tag that was asked for, unfit to be measured
  bool is_mirrored = false;          ///< the picture's mirror image shows the session's tag
};

/// `tag`: the session's, `further_ids`: those of its family that were asked for as well.
InsteadOfTag LookForOthers(const Frame& frame, const TagOptions& tag,
                           const std::vector<int>& further_ids = {});

}  // namespace rift::vision
