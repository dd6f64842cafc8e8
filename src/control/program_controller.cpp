#include "rift/control/program_controller.hpp"

#include <cmath>
#include <utility>

#include "rift/control/navigator.hpp"

namespace rift::control {

ProgramController::ProgramController(Program program, const PoseGateOptions& pose_gate)
    : program_(std::move(program)), gate_(pose_gate) {}

bool ProgramController::Observe(const PoseInput& input) {
  return gate_.Accept({input.captured_s, input.world_from_robot});
}

Decision ProgramController::Step(const PoseInput& input) {
  Decision decision;
  decision.pose_refused = !Observe(input);
  if (in_force_since_s_) {
    elapsed_s_ += input.now_s - *in_force_since_s_;
    in_force_since_s_ = input.now_s;
  }
  decision.waypoint = active();
  if (!gate_.last()) return decision;
  const geometry::Pose2& world_from_robot = gate_.last()->world_from_robot;
  decision.distance_m =
      (waypoints()[decision.waypoint].Position() - world_from_robot.Position()).norm();
  // A rest of no length still ends with zero power: this decision's.
  decision.finished = elapsed_s_ >= program_.Duration_s() + program_.Rest_s();
  decision.reached = decision.finished;
  decision.power = program_.MeanPower(elapsed_s_, elapsed_s_ + input.dt_s);
  decision.v = decision.raw_v = 0.5 * (decision.power.right + decision.power.left);
  decision.w = decision.raw_w = 0.5 * (decision.power.right - decision.power.left);
  asked_ = decision.power;
  return decision;
}

void ProgramController::NoteSent(double now_s, const WheelPower& power) {
  if (in_force_since_s_) elapsed_s_ += now_s - *in_force_since_s_;
  in_force_since_s_.reset();
  if (asked_ && power == *asked_) in_force_since_s_ = now_s;
}

geometry::Pose2 Task::Start() const {
  return program ? program->PoseAt(0.0) : StartPose(waypoints);
}

std::vector<TimedPose> Task::IdealPath() const {
  constexpr double kStep_s = 0.02;
  std::vector<TimedPose> path;
  if (program) {
    for (const double t_s : program->Times(kStep_s)) path.push_back({t_s, program->PoseAt(t_s)});
    return path;
  }
  for (const Waypoint& waypoint : waypoints) {
    path.push_back({static_cast<double>(path.size()), {waypoint.x_m, waypoint.y_m, std::nan("")}});
  }
  return path;
}

std::unique_ptr<Controller> MakeController(const Task& task, const NavigatorOptions& options) {
  if (!task.program) return std::make_unique<Navigator>(options, task.waypoints);
  options.Check();
  return std::make_unique<ProgramController>(*task.program, options.pose_gate);
}

}  // namespace rift::control
