#include "rift/trial/steering_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"
#include "rift/trial/loop_delay.hpp"

namespace rift::trial {
namespace {

using control::NavigatorOptions;
using geometry::DegFromRad;
using std::numbers::pi;

constexpr double kQuarter_rad = 0.5 * pi;  // heading error of a robot that circles its waypoint
constexpr double kLeastMargin_deg = 30.0;  // below, a loop overshoots by half and more
constexpr double kWantedMargin_rad = pi / 3.0;
constexpr double kCircleShare = 0.8;  // of the reach radius, wanted
constexpr double kLargestSwing_deg = 45.0, kWantedSwing_deg = 15.0;
constexpr double kManyDecisions = 0.2;
constexpr double kLeastR2 = 0.3;
constexpr double kTurnedAway = 0.25;
constexpr double kStanding_m = 0.02;

/// Steering and speed of v and w at full error, after every limit.
struct Asked {
  double v, w;
};

double SteeringAt(const NavigatorOptions& navigator, double error_rad) {
  return navigator.heading.p * error_rad + navigator.heading.i * navigator.integral_limit;
}

Asked OnCircle(const NavigatorOptions& navigator, const SteeringModel& model) {
  const double w =
      std::clamp(SteeringAt(navigator, kQuarter_rad), navigator.w_min, navigator.w_max);
  // v follows the distance once that asks for more than the circle of v_min leaves.
  const double grows = model.speed_mps * navigator.distance.p / (model.yaw_rate_rad_s * w);
  return {grows > 1.0 ? navigator.v_max : navigator.v_min, w};
}

/// The yaw that turned on one leg, in turns.
double MostTurns(const trajectory::Trajectory& log) {
  double most = 0.0, turned_rad = 0.0;
  for (size_t i = 1; i < log.poses.size(); ++i) {
    const trajectory::StampedPose &from = log.poses[i - 1], &to = log.poses[i];
    const bool is_same_leg = from.target_x_m == to.target_x_m && from.target_y_m == to.target_y_m;
    turned_rad = is_same_leg ? turned_rad + geometry::WrapToPi(to.yaw_rad - from.yaw_rad) : 0.0;
    most = std::max(most, std::abs(turned_rad));
  }
  return most / (2.0 * pi);
}

/// Way by strides of 0.2 s, which noise hardly lengthens.
double Way_m(const trajectory::Trajectory& log) {
  constexpr double kStride_s = 0.2;
  double way_m = 0.0;
  const trajectory::StampedPose* last = &log.poses.front();
  for (const trajectory::StampedPose& pose : log.poses) {
    if (pose.t_s - last->t_s < kStride_s) continue;
    way_m += (pose.Position() - last->Position()).norm();
    last = &pose;
  }
  return way_m + (log.poses.back().Position() - last->Position()).norm();
}

double Length_m(const control::Task& task) {
  double length_m = 0.0;
  for (size_t i = 1; i < task.waypoints.size(); ++i) {
    length_m += (task.waypoints[i].Position() - task.waypoints[i - 1].Position()).norm();
  }
  return length_m;
}

/// It circled, or began to, on a circle too wide for its time.
bool IsAstray(const SteeringCheck& check, const TrialResult& result, const control::Task& task) {
  return check.HasCircled() || Way_m(result.trajectory) > 2.0 * Length_m(task);
}

double Turned_rad(const trajectory::Trajectory& log) {
  double turned_rad = 0.0;
  for (size_t i = 1; i < log.poses.size(); ++i) {
    turned_rad += geometry::WrapToPi(log.poses[i].yaw_rad - log.poses[i - 1].yaw_rad);
  }
  return turned_rad;
}

/// Integrals over time of v and w as they were sent before `until_s`.
Asked SentBefore(const std::vector<SentCommand>& commands, double until_s) {
  Asked sum{0.0, 0.0};
  for (size_t i = 0; i + 1 < commands.size(); ++i) {
    const double dt_s = std::max(0.0, std::min(commands[i + 1].t_s, until_s) - commands[i].t_s);
    const control::WheelPower& power = commands[i].power;
    sum.v += dt_s * 0.5 * (power.left + power.right);
    sum.w += dt_s * 0.5 * (power.right - power.left);
  }
  return sum;
}

std::optional<LoopDelay> TryDelay(const TrialResult& result, double sign) {
  std::vector<SentCommand> sent = result.commands;
  for (SentCommand& command : sent) {
    if (sign < 0.0) std::swap(command.power.left, command.power.right);
  }
  try {
    return EstimateCommandDelay(result.trajectory, sent, {.max_lag_s = 1.0, .lag_step_s = 0.02});
  } catch (const std::invalid_argument&) {  // too short, or it never moved
    return std::nullopt;
  }
}

/// Steering to the left turned it to the right.
bool IsReversed(const LoopDelay& delay, const TrialResult& result) {
  const std::optional<LoopDelay> reversed = TryDelay(result, -1.0);
  if (!reversed || reversed->r2 < kLeastR2) return false;
  // Steering that swings fits half a period late too, with the wrong sign.
  return delay.lag_s < 0.0 || (reversed->r2 > delay.r2 && reversed->lag_s < delay.lag_s);
}

/// Model, r2 and whether they are the run's own; true when the robot steers the wrong way.
bool Identify(const TrialResult& result, const SteeringPrior& prior, SteeringCheck& check) {
  check.model = prior.model;
  check.model.pose_age_s = std::max(0.0, result.pose_age_s);
  const double way_m = Way_m(result.trajectory);
  const std::optional<LoopDelay> delay = TryDelay(result, 1.0);
  if (way_m < kStanding_m || !delay) return false;
  // It turns its back on the waypoint; less of a turn may be noise.
  const bool may_be_reversed = result.outcome != Outcome::kReached && check.turns > kTurnedAway;
  if (may_be_reversed && IsReversed(*delay, result)) return true;
  check.r2 = delay->r2;
  check.is_identified = delay->r2 >= kLeastR2 && delay->gain_rad_s > 0.0;
  if (check.is_identified) {
    check.model.yaw_rate_rad_s = 2.0 * delay->gain_rad_s;
    check.model.command_delay_s = delay->lag_s;
  }
  const Asked sent =
      SentBefore(result.commands, result.trajectory.poses.back().t_s - check.model.command_delay_s);
  if (sent.v > 0.1 * way_m / prior.model.speed_mps) check.model.speed_mps = way_m / sent.v;
  // On a steady circle nothing tells the delay, and the turn itself tells the gain.
  const double turned_rad = Turned_rad(result.trajectory);
  if (!check.is_identified && std::abs(turned_rad) > pi && turned_rad * sent.w > 0.0) {
    check.model.yaw_rate_rad_s = turned_rad / sent.w;
    check.is_identified = true;
  }
  return false;
}

void Propose(SteeringCheck& check, const std::string& key, double was, double value) {
  if (value == was) return;
  const std::string digits = fmt::format("{:.2g}", value);  // what an identified model is worth
  double rounded = value;
  std::from_chars(digits.data(), digits.data() + digits.size(), rounded);
  if (rounded != was) check.proposals.push_back({key, was, rounded});
}

std::string CircleCause(const SteeringCheck& check, const NavigatorOptions& navigator) {
  const Asked asked = OnCircle(navigator, check.model);
  const double wanted_w = SteeringAt(navigator, kQuarter_rad);
  std::string text = fmt::format(
      "a waypoint counts as reached within {:g} m (control.reach_radius_m), and it can circle at "
      "{:.3f} m for ever: at a heading error of 90 deg control.heading.p {:g} asks for w {:.3g}",
      navigator.reach_radius_m, check.circle_m, navigator.heading.p, wanted_w);
  if (wanted_w > navigator.w_max) {
    text += fmt::format(", control.w_max allows {:g}", navigator.w_max);
  }
  return text +
         (asked.v > navigator.v_min
              ? fmt::format(", and control.distance.p {:g} drives v up to control.v_max {:g}",
                            navigator.distance.p, navigator.v_max)
              : fmt::format(", and control.v_min keeps v at {:g}", navigator.v_min));
}

std::string MarginCause(const SteeringCheck& check, const NavigatorOptions& navigator) {
  const SteeringMargins& margins = check.margins;
  return fmt::format(
      "the steering {}: control.heading.p {:g} and d {:g} with {:.3g} rad/s for each unit of w {} "
      "{:.0f} ms of delay (poses are {:.0f} ms old, commands take {:.0f} ms); stable below {:.0f} "
      "ms",
      margins.phase_margin_deg < 0.0 ? "is unstable" : "hardly settles", navigator.heading.p,
      navigator.heading.d, check.model.yaw_rate_rad_s,
      std::isfinite(margins.crossover_rad_s)
          ? fmt::format("have {:.0f} deg of phase margin at", margins.phase_margin_deg)
          : std::string("never fall below a gain of 1 (d times that is 1 or more), at"),
      1e3 * check.delay_s, 1e3 * check.model.pose_age_s, 1e3 * check.model.command_delay_s,
      1e3 * margins.longest_delay_s);
}

/// Gains with the wanted margin: the loop's gain is 1 where the delay alone costs the rest, so that
/// d adds to the margin (w T = pi / 2 - margin).
control::PidGains StableGains(const NavigatorOptions& navigator, double yaw_rate_rad_s,
                              double delay_s) {
  const control::PidGains& now = navigator.heading;
  const double crossover_rad_s = (kQuarter_rad - kWantedMargin_rad) / delay_s;
  const double ratio_s = now.p > 0.0 ? std::min(now.d / now.p, 0.5 * delay_s) : 0.0;
  const double p = crossover_rad_s / (yaw_rate_rad_s * std::hypot(1.0, crossover_rad_s * ratio_s));
  return {p, 0.0, ratio_s * p};
}

/// Steering strong enough for a circle within the reach radius, as far as it stays stable; then a
/// lower speed, as far as the wheels turn; then a larger radius.
void TightenCircle(const SteeringModel& model, const SteeringPrior& prior,
                   const control::PidGains& largest, NavigatorOptions& wanted) {
  const double inside_m = kCircleShare * wanted.reach_radius_m;
  const auto needed_w = [&] {
    return model.speed_mps * wanted.v_min / (model.yaw_rate_rad_s * inside_m);
  };
  const double strongest_w = 1.0 - wanted.v_min;  // beyond, both powers are scaled down
  const double p = std::min(needed_w() / kQuarter_rad, largest.p);
  if (p > wanted.heading.p) wanted.heading = {p, wanted.heading.i, p * largest.d / largest.p};
  wanted.w_max =
      std::max(wanted.w_max, std::min({needed_w(), SteeringAt(wanted, kQuarter_rad), strongest_w}));
  const double w = std::clamp(SteeringAt(wanted, kQuarter_rad), wanted.w_min, wanted.w_max);
  if (needed_w() > w * (1.0 + 1e-9)) {
    const double slow = inside_m * model.yaw_rate_rad_s * w / model.speed_mps;
    wanted.v_min = std::min(wanted.v_min, std::max(slow, prior.least_power));
  }
  wanted.distance.p =
      std::min(wanted.distance.p, kCircleShare * model.yaw_rate_rad_s * w / model.speed_mps);
  wanted.reach_radius_m =
      std::max(wanted.reach_radius_m, CircleRadius_m(wanted, model) / kCircleShare);
}

/// Keys of the navigator that differ.
void ProposeChanges(SteeringCheck& check, const NavigatorOptions& now,
                    const NavigatorOptions& wanted) {
  Propose(check, "control.heading.p", now.heading.p, wanted.heading.p);
  Propose(check, "control.heading.i", now.heading.i, wanted.heading.i);
  Propose(check, "control.heading.d", now.heading.d, wanted.heading.d);
  Propose(check, "control.w_min", now.w_min, wanted.w_min);
  Propose(check, "control.w_max", now.w_max, wanted.w_max);
  Propose(check, "control.v_min", now.v_min, wanted.v_min);
  Propose(check, "control.distance.p", now.distance.p, wanted.distance.p);
  Propose(check, "control.reach_radius_m", now.reach_radius_m, wanted.reach_radius_m);
}

void ExplainSteering(SteeringCheck& check, const NavigatorOptions& navigator,
                     const SteeringPrior& prior, const TrialOptions& options, bool is_astray) {
  NavigatorOptions wanted = navigator;
  const control::PidGains largest = StableGains(navigator, check.model.yaw_rate_rad_s,
                                                std::max(check.delay_s, options.control_period_s));
  if (check.margins.phase_margin_deg < kLeastMargin_deg) {
    check.causes.push_back(MarginCause(check, navigator));
    wanted.heading = largest;
  }
  const double swing_deg = DegFromRad(check.swing.heading_rad);
  const double swing_share = 2.0 * check.swing.path_m / navigator.reach_radius_m;
  if (swing_deg > kLargestSwing_deg || swing_share > 1.0) {
    check.causes.push_back(fmt::format(
        "control.w_min {:g} is too coarse: in the {:.0f} ms until the sign of w changes it turns "
        "the robot by {:.0f} deg, and the path swings by {:.3f} m to each side",
        navigator.w_min, 1e3 * check.delay_s, swing_deg, check.swing.path_m));
    wanted.w_min *= std::min(kWantedSwing_deg / swing_deg, 0.5 / swing_share);
  }
  if (is_astray && check.circle_m > navigator.reach_radius_m) {
    check.causes.push_back(CircleCause(check, navigator));
  }
  const bool is_changed = !check.causes.empty();
  if (is_changed && CircleRadius_m(wanted, check.model) > wanted.reach_radius_m) {
    TightenCircle(check.model, prior, largest, wanted);
  }
  ProposeChanges(check, navigator, wanted);
}

void ExplainPoses(SteeringCheck& check, const TrialResult& result, const TrialOptions& options) {
  const auto stale = static_cast<double>(result.stale_decisions),
             all = static_cast<double>(result.limits.decisions + result.stale_decisions);
  if (stale > kManyDecisions * all) {
    check.causes.push_back(fmt::format(
        "{:.0f} % of the decisions were zero power, since the newest pose was older than "
        "trial.pose_stale_s, {:g} s",
        100.0 * stale / all, options.pose_stale_s));
  }
  const auto refused = static_cast<double>(result.poses_refused),
             seen = refused + static_cast<double>(result.trajectory.poses.size());
  if (refused > kManyDecisions * seen) {
    check.causes.push_back(fmt::format(
        "{:.0f} % of the poses were refused as jumps (control.pose_gate)", 100.0 * refused / seen));
  }
}

/// Of a run that was on its way when its time was up.
void ExplainTime(SteeringCheck& check, const TrialResult& result, const control::Task& task,
                 const TrialOptions& options) {
  const trajectory::StampedPose& last = result.trajectory.poses.back();
  const double way_m = Way_m(result.trajectory), took_s = last.t_s - result.trajectory.poses[0].t_s;
  double left_m = 0.0;
  Eigen::Vector2d at_m = last.Position();
  for (size_t i = 0; i < result.visits.size(); ++i) {
    if (result.visits[i].reached_s) continue;
    left_m += (task.waypoints[i + 1].Position() - at_m).norm();
    at_m = task.waypoints[i + 1].Position();
  }
  check.causes.push_back(
      fmt::format("it was on its way: {:.2f} m driven at a mean of {:.3f} m/s, {:.2f} m left",
                  way_m, way_m / took_s, left_m));
  const double needed_s = std::ceil(1.5 * (took_s + left_m * took_s / way_m));
  check.proposals.push_back({"trial.timeout_s", options.timeout_s, needed_s});
}

/// A fall, a fault and a person's stop have their own reason.
bool IsToExplain(Outcome outcome) {
  return outcome == Outcome::kTimedOut || outcome == Outcome::kLeftArena ||
         outcome == Outcome::kLost;
}

void Explain(SteeringCheck& check, const TrialResult& result, const control::Task& task,
             const NavigatorOptions& navigator, const TrialOptions& options,
             const SteeringPrior& prior) {
  ExplainPoses(check, result, options);
  if (Way_m(result.trajectory) < kStanding_m) {
    double largest = 0.0;
    for (const SentCommand& sent : result.commands) {
      largest = std::max({largest, std::abs(sent.power.left), std::abs(sent.power.right)});
    }
    check.causes.push_back(fmt::format(
        "it hardly moved at powers up to {:.2f}: motors, battery, dead band, or a link that loses "
        "the commands",
        largest));
    if (navigator.v_min < prior.least_power) {
      Propose(check, "control.v_min", navigator.v_min, prior.least_power);
      if (navigator.v_max < prior.least_power) {
        Propose(check, "control.v_max", navigator.v_max, prior.least_power);
      }
    }
    return;
  }
  const bool is_astray = IsAstray(check, result, task);
  ExplainSteering(check, navigator, prior, options, is_astray);
  if (result.outcome == Outcome::kTimedOut && !is_astray && check.causes.empty()) {
    ExplainTime(check, result, task, options);
  }
  if (check.causes.empty() && is_astray) {
    check.causes.push_back(fmt::format(
        "no limit of the steering explains it: the phase margin is {:.0f} deg, and the circle at a "
        "heading error of 90 deg, {:.3f} m, lies within control.reach_radius_m",
        check.margins.phase_margin_deg, check.circle_m));
  }
}

}  // namespace

SteeringMargins MarginsOf(const control::PidGains& heading, double yaw_rate_rad_s, double delay_s) {
  // |L(i w)| = 1 is a quadratic equation in w^2: (1 - G^2 d^2) w^4 - G^2 (p^2 - 2 i d) w^2 = G^2
  // i^2.
  const double g2 = yaw_rate_rad_s * yaw_rate_rad_s;
  const double a = 1.0 - g2 * heading.d * heading.d,
               b = g2 * (heading.p * heading.p - 2.0 * heading.i * heading.d),
               c = g2 * heading.i * heading.i;
  if (!(a > 0.0)) return {std::numeric_limits<double>::infinity(), -180.0, 0.0};
  const double crossover_rad_s = std::sqrt((b + std::sqrt(b * b + 4.0 * a * c)) / (2.0 * a));
  if (!(crossover_rad_s > 0.0)) return {0.0, 90.0, std::numeric_limits<double>::infinity()};
  const double lead_rad =
      kQuarter_rad +
      std::atan2(crossover_rad_s * heading.d - heading.i / crossover_rad_s, heading.p);
  return {crossover_rad_s, DegFromRad(lead_rad - crossover_rad_s * delay_s),
          lead_rad / crossover_rad_s};
}

double CircleRadius_m(const NavigatorOptions& navigator, const SteeringModel& model) {
  const Asked asked = OnCircle(navigator, model);
  return model.speed_mps * asked.v / (model.yaw_rate_rad_s * asked.w);
}

SteeringSwing SwingOf(const NavigatorOptions& navigator, const SteeringModel& model,
                      double delay_s) {
  // A triangle of the heading: up for two delays, down for two.
  const double heading_rad = model.yaw_rate_rad_s * navigator.w_min * delay_s;
  return {heading_rad, 0.5 * model.speed_mps * navigator.v_min * heading_rad * delay_s};
}

SteeringCheck CheckSteering(const TrialResult& result, const control::Task& task,
                            const NavigatorOptions& navigator, const TrialOptions& options,
                            const SteeringPrior& prior) {
  SteeringCheck check;
  if (task.program || result.trajectory.poses.size() < 2 || result.limits.decisions == 0) {
    return check;
  }
  check.turns = MostTurns(result.trajectory);
  const bool is_reversed = Identify(result, prior, check);
  check.delay_s = std::max(
      0.0, check.model.pose_age_s + check.model.command_delay_s - navigator.latency.delay_s);
  check.margins = MarginsOf(navigator.heading, check.model.yaw_rate_rad_s, check.delay_s);
  check.circle_m = CircleRadius_m(navigator, check.model);
  check.swing = SwingOf(navigator, check.model, check.delay_s);
  if (!IsToExplain(result.outcome) && !check.HasCircled()) return check;
  if (is_reversed) {
    check.causes.push_back(
        "it turned to the right when it was steered to the left: its motors are swapped, one of "
        "them runs backwards, or the camera's picture is mirrored");
    return check;
  }
  Explain(check, result, task, navigator, options, prior);
  return check;
}

}  // namespace rift::trial
