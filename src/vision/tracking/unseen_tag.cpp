#include "rift/vision/tracking/unseen_tag.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "rift/vision/camera/picture_reader.hpp"
#include "rift/vision/tracking/tag_detector.hpp"

namespace rift::vision {
namespace {

/// A picture as it is seen in a mirror; none of one that is damaged.
std::optional<Frame> Mirrored(const Frame& frame) {
  std::optional<GreyPatch> grey = PictureReader().Read(frame);
  if (!grey) return std::nullopt;
  const std::ptrdiff_t width = grey->region.width_px;
  for (auto row = grey->pixels.begin(); row != grey->pixels.end(); row += width) {
    std::reverse(row, row + width);
  }
  Frame mirrored{.width_px = frame.width_px, .height_px = frame.height_px};
  mirrored.format = PixelFormat::kGrey;
  mirrored.bytes = std::move(grey->pixels);
  return mirrored;
}

/// Every tag of every family. Bits are not corrected, since each further one makes chance hits.
std::vector<TagInPicture> TagsOfAnyFamily(const Frame& frame, TagOptions options) {
  std::vector<TagInPicture> found;
  options.max_hamming = 0;
  for (std::size_t i = 0; i < EnumNames(TagFamily{}).size(); ++i) {
    options.family = static_cast<TagFamily>(i);
    for (const TagDetection& tag : FindTags(frame, 1, options)) {
      found.push_back({options.family, tag.id});
    }
  }
  return found;
}

}  // namespace

InsteadOfTag LookForOthers(const Frame& frame, const TagOptions& tag,
                           const std::vector<int>& further_ids) {
  InsteadOfTag instead{.others = TagsOfAnyFamily(frame, tag)};
  const auto was_asked_for = [&](const TagInPicture& found) {
    const bool is_further =
        std::find(further_ids.begin(), further_ids.end(), found.id) != further_ids.end();
    return found.family == tag.family && (found.id == tag.id || is_further);
  };
  instead.is_unmeasured = std::erase_if(instead.others, was_asked_for) > 0;
  if (instead.is_unmeasured) return instead;
  const std::optional<Frame> mirrored = Mirrored(frame);
  if (!mirrored) return instead;
  const std::vector<TagDetection> seen = FindTags(*mirrored, 1, tag);
  instead.is_mirrored = std::any_of(seen.begin(), seen.end(),
                                    [&](const TagDetection& found) { return found.id == tag.id; });
  return instead;
}

}  // namespace rift::vision
