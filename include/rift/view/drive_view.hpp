#pragma once

#include <optional>
#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/view/track_window.hpp"

namespace rift::view {

/// The window of `rift drive`: the camera's picture with tag, trail and waypoints.
class DriveView {
 public:
  /// `camera` must outlive it. Throws std::runtime_error with MissingDisplay() where that is not
  /// empty.
  DriveView(const vision::CameraModel& camera, const std::vector<control::Waypoint>& waypoints);

  /// False when the user wants the robot to be stopped. `frame` is none before the first picture.
  bool Show(const vision::Frame* frame, const std::optional<vision::Sighting>& sighting,
            const vision::CaptureStatus& status);

 private:
  TrackScene scene_;
  TrackWindow window_;
};

}  // namespace rift::view
