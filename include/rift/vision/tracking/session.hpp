#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/camera/capture_thread.hpp"
#include "rift/vision/tracking/tag_options.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"

namespace rift::vision {

/// What a picture shows beside the robot's pose.
struct Look {
  int robot_tags = 0;             ///< tags with the robot's id
  std::optional<double> moved_m;  ///< see MovedBy_m; none: no reference tag is known or seen
};

/// The camera above the floor and its calibration: the one set-up of `track` and `drive`.
class CameraSession {
 public:
  /// Opens the camera in a thread of its own. What was calibrated at one size is asked of a device
  /// at that size; without a size, at that of `capture`.
  CameraSession(std::string name, CameraModel camera, CaptureOptions capture,
                const TagOptions& tag);

  /// Waits for the first picture. A calibration without a size is taken to be for this picture's.
  /// Throws std::runtime_error with the camera's state when none comes, std::invalid_argument when
  /// the picture has another size than the calibration. None when `go_on`, asked ten times a
  /// second, says no.
  std::optional<Frame> FirstPicture(const std::function<bool()>& go_on = [] { return true; });
  /// Throws std::invalid_argument for a picture of another size than the calibration: its pixels
  /// are of other rays.
  void RequireSize(const Frame& frame) const;
  /// Finds every tag in a picture; see TagDetector for `decimate`.
  Look LookAt(const Frame& frame, int decimate) const;
  /// A recording is read again from its first picture.
  void Restart();
  void SetWorld(WorldFrame world) { camera_.world = std::move(world); }

  const CameraModel& camera() const { return camera_; }
  const CaptureOptions& options() const { return options_; }  ///< as the camera was asked
  const TagOptions& tag() const { return tag_; }
  /// With the latency of each sighting. further_ids: robots beside tag().id.
  TagTracker MakeTracker(const std::vector<int>& further_ids = {}) const;
  Capture& capture() { return *capture_; }
  /// The capture for somebody else; this session has none any more.
  std::unique_ptr<Capture> TakeCapture() { return std::move(capture_); }

 private:
  std::string name_;
  CameraModel camera_;
  CaptureOptions options_;
  TagOptions tag_;
  std::unique_ptr<Capture> capture_;
};

/// What to tell when the reference tags lie further off than `limit_m`: the camera was moved.
std::optional<std::string> MovedWarning(const std::optional<double>& moved_m, double limit_m);

/// What to tell when a world frame was set by reference tags and none of them is to be seen.
std::optional<std::string> UnseenReferences(const CameraModel& camera, const Look& look);

}  // namespace rift::vision
