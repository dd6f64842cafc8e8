#pragma once

#include <Eigen/Core>
#include <mutex>
#include <optional>
#include <string>

#include "rift/vision/tracking/off_floor.hpp"

namespace rift::sessions {

/// Notices before a drive that the tag of a robot at rest is not on the floor: its side or height
/// is not what was told. A robot that is carried to its start, which is off the floor as well, is
/// not at rest. Sightings come from the camera's thread.
class StandingCheck {
 public:
  /// Both must outlive it.
  StandingCheck(const vision::CameraModel& camera, const vision::TagOptions& tag)
      : camera_(camera), tag_(tag) {}

  void Add(const vision::Sighting& sighting);
  /// One line, once.
  std::optional<std::string> Take();

 private:
  const vision::CameraModel& camera_;
  const vision::TagOptions& tag_;
  std::mutex mutex_;                            // guards what follows
  std::optional<vision::OffFloorCheck> check_;  // since the tag rests at rests_px_
  Eigen::Vector2d rests_px_ = Eigen::Vector2d::Zero();
  std::optional<std::string> warning_;
  bool is_found_ = false;
};

}  // namespace rift::sessions
