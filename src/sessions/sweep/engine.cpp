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

/// Why programs of an experiment have to be on this machine as well as on the nodes; nullptr where
/// they have not.
const char* WhyNeededHere(const experiment::Experiment& experiment,
                          const sweep::SlurmOptions& cluster) {
  if (experiment.goal == experiment::Goal::kCalibrate) return nullptr;
  if (experiment.candidate.kind == experiment::CandidateKind::kProgram &&
      experiment.reference.kind == experiment::ReferenceKind::kNominal) {
    return "with --engine it has to be here as well, where the nominal runs come first";
  }
  if (experiment.goal == experiment::Goal::kGrid && cluster.shards == 0) {
    return "where it is on the nodes of the cluster alone, say --shards N: without it a few trials "
           "are run here, to tell how many shards the others need";
  }
  return nullptr;
}

void RequireProgramsHere(const experiment::Experiment& experiment, const std::string& file,
                         const char* why) {
  try {
    sweep::RequirePrograms(experiment, file);
  } catch (const std::invalid_argument& missing) {
    throw std::invalid_argument(fmt::format("{}; {}", missing.what(), why));
  }
}

}  // namespace

std::optional<sweep::SlurmOptions> ClusterFor(const EngineRequest& request,
                                              const experiment::Experiment& experiment,
                                              const std::string& file) {
  const std::optional<sweep::SlurmOptions> cluster = ClusterOf(request);
  if (!cluster) {
    sweep::RequirePrograms(experiment, file);
  } else if (const char* why = WhyNeededHere(experiment, *cluster)) {
    RequireProgramsHere(experiment, file, why);
  }
  if (cluster && experiment.candidate.kind == experiment::CandidateKind::kLogs) {
    throw std::invalid_argument(fmt::format(
        "{}: candidate.kind is logs, which are compared here in seconds: leave --engine out",
        file));
  }
  return cluster;
}

}  // namespace rift::sessions
