#include "engine.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "progress.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/files/files.hpp"
#include "rift/sessions/sweep/shard.hpp"
#include "rift/sweep/falsify/program_files.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"

namespace rift::commands {
namespace {

std::optional<sweep::SlurmOptions> ClusterOf(const EngineRequest& request) {
  if (request.engine == "local") {
    if (request.partition.empty() && request.shards == 0) return std::nullopt;
    throw std::invalid_argument(
        fmt::format("--{} is for --engine slurm", request.shards > 0 ? "shards" : "partition"));
  }
  sweep::SlurmOptions options;
  if (request.engine != "slurm") {
    const std::string file = FindInput(request.engine);
    if (!file.ends_with(".yaml")) {
      throw std::invalid_argument(
          fmt::format("--engine {}: must be local, slurm or a file such as "
                      "configs/engines/slurm.yaml",
                      request.engine));
    }
    yaml::Bind(yaml::Load(file, [](const std::string& path) { return files::ReadFile(path); }),
               options);
  }
  if (!request.partition.empty()) options.partition = request.partition;
  if (request.shards > 0) options.shards = request.shards;
  return options;
}

}  // namespace

std::optional<sweep::SlurmOptions> ClusterFor(const SweepRequest& request,
                                              const experiment::Experiment& experiment) {
  const std::optional<sweep::SlurmOptions> cluster = ClusterOf(request.engine);
  // A cluster's nodes have programs of their own.
  if (!cluster) sweep::RequirePrograms(experiment, request.experiment);
  if (cluster && experiment.candidate.kind == experiment::CandidateKind::kLogs) {
    throw std::invalid_argument(fmt::format(
        "{}: candidate.kind is logs, which are compared here in seconds: leave --engine out",
        request.experiment));
  }
  return cluster;
}

int ComputeShard(const SweepRequest& request, const experiment::Experiment& experiment) {
  const sessions::ShardFile shard = sessions::ReadShard(request.engine.shard, experiment);
  const bool is_done = sessions::RunShard(shard, experiment, request.experiment, FileInputs(),
                                          {.out = OutputOf(request.out, experiment.name),
                                           .jobs = request.jobs,
                                           .copy_every_s = request.engine.copy_every_s},
                                          ObserverFor(ProgressStyle::kQuiet));
  return is_done ? terminal::kDone : terminal::kStopped;
}

}  // namespace rift::commands
