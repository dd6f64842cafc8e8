#pragma once

#include <optional>

#include "request.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/sweep/run/slurm_options.hpp"

namespace rift::commands {

/// The habits of the cluster that trials are run on; nothing where they are run on this machine.
/// Throws std::invalid_argument for an engine that is none, for an experiment that has no trials to
/// be handed out, and for a program that is not on this machine and needed here; yaml::Error for a
/// wrong file.
std::optional<sweep::SlurmOptions> ClusterFor(const SweepRequest& request,
                                              const experiment::Experiment& experiment);

/// What a job of --engine slurm does: computes a shard into OUT/shards (sessions::RunShard).
/// Returns the exit code.
int ComputeShard(const SweepRequest& request, const experiment::Experiment& experiment);

}  // namespace rift::commands
