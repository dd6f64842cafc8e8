#include "rift/sessions/simulate/run.hpp"

#include <fmt/format.h>

#include <array>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "rift/experiment/task.hpp"
#include "rift/files/files.hpp"
#include "rift/files/outputs.hpp"
#include "rift/odometry/odometry.hpp"
#include "rift/report/json/json.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/yaml/bind.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;

bool IsSaved(const experiment::Experiment& experiment, const fs::path& path) {
  return fs::is_regular_file(path) &&
         files::ReadFile(path) == experiment::WriteExperiment(experiment);
}

}  // namespace

void RefuseDriveFolder(const fs::path& out) {
  const bool is_file = out.extension() == ".csv";
  const fs::path folder = is_file ? out.parent_path() : out;
  if (!fs::exists(folder / "stages.csv") || (is_file && !fs::exists(out))) return;
  throw std::invalid_argument(
      fmt::format("{} is a drive of the robot, which nothing replaces since it cannot be made "
                  "again: name another folder",
                  out.string()));
}

void PutStart(const std::string& text, experiment::Experiment& experiment) {
  constexpr std::array<const char*, 3> kKeys{"x", "y", "heading"};
  std::vector<std::string> words;
  std::istringstream parts(text);
  for (std::string word; std::getline(parts, word, ',');) words.push_back(word);
  if (words.size() != kKeys.size()) {
    throw std::invalid_argument(
        fmt::format("--start '{}': give X,Y,YAW_DEG, such as -0.28,-0.06,10", text));
  }
  std::vector<yaml::KeyValue> values;
  for (size_t i = 0; i < words.size(); ++i) {
    yaml::Node value = yaml::Node::Scalar(words[i]);
    value.origin.source = "--start";
    values.push_back({fmt::format("waypoints[0].{}", kKeys[i]), value});
  }
  yaml::SetValues(experiment, values);
}

sweep::SimulatedTrial TrialAlone(const experiment::Experiment& experiment,
                                 const std::string& experiment_file, const sweep::Inputs& inputs) {
  const experiment::Experiment drawn = experiment::DrawnAt(experiment, experiment.seed);
  sweep::SimulatedTrial trial =
      sweep::SimulatedTrialOf(drawn, {}, experiment.seed, experiment_file, inputs);
  trial.start = experiment::AxleAtStart(drawn);
  return trial;
}

trial::SteeringCheck CheckOf(const Simulated& made) {
  const experiment::Experiment drawn = experiment::DrawnAt(made.experiment, made.trial.seed);
  trial::SteeringCheck check = report::SteeringOf(drawn, made.run);
  trial::TryProposals(check, [&](const std::vector<trial::KeyProposal>& proposals) {
    experiment::Experiment experiment = drawn;
    std::vector<yaml::KeyValue> values;
    for (const trial::KeyProposal& proposal : proposals) {
      yaml::Node value = yaml::Node::Scalar(fmt::format("{:g}", proposal.value));
      value.origin.source = "proposal";
      values.push_back({proposal.key, value});
    }
    try {
      yaml::SetValues(experiment, values);
    } catch (const yaml::Error&) {  // a key or a rule between keys allows no such values
      return trial::TriedRun{{.outcome = trial::Outcome::kTimedOut}, {}};
    }
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

void CheckRunNames(const fs::path& out, const experiment::Experiment& experiment,
                   const std::vector<fs::path>& inputs, const std::vector<fs::path>& others,
                   bool force) {
  const fs::path folder = out.extension() == ".csv" ? fs::path() : out;
  std::vector<fs::path> taken = inputs;
  if (out != "-") {
    RefuseDriveFolder(out);
    const RunFiles run(out);
    const bool is_repeat = IsSaved(experiment, run.experiment);
    std::vector<fs::path> written{run.trajectory, run.truth, run.commands, run.encoders,
                                  run.summary};
    if (!is_repeat) written.push_back(run.experiment);
    files::CheckOutputs(inputs, {.files = written, .folder = folder, .force = force || is_repeat});
    taken.insert(taken.end(), written.begin(), written.end());
  }
  files::CheckOutputs(taken, {.files = others, .folder = folder, .force = force});
}

void SaveRun(const RunFiles& files, const Simulated& made, const trial::SteeringCheck& check) {
  const experiment::Experiment& experiment = made.experiment;
  const sweep::SimulatedRun& run = made.run;
  files::WriteFile(files.experiment, experiment::WriteExperiment(experiment));
  files::WriteFile(files.truth, trajectory::WriteRift(run.truth));
  files::WriteFile(files.commands, report::CommandsCsv(run.result));
  if (run.encoders.empty()) {
    fs::remove(files.encoders);  // of an earlier run, which this one replaces
  } else {
    files::WriteFile(files.encoders, odometry::EncodersCsv(run.encoders));
  }
  files::WriteFile(files.summary, report::SimulationJson(experiment, run, check));
  files::WriteFile(files.trajectory, trajectory::WriteRift(run.result.trajectory));
}

}  // namespace rift::sessions
