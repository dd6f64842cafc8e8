#include "rift/sessions/simulate/run.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "rift/files/files.hpp"
#include "rift/odometry/odometry.hpp"
#include "rift/report/json/json.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/yaml/bind.hpp"

namespace rift::sessions {

namespace fs = std::filesystem;

trial::SteeringCheck CheckOf(const Simulated& made) {
  trial::SteeringCheck check = report::SteeringOf(made.experiment, made.run);
  trial::TryProposals(check, [&made](const std::vector<trial::KeyProposal>& proposals) {
    experiment::Experiment experiment = made.experiment;
    std::vector<yaml::KeyValue> values;
    for (const trial::KeyProposal& proposal : proposals) {
      yaml::Node value = yaml::Node::Scalar(fmt::format("{:g}", proposal.value));
      value.origin.source = "proposal";
      values.push_back({proposal.key, value});
    }
    yaml::SetValues(experiment, values);
    sweep::SimulatedTrial trial = made.trial;
    trial.control = experiment.control;
    trial.trial = experiment.trial;
    sweep::SimulatedRun run = sweep::Simulate(trial);
    trial::SteeringCheck of_run = report::SteeringOf(experiment, run);
    return trial::TriedRun{std::move(run.result), std::move(of_run)};
  });
  return check;
}

RunFiles::RunFiles(const fs::path& out) {
  const bool is_file = out.extension() == ".csv";
  const std::string stem = is_file ? fs::path(out).replace_extension().string() + "." : "";
  trajectory = is_file ? out : out / "trajectory.csv";
  for (const auto& [path, name] : {std::pair{&truth, "truth.csv"},
                                   {&commands, "commands.csv"},
                                   {&encoders, "encoders.csv"},
                                   {&experiment, "experiment.yaml"},
                                   {&summary, "summary.json"}}) {
    *path = is_file ? fs::path(stem + name) : out / name;
  }
}

bool IsSaved(const experiment::Experiment& experiment, const RunFiles& files) {
  return fs::is_regular_file(files.experiment) &&
         files::ReadFile(files.experiment) == experiment::WriteExperiment(experiment);
}

void SaveRun(const RunFiles& files, const Simulated& made, const trial::SteeringCheck& check) {
  const experiment::Experiment& experiment = made.experiment;
  const sweep::SimulatedRun& run = made.run;
  files::WriteFile(files.experiment, experiment::WriteExperiment(experiment));
  files::WriteFile(files.truth, trajectory::WriteRift(run.truth));
  files::WriteFile(files.commands, report::CommandsCsv(run.result));
  if (!run.encoders.empty()) {
    files::WriteFile(files.encoders, odometry::EncodersCsv(run.encoders));
  }
  files::WriteFile(files.summary, report::SimulationJson(experiment, run, check));
  files::WriteFile(files.trajectory, trajectory::WriteRift(run.result.trajectory));
}

}  // namespace rift::sessions
