#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"

namespace rift::commands {

/// The experiment in a file, with `overrides` (`a.b=c`) on top. Throws as LoadExperiment does.
experiment::Experiment ReadExperiment(const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides = {});

/// The experiment's tag. Where its surface is bumps, a ramp or a heightfield the tag is not held to
/// a flat floor (TagOptions::ground): `flat` becomes what the surface allows.
vision::TagOptions TagOn(const experiment::Experiment& experiment);

/// Files for computation, whose notes go to stderr.
sweep::Inputs FileInputs();

}  // namespace rift::commands
