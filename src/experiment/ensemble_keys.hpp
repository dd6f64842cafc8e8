#pragma once

#include "rift/experiment/experiment.hpp"
#include "rift/yaml/node.hpp"

namespace rift::experiment {

/// Leaves out of the ensemble what was set in another place than its draws were written in, and
/// tries every draw. `tree`: what the experiment was made of. Throws Error for an unknown key, one
/// that no simulated run depends on, and a value that breaks a rule.
void ResolveEnsemble(Experiment& experiment, const yaml::Node& tree);

}  // namespace rift::experiment
