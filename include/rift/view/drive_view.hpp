#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rift/control/controller.hpp"
#include "rift/view/track_window.hpp"

namespace rift::view {

/// What the user wants of a robot.
enum class DriveWish {
  kGoOn,
  kStopByKey,  ///< a key in the window
  kStopByClosing,
};

/// `is_started`: somebody has let the robot start. From then on every key that the window is told
/// of stops it, also Shift or Alt alone: a hand that looks for a key must not miss. Before, q and
/// Escape do; to other keys the robot has done nothing yet.
DriveWish WishOf(const TrackInput& input, bool is_started);

/// The window of `rift drive`: the camera's picture with tag, trail and waypoints.
class DriveView {
 public:
  /// `camera` must outlive it.
  DriveView(const vision::CameraModel& camera, const control::Task& task,
            ShowScene show = InWindow("rift drive"));

  /// `frame` is none before the first picture. `placement`: how far the robot is from its start, in
  /// words, while it waits for it; the outline of where it has to stand is drawn as well. Empty
  /// once it drives, from where its trail begins. `is_started` as in WishOf.
  DriveWish Show(const vision::Frame* frame, const std::optional<vision::Sighting>& sighting,
                 const vision::CaptureStatus& status, const std::string& placement,
                 bool is_started);

 private:
  geometry::Pose2 start_;
  TrackScene scene_;
  ShowScene show_;
};

}  // namespace rift::view
