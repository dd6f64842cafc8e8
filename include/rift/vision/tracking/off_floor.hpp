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
  OffFloorCheck(const CameraModel& camera, const TagOptions& tag) : camera_(camera), tag_(tag) {}

  /// One line, once, when almost all sightings were off the floor.
  std::optional<std::string> Add(const Sighting& sighting);

 private:
  std::string Warning() const;

  const CameraModel& camera_;
  const TagOptions& tag_;
  std::size_t sightings_ = 0;
  std::vector<double> z_m_;  ///< of those off the floor
  bool is_said_ = false;
};

}  // namespace rift::vision
