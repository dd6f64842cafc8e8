#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rift/control/controller.hpp"
#include "rift/control/options.hpp"
#include "rift/trial/options.hpp"
#include "rift/trial/trial.hpp"

namespace rift::trial {

/// How a robot answers the steering: forward speed and yaw rate in proportion to v and w, late.
struct SteeringModel {
  double speed_mps = 0.0;        ///< forward, for each unit of v
  double yaw_rate_rad_s = 0.0;   ///< for each unit of w, which is half of power_right - power_left
  double pose_age_s = 0.0;       ///< mean age of the pose that a decision is made on
  double command_delay_s = 0.0;  ///< from a command to the motion it causes
  double pull_rad_s = 0.0;  ///< yaw rate without steering, for each unit of v; above 0 to the left
};

/// What a robot's file says of it, for a run that does not tell.
struct SteeringPrior {
  SteeringModel model;
  double dead_band = 0.0;        ///< smaller powers do not reach the motors
  double breakaway_power = 0.0;  ///< smaller ones do not turn a wheel at rest, by its friction

  double MovingPower() const { return std::max(dead_band, breakaway_power); }
  /// A wheel turns evenly a little above what turns it at all.
  double LeastPower() const { return 1.2 * MovingPower(); }
};

/// Stability of the heading loop far from its waypoint: gain (p + i / s + d s) / s with a delay.
struct SteeringMargins {
  double crossover_rad_s = 0.0;   ///< where the loop's gain is 1; infinite when it never falls to 1
  double phase_margin_deg = 0.0;  ///< below 0: unstable
  double longest_delay_s = 0.0;   ///< at which the margin is 0
};

/// Closed form. `yaw_rate_rad_s` as in SteeringModel.
SteeringMargins MarginsOf(const control::PidGains& heading, double yaw_rate_rad_s, double delay_s);

/// Radius of the circle on which the robot drives round a waypoint for ever: the heading error
/// stays at 90 degrees there, and a delay changes nothing. To the side against which the robot
/// pulls; infinite when it cannot turn to it.
double CircleRadius_m(const control::NavigatorOptions& navigator, const SteeringModel& model);

/// How far w_min alone swings the robot: its sign changes a delay after the heading error's.
struct SteeringSwing {
  double heading_rad = 0.0;  ///< to each side
  double path_m = 0.0;       ///< to each side, at v_min
};
SteeringSwing SwingOf(const control::NavigatorOptions& navigator, const SteeringModel& model,
                      double delay_s);

/// A key of the experiment, the value it had, and one that would do.
struct KeyProposal {
  std::string key;
  double was = 0.0;
  double value = 0.0;
};

/// Why a robot circled or did not arrive, as far as its steering can tell.
struct SteeringCheck {
  double turns = 0.0;          ///< most whole turns on the way to one waypoint, of either sense
  bool is_identified = false;  ///< the model is of the run itself; else of the prior
  bool is_pull_told = false;   ///< apart from the gain; else it may be that gain is less
  double r2 = 0.0;             ///< share of the yaw rate's variance that the steering explains
  SteeringModel model;
  double delay_s = 0.0;  ///< of the loop, less what control.latency makes up for
  SteeringMargins margins;
  double circle_m = 0.0;
  SteeringSwing swing;
  std::vector<std::string> causes;     ///< for people; empty for a run that arrived directly
  std::vector<KeyProposal> proposals;  ///< gains and limits that mend the causes
  bool has_arrived = false;
  /// How long a simulated run with the proposals took to arrive; none: not tried.
  std::optional<double> tried_s;
  size_t failed_tries = 0;  ///< simulated runs with proposals that did not arrive

  bool HasCircled() const { return turns >= 1.0; }
};

/// Identifies the steering from the commands and poses of a run, and holds the navigator against
/// it. A run of a program, or without a pose, has nothing to tell: no cause.
SteeringCheck CheckSteering(const TrialResult& result, const control::Task& task,
                            const control::NavigatorOptions& navigator, const TrialOptions& options,
                            const SteeringPrior& prior);

/// A run once more with some keys set anew, and what its check says.
struct TriedRun {
  TrialResult result;
  SteeringCheck check;
};

/// Keeps only proposals with which the robot arrives: runs with them, and as long as that does not
/// arrive, with what the next check proposes beside them, a few times. Without an arrival there is
/// no proposal.
void TryProposals(SteeringCheck& check,
                  const std::function<TriedRun(const std::vector<KeyProposal>&)>& run_with);

}  // namespace rift::trial
