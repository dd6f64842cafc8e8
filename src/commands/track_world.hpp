#pragma once

#include <functional>
#include <string>

#include "rift/experiment/track_options.hpp"
#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/camera/capture_thread.hpp"
#include "track_session.hpp"

namespace rift::commands {

/// What a world frame is set with.
struct WorldParts {
  vision::Capture& capture;
  const experiment::TrackOptions& options;
  const SessionOptions& session;
  std::function<bool()> is_stopped;
  std::function<void(const std::string&)> say;
};

/// Sets the world frame of `camera`, as `wish` says it:
///   first      origin on the floor below the robot's tag, x where it looks
///   FILE.yaml  its `tags:` (id, x_m, y_m, z_m) are looked for, or its `points:` (name, x_m, y_m,
///              z_m) are clicked in a window, in their order
/// Throws std::invalid_argument for a file that is none, tags not seen in time, points that make no
/// frame; std::runtime_error when the camera fails, the user ends it, or there is no window.
vision::WorldFrame SetWorld(const WorldParts& parts, const vision::CameraModel& camera,
                            const std::string& wish);

}  // namespace rift::commands
