#pragma once

#include <deque>
#include <mutex>

#include "rift/simulation/mocap.hpp"
#include "rift/trajectory/trajectory.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"

namespace rift::twin {

/// Where the robot has been. One thread adds, any may ask.
class TruePath {
 public:
  explicit TruePath(const simulation::TruePose& start);

  void Add(const simulation::TruePose& pose);
  /// At that time, which is not in the future, with the velocity then. The last few seconds only.
  struct Moment {
    simulation::TruePose pose;
    double vx_mps = 0.0, vy_mps = 0.0, vz_mps = 0.0;
    double yaw_rate_radps = 0.0;
  };
  Moment At(double t_s) const;
  /// The end of what was added.
  double Newest_s() const;
  /// The whole path: every 10 ms while the robot moves, once a second where it stands.
  trajectory::Trajectory Path() const;

 private:
  mutable std::mutex mutex_;
  std::deque<simulation::TruePose> recent_;
  trajectory::Trajectory path_;
};

/// The robot's tag, where the simulated mocap has it.
vision::RobotMotion TagOf(const TruePath::Moment& moment, const simulation::MocapOptions& mocap);

}  // namespace rift::twin
