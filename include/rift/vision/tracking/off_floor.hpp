#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/tracking/tag_options.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"

namespace rift::vision {

/// Notices a tag that never lies on the floor: its side or its height is another than told, or the
/// camera was moved since the world frame was set.
class OffFloorCheck {
 public:
  /// Both must outlive it.
  OffFloorCheck(const CameraModel& camera, const TagOptions& tag);

  /// Whether a floor is known to which the tag is held: not that of a frame from a first pose.
  bool HasFloor() const { return has_floor_; }

  /// One line, once, when almost all sightings were off the floor.
  std::optional<std::string> Add(const Sighting& sighting);

 private:
  std::string Warning() const;

  const CameraModel& camera_;
  const TagOptions& tag_;
  bool has_floor_;
  std::size_t sightings_ = 0;
  std::vector<double> z_m_;  ///< of those off the floor
  bool is_said_ = false;
};

}  // namespace rift::vision
