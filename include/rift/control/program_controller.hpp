#pragma once

#include <optional>
#include <vector>

#include "rift/control/controller.hpp"

namespace rift::control {

/// Sends the powers of a program one after the other, whatever the poses say. The time of the
/// program runs only while the power it asked for is in force: what a guard held back is driven
/// later.
class ProgramController : public Controller {
 public:
  ProgramController(Program program, const PoseGateOptions& pose_gate);

  Decision Step(const PoseInput& input) override;
  bool Observe(const PoseInput& input) override;
  void NoteSent(double now_s, const WheelPower& power) override;

  const std::vector<Waypoint>& waypoints() const override { return program_.waypoints(); }
  size_t active() const override { return program_.PieceAt(elapsed_s_) + 1; }
  Eigen::Vector2d Target_m() const override { return program_.PoseAt(elapsed_s_).Position(); }
  const std::optional<TimedPose>& pose() const override { return gate_.last(); }

 private:
  Program program_;
  PoseGate gate_;
  double elapsed_s_ = 0.0;  ///< of the program
  std::optional<WheelPower> asked_;
  std::optional<double> in_force_since_s_;
};

}  // namespace rift::control
