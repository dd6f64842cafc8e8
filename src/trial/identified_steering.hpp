#pragma once

#include "rift/trial/steering_loop.hpp"
#include "rift/trial/trial.hpp"

namespace rift::trial {

/// How a robot answered the steering in one run.
struct IdentifiedSteering {
  SteeringModel model;         ///< of the prior where the run does not tell
  bool is_identified = false;  ///< the model is of the run itself
  bool is_pull_told = false;   ///< apart from the gain
  bool is_reversed = false;    ///< it turned to the right when it was steered to the left
  double r2 = 0.0;             ///< share of the yaw rate's variance that the steering explains
};

/// From the commands and poses of a run with two poses at least. `turns` is how far it turned on
/// the way to one waypoint, in whole turns: only a robot that turned away can be reversed.
IdentifiedSteering IdentifySteering(const TrialResult& result, const SteeringPrior& prior,
                                    double turns);

}  // namespace rift::trial
