#pragma once

#include <functional>
#include <string>

#include "rift/experiment/experiment.hpp"

namespace rift::sessions {

/// The experiment as it is swept: a simulated sweep over no space means the paper's grid, while
/// logs without a space are one setting.
experiment::Experiment PlanSweep(experiment::Experiment loaded);

/// Tells `say` what a person should know of the plan before it is run, one line each: the space
/// that `file` does not name, headings that do nothing, a robot that does not stand level, too few
/// repeats to falsify.
void NotePlan(const experiment::Experiment& loaded, const std::string& file,
              const std::function<void(const std::string&)>& say);

}  // namespace rift::sessions
