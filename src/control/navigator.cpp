#include "rift/control/navigator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rift/geometry/pose2.hpp"

namespace rift::control {
namespace {

// Options are checked before any member is made from them.
const NavigatorOptions& Checked(const NavigatorOptions& options) {
  options.Check();
  return options;
}

std::vector<Waypoint> Checked(std::vector<Waypoint> waypoints) {
  CheckWaypoints(waypoints);
  return waypoints;
}

}  // namespace

Navigator::Navigator(const NavigatorOptions& options, std::vector<Waypoint> waypoints)
    : options_(Checked(options)),
      waypoints_(Checked(std::move(waypoints))),
      distance_loop_(options.distance, options.integral_limit, options.derivative_kick),
      heading_loop_(options.heading, options.integral_limit, options.derivative_kick),
      gate_(options.pose_gate),
      predictor_(options.latency),
      clock_is_set_(!options.first_pose_sets_clock && !options.clock_starts_anew) {}

Decision Navigator::Step(const PoseInput& input) {
  Decision decision;
  decision.pose_refused = !Observe(input);
  decision.waypoint = active();
  decision.finished = finished();
  if (!gate_.last()) return decision;

  const geometry::Pose2 world_from_robot =
      predictor_.Predict(gate_.last()->world_from_robot, arrived_s_, input.now_s);
  Aim(decision, world_from_robot);
  if (decision.finished || Arrive(decision, world_from_robot)) {
    clock_is_set_ = !options_.clock_starts_anew;
    return decision;
  }
  decision.set_clock = !std::exchange(clock_is_set_, true);
  if (decision.set_clock) return decision;

  const double dt_s = std::isfinite(input.dt_s)
                          ? std::clamp(input.dt_s, options_.dt_min_s, options_.dt_max_s)
                          : options_.dt_max_s;
  DecideSpeed(decision, dt_s);
  DecideSteering(decision, dt_s);
  DecidePower(decision, dt_s);
  return decision;
}

bool Navigator::Observe(const PoseInput& input) {
  const bool is_new = !gate_.last() || input.captured_s != gate_.last()->captured_s;
  if (!gate_.Accept({input.captured_s, input.world_from_robot})) return false;
  if (is_new) arrived_s_ = input.now_s;
  return true;
}

void Navigator::NoteSent(double now_s, const WheelPower& power) {
  last_sent_ = power;
  predictor_.NoteSent(now_s, power);
}

void Navigator::Aim(Decision& decision, const geometry::Pose2& world_from_robot) const {
  decision.waypoint = active();
  const Eigen::Vector2d ahead = waypoints_[active()].Position() - world_from_robot.Position();
  decision.distance_m = ahead.norm();
  decision.heading_error_rad =
      geometry::WrapToPi(std::atan2(ahead.y(), ahead.x()) - world_from_robot.yaw_rad);
}

// True when this step ends at a waypoint; a waypoint without stop only moves the aim on.
bool Navigator::Arrive(Decision& decision, const geometry::Pose2& world_from_robot) {
  while (decision.distance_m < options_.reach_radius_m) {
    const bool stop = waypoints_[active_].stop;
    ++active_;
    distance_loop_.Reset();
    heading_loop_.Reset();
    decision.finished = finished();
    decision.reached = stop || decision.finished;
    if (decision.reached) return true;
    Aim(decision, world_from_robot);
  }
  return false;
}

void Navigator::DecideSpeed(Decision& decision, double dt_s) {
  decision.raw_v = distance_loop_.Step(dt_s, decision.distance_m);
  decision.v = std::clamp(decision.raw_v, options_.v_min, options_.v_max);
  decision.limits.v_min = decision.raw_v < options_.v_min;
  decision.limits.v_max = decision.raw_v > options_.v_max;

  const double cruise = options_.CruiseSpeed();
  const double off_course_deg = geometry::DegFromRad(std::abs(decision.heading_error_rad));
  if (off_course_deg < options_.cruise_cap_angle_deg && decision.v > cruise) {
    decision.v = cruise;
    decision.limits.cruise_cap = true;
  }
  if (!waypoints_[active_].stop && off_course_deg < options_.through_angle_deg &&
      decision.v < cruise) {
    decision.v = cruise;
    decision.limits.through_cruise = true;
  }
}

void Navigator::DecideSteering(Decision& decision, double dt_s) {
  decision.raw_w = heading_loop_.Step(dt_s, decision.heading_error_rad);
  const double size = std::abs(decision.raw_w);
  decision.limits.w_min = size > 0.0 && size < options_.w_min;
  decision.limits.w_max = size > options_.w_max;
  if (size > 0.0) {  // an exact zero has no side to be pushed to
    decision.w = std::copysign(std::clamp(size, options_.w_min, options_.w_max), decision.raw_w);
  }
}

void Navigator::DecidePower(Decision& decision, double dt_s) const {
  const double left = decision.v - decision.w, right = decision.v + decision.w;
  const double scale = std::max({1.0, std::abs(left), std::abs(right)});
  decision.limits.normalised = scale > 1.0;
  decision.power = {left / scale, right / scale};
  if (!options_.slew_rate_per_s) return;

  const double change = *options_.slew_rate_per_s * dt_s;
  const WheelPower wanted = decision.power;
  decision.power = {std::clamp(wanted.left, last_sent_.left - change, last_sent_.left + change),
                    std::clamp(wanted.right, last_sent_.right - change, last_sent_.right + change)};
  decision.limits.slew = !(decision.power == wanted);
}

}  // namespace rift::control
