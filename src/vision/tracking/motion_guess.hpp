#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "rift/vision/camera/frame.hpp"
#include "rift/vision/tracking/tag_detector.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"

namespace rift::vision {

/// Where a tag will be, from the last two times it was seen: it goes on moving and turning as it
/// did.
class MotionGuess {
 public:
  void Saw(const Sighting& sighting);
  void Forget();

  /// Corners in the picture. None when nothing was seen in the `lost_after_s` before t_s.
  std::optional<TagCorners> CornersAt(double t_s, double lost_after_s) const;
  /// The pose on the same condition, with a covariance that grows with the time since then: by
  /// kAcceleration_mps2 and kTurn_radps2, what motors and steering may do meanwhile.
  std::optional<Sighting> PoseAt(double t_s, double lost_after_s) const;
  /// The last sighting, however old; none before the first.
  const std::optional<Sighting>& Last() const { return last_; }

 private:
  bool IsKnownAt(double t_s, double lost_after_s) const;
  bool HasSpeed(double lost_after_s) const;

  std::optional<Sighting> last_;
  std::optional<Sighting> before_;
};

/// The pixels around the corners with `spare_px` to spare.
Region Around(const TagCorners& corners, double spare_px);

/// Mean length of the four sides.
double Side_px(const TagCorners& corners);

}  // namespace rift::vision
