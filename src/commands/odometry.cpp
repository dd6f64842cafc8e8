#include "odometry.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>

#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

/// The files of a run: those of its folder, or those beside a log.
struct RunFiles {
  explicit RunFiles(const fs::path& run) {
    const bool is_folder = fs::is_directory(run);
    const fs::path folder = is_folder ? run : run.parent_path();
    trajectory = is_folder ? run / "trajectory.csv" : run;
    // `rift simulate --out sim.csv` writes sim.encoders.csv beside it.
    const fs::path beside = fs::path(trajectory).replace_extension("encoders.csv");
    encoders = !is_folder && fs::exists(beside) ? beside : folder / "encoders.csv";
    const fs::path task = fs::path(trajectory).replace_extension("experiment.yaml");
    experiment = !is_folder && fs::exists(task) ? task : folder / "experiment.yaml";
  }

  fs::path trajectory, encoders, experiment;
};

/// A run and the experiment that it was of.
struct LoadedRun {
  odometry::ProgramRun run;
  std::optional<experiment::Experiment> experiment;
};

LoadedRun Load(const OdometryRequest& request, const std::string& name) {
  const RunFiles files(name);
  trajectory::Log log =
      trajectory::ReadLog(files::ReadFile(files.trajectory), files.trajectory.string());
  LoadedRun loaded{.run = {.log = {.name = name, .camera = std::move(log.trajectory)}}};
  if (const auto encoders = files::ReadIfThere(files.encoders)) {
    loaded.run.log.encoders = odometry::ReadEncoders(*encoders, files.encoders.string());
  }
  const bool is_told = !request.program.empty();
  if (is_told || fs::exists(files.experiment)) {
    loaded.experiment = ReadExperiment(is_told ? request.program : files.experiment.string(), {});
    if (!loaded.experiment->program.segments.empty()) {
      loaded.run.program = sweep::IdealPath(experiment::TaskOf(*loaded.experiment));
    } else if (is_told) {
      throw std::invalid_argument(fmt::format(
          "{}: has no program: name an experiment with program.segments", request.program));
    }
  }
  if (!loaded.run.program && loaded.run.log.encoders.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: has neither encoders ({}) nor a program to be held against: name a run "
                    "folder, or an experiment with --program",
                    name, files.encoders.string()));
  }
  return loaded;
}

/// Repeats of one program under one setting are a cell; other runs only stand side by side.
bool AreRepeats(const std::vector<LoadedRun>& runs) {
  for (const LoadedRun& run : runs) {
    if (!run.run.program || !runs.front().run.program) return false;
    const auto& a = run.run.program->poses;
    const auto& b = runs.front().run.program->poses;
    if (a.size() != b.size()) return false;
    for (size_t i = 0; i < a.size(); ++i) {
      if (a[i].t_s != b[i].t_s || a[i].Position() != b[i].Position()) return false;
    }
  }
  return true;
}

}  // namespace

int MeasureOdometry(const OdometryRequest& request) {
  std::vector<fs::path> inputs, outputs;
  std::vector<LoadedRun> loaded;
  for (const std::string& name : request.runs) {
    loaded.push_back(Load(request, name));
    const RunFiles files(name);
    inputs.insert(inputs.end(), {files.trajectory, files.encoders, files.experiment});
  }
  if (!request.json.empty() && request.json != "-") outputs.emplace_back(request.json);
  CheckOutputs(inputs, {.files = outputs, .force = request.force});

  odometry::OdometryOptions wheels;
  odometry::RunOptions options = request.options;
  if (const auto& experiment = loaded.front().experiment) {
    wheels = experiment->hardware.odometry;
    if (options.tag_ahead_m == 0.0) options.tag_ahead_m = experiment->simulation.mocap.tag_ahead_m;
  }
  std::vector<odometry::ProgramRun> runs;
  std::vector<odometry::RunLog> logs;
  for (LoadedRun& run : loaded) {
    logs.push_back(run.run.log);
    runs.push_back(run.run);
  }
  odometry::OdometryResult result =
      odometry::MeasureRuns(runs, AreRepeats(loaded), wheels, options);
  if (request.calibrate) {
    std::erase_if(logs, [](const odometry::RunLog& log) { return log.encoders.empty(); });
    result.calibration = odometry::CalibrateOdometry(logs, wheels, request.calibration);
    result.confidence = request.calibration.confidence;
  }
  if (request.json == "-") {
    terminal::PrintData(report::OdometryJson(result));
    return terminal::kDone;
  }
  if (!request.json.empty()) files::WriteFile(request.json, report::OdometryJson(result));
  terminal::PrintText(report::OdometryText(result));
  return terminal::kDone;
}

}  // namespace rift::commands
