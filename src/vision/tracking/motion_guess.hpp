#pragma once

#include <optional>

#include "rift/vision/camera/grey_patch.hpp"
#include "rift/vision/tracking/tag_detector.hpp"

namespace rift::vision {

/// Where the corners will be, from the last two times they were seen: the square goes on moving and
/// turning as it did.
class MotionGuess {
 public:
  void Saw(double t_s, const TagCorners& corners);
  void Forget();
  /// None when nothing was seen in the `lost_after_s` before t_s.
  std::optional<TagCorners> At(double t_s, double lost_after_s) const;

 private:
  struct Seen {
    double t_s;
    TagCorners corners;
  };
  std::optional<Seen> last_;
  std::optional<Seen> before_;
};

/// The pixels around the corners with `margin` sides of the square to spare.
Region Around(const TagCorners& corners, double margin);

/// Mean length of the four sides.
double Side_px(const TagCorners& corners);

}  // namespace rift::vision
