#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rift/control/controller.hpp"
#include "rift/control/options.hpp"
#include "rift/control/pid.hpp"
#include "rift/control/pose_filter.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/geometry/pose2.hpp"

namespace rift::control {

/// Drives a robot along waypoints: a distance loop gives the forward power, a heading loop the
/// steering power (paper 4.1; the details are those of the authors' Webots logs). Its decisions
/// depend on what it was told and on nothing else.
///
/// At a waypoint with stop one decision is zero power, then the next leg begins; both loops are
/// reset at every waypoint.
class Navigator : public Controller {
 public:
  /// Throws std::invalid_argument on options or waypoints that break their rules.
  Navigator(const NavigatorOptions& options, std::vector<Waypoint> waypoints);

  Decision Step(const PoseInput& input) override;
  bool Observe(const PoseInput& input) override;
  /// Slew limit and latency compensation build on it.
  void NoteSent(double now_s, const WheelPower& power) override;

  bool finished() const { return active_ == waypoints_.size(); }
  size_t active() const override { return finished() ? waypoints_.size() - 1 : active_; }
  Eigen::Vector2d Target_m() const override { return waypoints_[active()].Position(); }
  const std::vector<Waypoint>& waypoints() const override { return waypoints_; }
  const std::optional<TimedPose>& pose() const override { return gate_.last(); }

 private:
  bool Arrive(Decision& decision, const geometry::Pose2& world_from_robot);
  void Aim(Decision& decision, const geometry::Pose2& world_from_robot) const;
  void DecideSpeed(Decision& decision, double dt_s);
  void DecideSteering(Decision& decision, double dt_s);
  void DecidePower(Decision& decision, double dt_s) const;

  NavigatorOptions options_;
  std::vector<Waypoint> waypoints_;
  size_t active_ = 1;
  Pid distance_loop_;
  Pid heading_loop_;
  PoseGate gate_;
  double arrived_s_ = 0.0;
  PosePredictor predictor_;
  bool clock_is_set_;
  WheelPower last_sent_;
};

}  // namespace rift::control
