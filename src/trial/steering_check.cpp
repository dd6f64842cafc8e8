#include "rift/trial/steering_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "identified_steering.hpp"
#include "progress.hpp"
#include "rift/geometry/pose2.hpp"
#include "wanted_steering.hpp"

namespace rift::trial {
namespace {

using control::NavigatorOptions;
using geometry::DegFromRad;
using std::numbers::pi;

constexpr double kLeastMargin_deg = 30.0;  // below, a loop overshoots by half and more
constexpr double kLargestSwing_deg = 45.0, kWantedSwing_deg = 15.0;
constexpr double kMany = 0.2;  // of the decisions, or of the poses
constexpr double kLargestHold_rad = pi / 4.0;
constexpr double kLongest_s = 3600.0;  // of trial.timeout_s
constexpr double kFullPower = 1.0;

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
  const SteeringCommand asked = OnCircle(navigator, check.model);
  const double wanted_w = SteeringAt(navigator, kQuarterTurn_rad);
  std::string text = fmt::format(
      "a waypoint counts as reached within {:g} m (control.reach_radius_m), and it {}: at a "
      "heading error of 90 deg control.heading.p {:g} asks for w {:.3g}",
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

/// Why the steering that drives straight comes late or never.
std::string HoldText(const NavigatorOptions& navigator, double hold_w) {
  if (hold_w > navigator.w_max) return fmt::format("control.w_max allows {:g}", navigator.w_max);
  const control::PidGains& heading = navigator.heading;
  const std::string integral =
      heading.i > 0.0 ? fmt::format(" and control.heading.i {:g}", heading.i) : "";
  const double error_rad = HoldError_rad(navigator, hold_w);
  if (std::isfinite(error_rad)) {
    return fmt::format(
        "control.heading.p {:g}{} ask{} for that only at a heading error of {:.0f} deg", heading.p,
        integral, heading.i > 0.0 ? "" : "s", DegFromRad(error_rad));
  }
  return fmt::format("control.heading.p {:g}{} ask{} for {:.2g} at any heading error", heading.p,
                     integral, heading.i > 0.0 ? "" : "s", SteeringAt(navigator, 0.0));
}

std::string PullCause(const SteeringCheck& check, const NavigatorOptions& navigator) {
  const SteeringModel& model = check.model;
  const double hold_w = HoldSteering(model, navigator.v_max);
  return fmt::format(
      "it pulls to the {} by {:.2g} rad/s at v {:g} without steering (a motor or wheel that "
      "differs from the other, or drags{}): driving straight takes w {:.2g}, and {}",
      model.pull_rad_s > 0.0 ? "left" : "right", std::abs(model.pull_rad_s) * navigator.v_max,
      navigator.v_max,
      check.is_pull_told ? "" : "; or it answers to w otherwise than the robot's file says", hold_w,
      HoldText(navigator, hold_w));
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
  if (now.cruise_speed) {  // no experiment has it outside of v_min and v_max
    Propose(check, "control.cruise_speed", *now.cruise_speed,
            std::clamp(*now.cruise_speed, wanted.v_min, wanted.v_max));
  }
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
             seen = refused + static_cast<double>(result.poses_believed);
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

/// Of the poses that came in, of which the log may hold a part.
double MeanInterval_s(const TrialResult& result) {
  const std::vector<trajectory::StampedPose>& logged = result.trajectory.poses;
  return (logged.back().t_s - logged.front().t_s) / static_cast<double>(result.poses_believed - 1);
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
  const double oldest_s = age_s + 2.0 * MeanInterval_s(result);
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
        stood +
        (prior.MovingPower() > 0.0
             ? fmt::format(", and its wheels should turn from {}: motors, battery",
                           MovingText(prior))
             : std::string(": motors, battery, dead band")) +
        ", a link that loses the commands, or a floor that holds it (slope, obstacle, no grip, a "
        "caster that drags)");
    return;
  }
  check.causes.push_back(stood + ", and its wheels turn from " + MovingText(prior));
  if (prior.LeastPower() > kFullPower) {
    check.causes.back() +=
        fmt::format(", evenly from {:.2g}: full power, 1, is too little for this motor and load",
                    prior.LeastPower());
    return;
  }
  NavigatorOptions wanted = run.navigator;
  // Both wheels turn, the slower one of the least steering too.
  const double least_v = std::max(prior.LeastPower(), prior.MovingPower() + wanted.w_min);
  wanted.v_min = std::max(wanted.v_min, std::min(least_v, kFullPower));
  wanted.v_max = std::max(wanted.v_max, wanted.v_min);
  const double pose_age_s = check.model.pose_age_s;
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

/// Of those that are explained.
std::string_view HowItEnded(Outcome outcome) {
  if (outcome == Outcome::kLeftArena) return "it left the arena (trial.arena)";
  return outcome == Outcome::kLost ? "it was lost from sight" : "it came no nearer";
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
    const bool is_within = check.circle_m <= run.navigator.reach_radius_m;
    check.causes.push_back(fmt::format(
        "{}, {:.2f} m left, and no limit of the steering explains it: the phase margin is {:.0f} "
        "deg, and the circle at a heading error of 90 deg, {:.3f} m, {} control.reach_radius_m",
        HowItEnded(run.result.outcome), progress.left_m, check.margins.phase_margin_deg,
        check.circle_m, is_within ? "lies within" : "is larger than"));
  }
}

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

SteeringCheck CheckSteering(const TrialResult& result, const control::Task& task,
                            const NavigatorOptions& navigator, const TrialOptions& options,
                            const SteeringPrior& prior) {
  SteeringCheck check;
  const bool has_decided = result.limits.decisions + result.stale_decisions > 0;
  if (task.program || result.trajectory.poses.size() < 2 || !has_decided) return check;
  check.has_arrived = result.outcome == Outcome::kReached;
  check.turns = MostTurns(result.trajectory);
  const IdentifiedSteering identified = IdentifySteering(result, prior, check.turns);
  check.model = identified.model;
  check.is_identified = identified.is_identified;
  check.is_pull_told = identified.is_pull_told;
  check.r2 = identified.r2;
  check.delay_s = DelayOf(check.model, navigator);
  check.margins = MarginsOf(navigator.heading, check.model.yaw_rate_rad_s, check.delay_s);
  check.circle_m = CircleRadius_m(navigator, check.model);
  check.swing = SwingOf(navigator, check.model, check.delay_s);
  if (identified.is_reversed) {
    check.causes.push_back(
        "it turned to the right when it was steered to the left: its motors are swapped, one of "
        "them runs backwards, or the camera's picture is mirrored");
    return check;
  }
  if (!IsToExplain(result.outcome) && !check.HasCircled()) return check;
  Explain(check, {result, task, navigator, options, prior});
  return check;
}

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
