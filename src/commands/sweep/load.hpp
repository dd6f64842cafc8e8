#pragma once

#include <filesystem>

#include "request.hpp"
#include "rift/experiment/experiment.hpp"

namespace rift::commands {

/// The experiment that was asked for, budgets included. Throws std::invalid_argument where flags,
/// experiment and the name of the folder do not go together.
experiment::Experiment LoadFor(const SweepRequest& request);

/// The experiment as it is swept. Throws std::invalid_argument when what was asked for beyond
/// cannot be met by it, before a trial is run.
experiment::Experiment PlanFor(const SweepRequest& request, experiment::Experiment loaded);

/// What a person should know of the plan before it is run.
void NotePlan(const SweepRequest& request, const experiment::Experiment& loaded,
              const experiment::Experiment& planned);

/// Where the files go. Throws std::invalid_argument for the folder of a run, and for one that holds
/// another experiment unless it may be replaced.
std::filesystem::path FolderFor(const SweepRequest& request,
                                const experiment::Experiment& experiment);

}  // namespace rift::commands
