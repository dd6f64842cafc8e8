#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rift/control/options.hpp"
#include "rift/trial/options.hpp"
#include "rift/trial/steering_loop.hpp"
#include "rift/trial/trial.hpp"

namespace rift::trial {

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
