#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rift/control/controller.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/trajectory/trajectory.hpp"
#include "rift/twin/options.hpp"
#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"

namespace rift::twin {

/// A 1080p camera that looks straight down on the middle of the path, calibrated without
/// error. Its intrinsics are about those of the authors' webcam, whose own distortion (2.83 px RMS)
/// bends the picture's rim over. Throws std::invalid_argument when the path leaves the
/// picture and says how high the camera would have to hang.
vision::CameraModel OverheadCamera(const control::Task& task, const TwinOptions& options);

/// Everything one twin depends on.
struct TwinSetup {
  simulation::SimulationOptions simulation;  ///< as AsTwin makes it
  TwinOptions twin;
  geometry::Pose2 start;  ///< world_from_robot, middle of the axle
  std::uint64_t seed = 1;
  std::shared_ptr<const simulation::HeightImage> image;
  vision::CameraModel camera;
  vision::SyntheticCameraOptions look;  ///< of its pictures
};

/// Where it can be reached.
struct TwinAddress {
  std::string port;    ///< of the serial line
  std::string camera;  ///< URL of the stream
};

/// What was seen at the moment of each picture.
struct TwinRun {
  bool is_over = false;  ///< the robot drove and stood still again; else stopped from outside
  bool has_driven = false;
  trajectory::Trajectory truth;  ///< middle of the axle; times since the twin began
  trajectory::Trajectory tag;    ///< its tag at the moment of every picture since the first client
  double began_s = 0.0;          ///< on the steady clock
  double skipped_s = 0.0;        ///< of real time, since the process stood still
  std::size_t pictures = 0;
  double picture_cpu_s = 0.0;       ///< of one core for each of them
  double picture_late_p99_s = 0.0;  ///< how much later than planned a picture was published
  unsigned stops = 0;               ///< of the robot by itself, modulo 256
  unsigned rejected = 0;            ///< frames and lines that it did not obey, modulo 256
};

/// Runs the robot in real time behind a serial port and an http camera. `announce` is called once
/// both can be opened; `is_stopped` is asked many times a second. Throws what goes wrong in any of
/// its threads.
TwinRun RunTwin(const TwinSetup& setup, const std::function<void(const TwinAddress&)>& announce,
                const std::function<bool()>& is_stopped);

}  // namespace rift::twin
