#include "rift/sessions/sweep/engine.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "rift/files/files.hpp"
#include "rift/sweep/falsify/program_files.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"

namespace rift::sessions {
namespace {

std::optional<sweep::SlurmOptions> ClusterOf(const EngineRequest& request) {
  if (request.engine == "local") {
    if (request.partition.empty() && !request.shards) return std::nullopt;
    throw std::invalid_argument(
        fmt::format("--{} is for --engine slurm", request.shards ? "shards" : "partition"));
  }
  sweep::SlurmOptions options;
  if (request.engine != "slurm") {
    const std::string file = files::FindInput(request.engine);
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
  if (request.shards) options.shards = *request.shards;
  return options;
}

}  // namespace

std::optional<sweep::SlurmOptions> ClusterFor(const EngineRequest& request,
                                              const experiment::Experiment& experiment,
                                              const std::string& file) {
  const std::optional<sweep::SlurmOptions> cluster = ClusterOf(request);
  // A cluster's nodes have programs of their own.
  if (!cluster) sweep::RequirePrograms(experiment, file);
  if (cluster && experiment.candidate.kind == experiment::CandidateKind::kLogs) {
    throw std::invalid_argument(fmt::format(
        "{}: candidate.kind is logs, which are compared here in seconds: leave --engine out",
        file));
  }
  return cluster;
}

}  // namespace rift::sessions
