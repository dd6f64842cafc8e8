#include "rift/trial/steering_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "progress.hpp"
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
constexpr double kMany = 0.2;  // of the decisions, or of the poses
constexpr double kLeastR2 = 0.3;
constexpr double kTurnedAway = 0.25;
constexpr double kLeastWay_m = 0.02;
constexpr double kLargestHold_rad = pi / 4.0, kWantedHold_rad = 0.5;
constexpr double kLongest_s = 3600.0;  // of trial.timeout_s

/// Steering and speed of v and w at full error, after every limit.
struct Asked {
  double v, w;
};

double SteeringAt(const NavigatorOptions& navigator, double error_rad) {
  return navigator.heading.p * error_rad + navigator.heading.i * navigator.integral_limit;
}

/// Yaw rate to the side against which the robot pulls.
double TurnAgainstPull_rad_s(const SteeringModel& model, double v, double w) {
  return model.yaw_rate_rad_s * w - std::abs(model.pull_rad_s) * v;
}

Asked OnCircle(const NavigatorOptions& navigator, const SteeringModel& model) {
  const double w =
      std::clamp(SteeringAt(navigator, kQuarter_rad), navigator.w_min, navigator.w_max);
  // v follows the distance once that asks for more than the circle of v_min leaves.
  const bool grows =
      model.speed_mps * navigator.distance.p > TurnAgainstPull_rad_s(model, navigator.v_min, w);
  return {grows ? navigator.v_max : navigator.v_min, w};
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

/// It circled, or began to, on a circle too wide for its time.
bool IsAstray(const SteeringCheck& check, const TrialResult& result, const control::Task& task) {
  return check.HasCircled() || Way_m(result.trajectory) > 2.0 * Length_m(task.waypoints);
}

double Turned_rad(const trajectory::Trajectory& log) {
  double turned_rad = 0.0;
  for (size_t i = 1; i < log.poses.size(); ++i) {
    turned_rad += geometry::WrapToPi(log.poses[i].yaw_rad - log.poses[i - 1].yaw_rad);
  }
  return turned_rad;
}

/// Integrals over time of v and w as they were sent.
class SentIntegrals {
 public:
  explicit SentIntegrals(const std::vector<SentCommand>& commands) : commands_(commands) {
    Asked sum{0.0, 0.0};
    for (size_t i = 0; i < commands.size(); ++i) {
      sums_.push_back(sum);
      if (i + 1 == commands.size()) break;
      const Asked held = Of(i);
      const double dt_s = commands[i + 1].t_s - commands[i].t_s;
      sum = {sum.v + dt_s * held.v, sum.w + dt_s * held.w};
    }
  }

  Asked Until(double t_s) const {
    if (commands_.empty()) return {0.0, 0.0};
    t_s = std::min(t_s, commands_.back().t_s);  // how long that one held is not known
    const auto after =
        std::upper_bound(commands_.begin(), commands_.end(), t_s,
                         [](double t, const SentCommand& sent) { return t < sent.t_s; });
    if (after == commands_.begin()) return {0.0, 0.0};
    const auto i = static_cast<size_t>(after - commands_.begin()) - 1;
    const Asked held = Of(i);
    const double dt_s = t_s - commands_[i].t_s;
    return {sums_[i].v + dt_s * held.v, sums_[i].w + dt_s * held.w};
  }

 private:
  Asked Of(size_t i) const {
    const control::WheelPower& power = commands_[i].power;
    return {0.5 * (power.left + power.right), 0.5 * (power.right - power.left)};
  }

  const std::vector<SentCommand>& commands_;
  std::vector<Asked> sums_;
};

/// Sums of squares and products of the turn of a stride and of what was sent for it.
struct TurnSums {
  double ww = 0.0, wv = 0.0, vv = 0.0, wy = 0.0, vy = 0.0, yy = 0.0;

  /// Share of w that v does not tell: without it gain and pull cannot be told apart.
  double Excitation() const { return ww * vv > 0.0 ? 1.0 - wv * wv / (ww * vv) : 0.0; }
};

TurnSums TurnsOf(const TrialResult& result, const SentIntegrals& sent, double delay_s) {
  constexpr double kStride_s = 0.3;
  TurnSums sums;
  const std::vector<trajectory::StampedPose>& poses = result.trajectory.poses;
  double turned_rad = 0.0;
  for (size_t i = 1, from = 0; i < poses.size(); ++i) {
    turned_rad += geometry::WrapToPi(poses[i].yaw_rad - poses[i - 1].yaw_rad);
    if (poses[i].t_s - poses[from].t_s < kStride_s) continue;
    const Asked to = sent.Until(poses[i].t_s - delay_s), at = sent.Until(poses[from].t_s - delay_s);
    const double v = to.v - at.v, w = to.w - at.w;
    sums.ww += w * w, sums.wv += w * v, sums.vv += v * v;
    sums.wy += w * turned_rad, sums.vy += v * turned_rad, sums.yy += turned_rad * turned_rad;
    from = i;
    turned_rad = 0.0;
  }
  return sums;
}

/// Yaw rate for each unit of w and of v that explain the turns best, where the run tells both.
void FitPull(const TurnSums& sums, SteeringCheck& check) {
  constexpr double kLeastExcitation = 0.02, kLeastShare = 0.5, kMostRest = 0.5;
  if (sums.Excitation() < kLeastExcitation) return;
  const double det = sums.ww * sums.vv - sums.wv * sums.wv;
  const double gain = (sums.wy * sums.vv - sums.vy * sums.wv) / det;
  const double pull = (sums.vy * sums.ww - sums.wy * sums.wv) / det;
  const double explained = (gain * sums.wy + pull * sums.vy) / sums.yy;
  const double without = sums.wy * sums.wy / (sums.ww * sums.yy);
  // A pull has to explain what the steering alone does not.
  if (!(gain > 0.0) || explained < kLeastShare || 1.0 - explained > kMostRest * (1.0 - without))
    return;
  check.model.yaw_rate_rad_s = gain;
  check.model.pull_rad_s = pull;
  check.r2 = explained;
  check.is_identified = check.is_pull_told = true;
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
  check.model.pose_age_s =
      std::max(0.0, result.pose_age_s >= 0.0 ? result.pose_age_s : result.arrival_age_s);
  const double way_m = Way_m(result.trajectory);
  const std::optional<LoopDelay> delay = TryDelay(result, 1.0);
  if (way_m < kLeastWay_m || !delay) return false;
  // It turns its back on the waypoint; less of a turn may be noise.
  const bool may_be_reversed = result.outcome != Outcome::kReached && check.turns > kTurnedAway;
  if (may_be_reversed && IsReversed(*delay, result)) return true;
  check.r2 = delay->r2;
  check.is_identified = delay->r2 >= kLeastR2 && delay->gain_rad_s > 0.0;
  if (check.is_identified) {
    check.model.yaw_rate_rad_s = 2.0 * delay->gain_rad_s;
    check.model.command_delay_s = delay->lag_s;
  }
  const SentIntegrals integrals(result.commands);
  const Asked sent =
      integrals.Until(result.trajectory.poses.back().t_s - check.model.command_delay_s);
  FitPull(TurnsOf(result, integrals, check.model.command_delay_s), check);
  if (sent.v > 0.1 * way_m / prior.model.speed_mps) check.model.speed_mps = way_m / sent.v;
  // On a steady circle nothing tells the delay, and the turn itself tells the gain.
  const double turned_rad = Turned_rad(result.trajectory);
  if (!check.is_identified && std::abs(turned_rad) > pi && turned_rad * sent.w > 0.0) {
    // A gain far from the robot's own is a pull.
    constexpr double kLeastShare = 0.6;
    const double gain = turned_rad / sent.w, own = prior.model.yaw_rate_rad_s;
    if (gain > kLeastShare * own && gain < own / kLeastShare) {
      check.model.yaw_rate_rad_s = gain;
    } else {
      check.model.pull_rad_s = (turned_rad - own * sent.w) / sent.v;
    }
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

/// How the powers that turn a wheel follow from the robot's file.
std::string MovingText(const SteeringPrior& prior) {
  return prior.breakaway_power > prior.dead_band
             ? fmt::format(
                   "{:.2g} (simulation.motor: breakaway torque over stall torque and "
                   "supply_ratio)",
                   prior.breakaway_power)
             : fmt::format("{:.2g} (simulation.motor.dead_band)", prior.dead_band);
}

std::string CircleCause(const SteeringCheck& check, const NavigatorOptions& navigator) {
  const Asked asked = OnCircle(navigator, check.model);
  const double wanted_w = SteeringAt(navigator, kQuarter_rad);
  std::string text = fmt::format(
      "a waypoint counts as reached within {:g} m (control.reach_radius_m), and it {}: at a "
      "heading "
      "error of 90 deg control.heading.p {:g} asks for w {:.3g}",
      navigator.reach_radius_m,
      std::isfinite(check.circle_m) ? fmt::format("can circle at {:.3f} m for ever", check.circle_m)
                                    : std::string("cannot turn against its pull"),
      navigator.heading.p, wanted_w);
  if (wanted_w > navigator.w_max) {
    text += fmt::format(", control.w_max allows {:g}", navigator.w_max);
  } else if (wanted_w < navigator.w_min) {
    text += fmt::format(", control.w_min raises that to {:g}", navigator.w_min);
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

/// Steering that drives straight against the robot's pull.
double HoldSteering(const SteeringModel& model, double v) {
  return std::abs(model.pull_rad_s) * v / model.yaw_rate_rad_s;
}

/// The heading error that makes the controller steer so; infinite when it never does.
double HoldError_rad(const NavigatorOptions& navigator, double hold_w) {
  if (hold_w > navigator.w_max) return std::numeric_limits<double>::infinity();
  return hold_w > navigator.w_min ? hold_w / navigator.heading.p : 0.0;
}

std::string PullCause(const SteeringCheck& check, const NavigatorOptions& navigator) {
  const SteeringModel& model = check.model;
  const double hold_w = HoldSteering(model, navigator.v_max);
  const double error_rad = HoldError_rad(navigator, hold_w);
  return fmt::format(
      "it pulls to the {} by {:.2g} rad/s at v {:g} without steering (a motor or wheel that "
      "differs from the other, or drags{}): driving straight takes w {:.2g}, and {}",
      model.pull_rad_s > 0.0 ? "left" : "right", std::abs(model.pull_rad_s) * navigator.v_max,
      navigator.v_max,
      check.is_pull_told ? "" : "; or it answers to w otherwise than the robot's file says", hold_w,
      std::isfinite(error_rad)
          ? fmt::format(
                "control.heading.p {:g} asks for that only at a heading error of {:.0f} deg",
                navigator.heading.p, DegFromRad(error_rad))
          : fmt::format("control.w_max allows {:g}", navigator.w_max));
}

/// More gain as far as it stays stable, then less speed, which pulls less, as far as the wheels
/// turn.
void HoldAgainstPull(const SteeringModel& model, const SteeringPrior& prior,
                     const control::PidGains& largest, NavigatorOptions& wanted) {
  const double p = std::min(HoldSteering(model, wanted.v_max) / kWantedHold_rad, largest.p);
  if (p > wanted.heading.p) wanted.heading = {p, wanted.heading.i, p * largest.d / largest.p};
  const double fast =
      wanted.heading.p * kWantedHold_rad * model.yaw_rate_rad_s / std::abs(model.pull_rad_s);
  wanted.v_max = std::min(wanted.v_max, std::max(fast, prior.LeastPower()));
  wanted.v_min = std::min(wanted.v_min, wanted.v_max);
  wanted.w_max = std::max(wanted.w_max, 2.0 * HoldSteering(model, wanted.v_max));
}

/// Steering strong enough for a circle within the reach radius, as far as it stays stable; then a
/// lower speed, as far as the wheels turn; then a larger radius.
void TightenCircle(const SteeringModel& model, const SteeringPrior& prior,
                   const control::PidGains& largest, NavigatorOptions& wanted) {
  const double inside_m = kCircleShare * wanted.reach_radius_m;
  const auto needed_w = [&] {
    return wanted.v_min * (model.speed_mps / inside_m + std::abs(model.pull_rad_s)) /
           model.yaw_rate_rad_s;
  };
  const double strongest_w = 1.0 - wanted.v_min;  // beyond, both powers are scaled down
  const double p = std::min(needed_w() / kQuarter_rad, largest.p);
  if (p > wanted.heading.p) wanted.heading = {p, wanted.heading.i, p * largest.d / largest.p};
  wanted.w_max =
      std::max(wanted.w_max, std::min({needed_w(), SteeringAt(wanted, kQuarter_rad), strongest_w}));
  const double w = std::clamp(SteeringAt(wanted, kQuarter_rad), wanted.w_min, wanted.w_max);
  if (needed_w() > w * (1.0 + 1e-9)) {
    const double slow = wanted.v_min * w / needed_w();
    wanted.v_min = std::min(wanted.v_min, std::max(slow, prior.LeastPower()));
  }
  const double turn_rad_s = TurnAgainstPull_rad_s(model, wanted.v_min, w);
  if (!(turn_rad_s > 0.0)) return;  // nothing turns it against its pull
  wanted.distance.p = std::min(wanted.distance.p, kCircleShare * turn_rad_s / model.speed_mps);
  wanted.reach_radius_m =
      std::max(wanted.reach_radius_m, CircleRadius_m(wanted, model) / kCircleShare);
}

/// Twice the time the task takes when it is driven straight, with a turn to each waypoint.
double NeededTime_s(const control::Task& task, const NavigatorOptions& navigator,
                    const SteeringModel& model, double delay_s, const TrialOptions& options) {
  constexpr int kParts = 100;
  const double turn_s =
      pi / std::max(1e-6, model.yaw_rate_rad_s * OnCircle(navigator, model).w) + 2.0 * delay_s;
  double time_s = 0.0;
  for (size_t i = 1; i < task.waypoints.size(); ++i) {
    const double leg_m = (task.waypoints[i].Position() - task.waypoints[i - 1].Position()).norm();
    for (int part = 0; part < kParts; ++part) {
      const double v = std::clamp(navigator.distance.p * leg_m * (part + 0.5) / kParts,
                                  navigator.v_min, navigator.v_max);
      time_s += leg_m / kParts / std::max(1e-6, model.speed_mps * v);
    }
    time_s += turn_s;
  }
  return 2.0 * time_s + options.settle_s;
}

void ProposeTimeout(SteeringCheck& check, const TrialOptions& options, double needed_s) {
  if (needed_s <= options.timeout_s || needed_s > kLongest_s) return;
  const double digit_s = std::pow(10.0, std::floor(std::log10(needed_s)) - 1.0);
  check.proposals.push_back(
      {"trial.timeout_s", options.timeout_s, std::ceil(needed_s / digit_s) * digit_s});
}

/// Of the loop, less what is made up for.
double DelayOf(const SteeringModel& model, const NavigatorOptions& navigator) {
  return std::max(0.0, model.pose_age_s + model.command_delay_s - navigator.latency.delay_s);
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
  Propose(check, "control.v_max", now.v_max, wanted.v_max);
  Propose(check, "control.distance.p", now.distance.p, wanted.distance.p);
  Propose(check, "control.reach_radius_m", now.reach_radius_m, wanted.reach_radius_m);
}

/// What a run is explained from.
struct Case {
  const TrialResult& result;
  const control::Task& task;
  const NavigatorOptions& navigator;
  const TrialOptions& options;
  const SteeringPrior& prior;
};

/// The keys that differ, and the time a slower run needs.
void ProposeRun(SteeringCheck& check, const Case& run, const NavigatorOptions& wanted) {
  ProposeChanges(check, run.navigator, wanted);
  if (check.proposals.empty()) return;
  ProposeTimeout(check, run.options,
                 NeededTime_s(run.task, wanted, check.model, check.delay_s, run.options));
}

void ExplainSteering(SteeringCheck& check, const Case& run, bool is_astray) {
  const NavigatorOptions& navigator = run.navigator;
  NavigatorOptions wanted = navigator;
  const control::PidGains largest = StableGains(
      navigator, check.model.yaw_rate_rad_s, std::max(check.delay_s, run.options.control_period_s));
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
  const double hold_rad = HoldError_rad(navigator, HoldSteering(check.model, navigator.v_max));
  if (hold_rad > kLargestHold_rad) {
    check.causes.push_back(PullCause(check, navigator));
    HoldAgainstPull(check.model, run.prior, largest, wanted);
  } else if (is_astray && check.circle_m > navigator.reach_radius_m) {
    check.causes.push_back(CircleCause(check, navigator));
  }
  const bool is_changed = !check.causes.empty();
  if (is_changed && CircleRadius_m(wanted, check.model) > wanted.reach_radius_m) {
    TightenCircle(check.model, run.prior, largest, wanted);
  }
  ProposeRun(check, run, wanted);
}

/// A gate that is narrower than what the robot does, and what would be wide enough.
void ExplainGate(SteeringCheck& check, const std::string& key, const char* unit, double limit,
                 double does, double share) {
  if (limit > 1.5 * does) {
    check.causes.push_back(
        fmt::format("{:.0f} % of the poses were refused as jumps beyond {} {:g} {}, and the robot "
                    "does no more than {:.2g} {}: the camera's poses jump",
                    100.0 * share, key, limit, unit, does, unit));
    return;
  }
  check.causes.push_back(fmt::format(
      "{:.0f} % of the poses were refused as jumps beyond {} {:g} {}, and the robot does {:.2g} {}",
      100.0 * share, key, limit, unit, does, unit));
  Propose(check, key, limit, 3.0 * does);
}

/// True when so many poses were refused that the run tells nothing of the steering.
bool ExplainRefused(SteeringCheck& check, const Case& run) {
  const TrialResult& result = run.result;
  const auto refused = static_cast<double>(result.poses_refused),
             seen = refused + static_cast<double>(result.trajectory.poses.size());
  if (refused <= kMany * seen) return false;
  const control::PoseGateOptions& gate = run.navigator.pose_gate;
  check.is_identified = false;  // of so few poses
  const double moves = static_cast<double>(result.refused_moves) / seen,
               turns = static_cast<double>(result.refused_turns) / seen;
  if (moves > kMany) {
    ExplainGate(check, "control.pose_gate.max_speed_mps", "m/s", gate.max_speed_mps,
                run.prior.model.speed_mps * run.navigator.v_max, moves);
  }
  if (turns > kMany) {
    ExplainGate(check, "control.pose_gate.max_yaw_rate_rad_s", "rad/s", gate.max_yaw_rate_rad_s,
                run.prior.model.yaw_rate_rad_s * std::clamp(result.limits.largest_raw_w,
                                                            run.navigator.w_min,
                                                            std::min(1.0, run.navigator.w_max)),
                turns);
  }
  if (check.causes.empty()) {
    check.causes.push_back(fmt::format(
        "{:.0f} % of the poses were refused as jumps (control.pose_gate)", 100.0 * refused / seen));
  }
  return true;
}

double MeanInterval_s(const trajectory::Trajectory& log) {
  return (log.poses.back().t_s - log.poses.front().t_s) / static_cast<double>(log.poses.size() - 1);
}

/// True when so many decisions were zero power that the robot could not drive.
bool ExplainStale(SteeringCheck& check, const Case& run) {
  const TrialResult& result = run.result;
  const auto stale = static_cast<double>(result.stale_decisions),
             all = static_cast<double>(result.limits.decisions + result.stale_decisions);
  if (stale <= kMany * all) return false;
  const double limit_s = run.options.pose_stale_s, age_s = result.arrival_age_s;
  const std::string share =
      stale == all ? fmt::format("all {:.0f}", all) : fmt::format("{:.0f} %", 100.0 * stale / all);
  const double oldest_s = age_s + 2.0 * MeanInterval_s(result.trajectory);
  if (oldest_s < limit_s) {
    check.causes.push_back(fmt::format(
        "{}{} decisions were zero power: poses are {:.2f} s old when they come in, but then none "
        "came for so long that the last one was older than trial.pose_stale_s, {:g} s",
        share, stale == all ? "" : " of the", age_s, limit_s));
    return true;
  }
  check.causes.push_back(
      fmt::format("{}{} decisions were zero power: poses are {:.2f} s old when they come in, and "
                  "trial.pose_stale_s is {:g} s: make the camera faster, or this longer",
                  share, stale == all ? "" : " of the", age_s, limit_s));
  Propose(check, "trial.pose_stale_s", limit_s, 1.2 * oldest_s);
  return true;
}

/// Of a run that came nearer until its time was up.
void ExplainTime(SteeringCheck& check, const Case& run, const Progress& progress) {
  check.causes.push_back(
      fmt::format("it was on its way: {:.2f} m of the task's {:.2f} m in {:.1f} s, {:.2f} m left",
                  Length_m(run.task.waypoints) - progress.left_m, Length_m(run.task.waypoints),
                  progress.took_s, progress.left_m));
  ProposeTimeout(check, run.options,
                 1.5 * (progress.took_s + progress.left_m / progress.nearing_mps));
}

/// Of a robot that stood still at the end.
void ExplainStanding(SteeringCheck& check, const Case& run, const Progress& progress) {
  const SteeringPrior& prior = run.prior;
  const double from_s = run.result.trajectory.poses.back().t_s - progress.last_s;
  double largest = 0.0;
  for (const SentCommand& sent : run.result.commands) {
    if (sent.t_s < from_s) continue;
    largest = std::max({largest, std::abs(sent.power.left), std::abs(sent.power.right)});
  }
  const std::string stood =
      fmt::format("it does not move: {:.3f} m in the last {:.1f} s, at powers up to {:.2f}",
                  progress.moved_m, progress.last_s, largest);
  if (!(largest < prior.LeastPower())) {
    check.causes.push_back(
        prior.MovingPower() > 0.0
            ? stood +
                  fmt::format(", and its wheels should turn from {}: motors, battery, or a link "
                              "that loses the commands",
                              MovingText(prior))
            : stood + ": motors, battery, dead band, or a link that loses the commands");
    return;
  }
  check.causes.push_back(stood + ", and its wheels turn from " + MovingText(prior));
  NavigatorOptions wanted = run.navigator;
  // Both wheels turn, the slower one of the least steering too.
  wanted.v_min = std::max({wanted.v_min, prior.LeastPower(), prior.MovingPower() + wanted.w_min});
  wanted.v_max = std::max(wanted.v_max, wanted.v_min);
  const double least = wanted.v_min, pose_age_s = check.model.pose_age_s;
  if (run.navigator.cruise_speed && *run.navigator.cruise_speed < least) {
    Propose(check, "control.cruise_speed", *run.navigator.cruise_speed, least);
  }
  check.model = prior.model;  // a robot that stands shows nothing of its own
  check.model.pose_age_s = pose_age_s;
  check.is_identified = false;
  if (CircleRadius_m(wanted, check.model) > wanted.reach_radius_m) {
    const double delay_s = std::max(DelayOf(check.model, wanted), run.options.control_period_s);
    TightenCircle(check.model, prior, StableGains(wanted, check.model.yaw_rate_rad_s, delay_s),
                  wanted);
  }
  ProposeRun(check, run, wanted);
}

/// A fall, a fault and a person's stop have their own reason.
bool IsToExplain(Outcome outcome) {
  return outcome == Outcome::kTimedOut || outcome == Outcome::kLeftArena ||
         outcome == Outcome::kLost;
}

void Explain(SteeringCheck& check, const Case& run) {
  if (ExplainRefused(check, run)) return;
  const bool is_stale = ExplainStale(check, run);
  const Progress progress = ProgressOf(run.result, run.task.waypoints);
  if (progress.IsStanding() && !is_stale && !check.has_arrived) {
    ExplainStanding(check, run, progress);
    return;
  }
  const bool is_astray = !is_stale && IsAstray(check, run.result, run.task);
  ExplainSteering(check, run, is_astray);
  if (!check.causes.empty() || check.has_arrived) return;
  if (run.result.outcome == Outcome::kTimedOut && !is_astray && progress.IsNearing()) {
    ExplainTime(check, run, progress);
  } else {
    check.causes.push_back(fmt::format(
        "it came no nearer, {:.2f} m left, and no limit of the steering explains it: the phase "
        "margin is {:.0f} deg, and the circle at a heading error of 90 deg, {:.3f} m, lies within "
        "control.reach_radius_m",
        progress.left_m, check.margins.phase_margin_deg, check.circle_m));
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
  const double turn_rad_s = TurnAgainstPull_rad_s(model, asked.v, asked.w);
  return turn_rad_s > 0.0 ? model.speed_mps * asked.v / turn_rad_s
                          : std::numeric_limits<double>::infinity();
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
  const bool has_decided = result.limits.decisions + result.stale_decisions > 0;
  if (task.program || result.trajectory.poses.size() < 2 || !has_decided) return check;
  check.has_arrived = result.outcome == Outcome::kReached;
  check.turns = MostTurns(result.trajectory);
  const bool is_reversed = Identify(result, prior, check);
  check.delay_s = DelayOf(check.model, navigator);
  check.margins = MarginsOf(navigator.heading, check.model.yaw_rate_rad_s, check.delay_s);
  check.circle_m = CircleRadius_m(navigator, check.model);
  check.swing = SwingOf(navigator, check.model, check.delay_s);
  if (is_reversed) {
    check.causes.push_back(
        "it turned to the right when it was steered to the left: its motors are swapped, one of "
        "them runs backwards, or the camera's picture is mirrored");
    return check;
  }
  if (!IsToExplain(result.outcome) && !check.HasCircled()) return check;
  Explain(check, {result, task, navigator, options, prior});
  return check;
}

namespace {

/// The newer value of a key counts; false when nothing changed.
bool Merge(std::vector<KeyProposal>& all, const std::vector<KeyProposal>& more) {
  bool has_changed = false;
  for (const KeyProposal& proposal : more) {
    const auto known = std::find_if(
        all.begin(), all.end(), [&](const KeyProposal& old) { return old.key == proposal.key; });
    if (known == all.end()) {
      all.push_back(proposal);
      has_changed = true;
    } else if (known->value != proposal.value) {
      known->value = proposal.value;
      has_changed = true;
    }
  }
  return has_changed;
}

}  // namespace

void TryProposals(SteeringCheck& check,
                  const std::function<TriedRun(const std::vector<KeyProposal>&)>& run_with) {
  constexpr size_t kMostTries = 5;
  if (check.proposals.empty()) return;
  std::vector<KeyProposal> all = check.proposals;
  check.proposals.clear();
  for (check.failed_tries = 0; check.failed_tries < kMostTries; ++check.failed_tries) {
    const TriedRun run = run_with(all);
    const bool is_direct = !check.has_arrived || !run.check.HasCircled();
    if (run.result.outcome == Outcome::kReached && is_direct) {
      check.tried_s = run.result.Duration_s();
      std::erase_if(all, [&](const KeyProposal& proposal) {  // it was in time
        return proposal.key == "trial.timeout_s" && proposal.was > *check.tried_s;
      });
      check.proposals = all;
      return;
    }
    if (!Merge(all, run.check.proposals)) {
      ++check.failed_tries;
      return;
    }
  }
}

}  // namespace rift::trial
