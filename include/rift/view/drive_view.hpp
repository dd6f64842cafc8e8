#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rift/control/controller.hpp"
#include "rift/view/track_window.hpp"

namespace rift::view {

/// The window of `rift drive`: the camera's picture with tag, trail and waypoints.
class DriveView {
 public:
  /// `camera` must outlive it. Throws std::runtime_error with MissingDisplay() where that is not
  /// empty.
  DriveView(const vision::CameraModel& camera, const control::Task& task);

  /// False when the user wants the robot to be stopped. `frame` is none before the first picture.
  /// `placement`: how far the robot is from its start, in words, while it waits for it; the outline
  /// of where it has to stand is drawn as well. Empty once it drives.
  bool Show(const vision::Frame* frame, const std::optional<vision::Sighting>& sighting,
            const vision::CaptureStatus& status, const std::string& placement);

 private:
  geometry::Pose2 start_;
  TrackScene scene_;
  TrackWindow window_;
};

}  // namespace rift::view
