#pragma once

#include <vector>

#include "rift/experiment/experiment.hpp"

namespace rift::experiment {

/// What a program is told at each trial: the parameters of the space, and with goal: calibrate, in
/// which the program is the candidate, behind them those that are fitted, as ranges whose nominal
/// value is where the fit starts.
std::vector<Parameter> ProgramParameters(const Experiment& experiment);

/// A setting of the space with values of the fitted parameters behind it.
Theta WithFitted(Theta theta, const std::vector<double>& values);

}  // namespace rift::experiment
