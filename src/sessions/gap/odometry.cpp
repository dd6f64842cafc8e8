#include "rift/sessions/gap/odometry.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <system_error>
#include <utility>

#include "rift/files/files.hpp"
#include "rift/gap/result.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/trajectory/csv.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;

/// A name that cannot be looked up, as a link to itself, is there: who reads it says why it cannot.
bool IsThere(const fs::path& path) {
  std::error_code none;
  return fs::status(path, none).type() != fs::file_type::not_found;
}

/// The files of a run: those of its folder, or those beside a log.
struct RunFiles {
  explicit RunFiles(const fs::path& run) {
    std::error_code none;
    const bool is_folder = fs::is_directory(run, none);
    const fs::path folder = is_folder ? run : run.parent_path();
    trajectory = is_folder ? run / "trajectory.csv" : run;
    // `rift simulate --out sim.csv` writes sim.encoders.csv beside it.
    const fs::path beside = fs::path(trajectory).replace_extension("encoders.csv");
    encoders = !is_folder && IsThere(beside) ? beside : folder / "encoders.csv";
    const fs::path task = fs::path(trajectory).replace_extension("experiment.yaml");
    experiment = !is_folder && IsThere(task) ? task : folder / "experiment.yaml";
    const fs::path true_path = fs::path(trajectory).replace_extension("truth.csv");
    truth = !is_folder && IsThere(true_path) ? true_path : folder / "truth.csv";
  }

  fs::path trajectory, encoders, experiment;
  fs::path truth;  ///< of a simulated run alone
};

/// Repeats of one program under one setting are a cell; other runs only stand side by side.
bool AreRepeats(const std::vector<LoadedRun>& runs) {
  for (const LoadedRun& run : runs) {
    if (!run.run.program || !runs.front().run.program) return false;
    const auto& a = run.run.program->poses;
    const auto& b = runs.front().run.program->poses;
    if (a.size() != b.size()) return false;
    for (size_t i = 0; i < a.size(); ++i) {
      if (a[i].t_s != b[i].t_s || !(a[i].Planar() == b[i].Planar())) return false;
    }
  }
  return true;
}

}  // namespace

LoadedRun LoadRun(const std::string& name, const std::string& program) {
  const RunFiles files(name);
  trajectory::Log log =
      trajectory::ReadLog(files::ReadFile(files.trajectory), files.trajectory.string());
  LoadedRun loaded{.run = {.log = {.name = name, .camera = std::move(log.trajectory)}},
                   .files = {files.trajectory, files.encoders, files.experiment}};
  const auto tell = [&loaded](const char* kind, const fs::path& file, const std::string& text) {
    loaded.notes.push_back(fmt::format("{}: {}: {}", kind, file.string(), text));
  };
  for (const std::string& note : log.notes) tell("note", files.trajectory, note);
  for (const std::string& doubt : log.doubts) tell("warning", files.trajectory, doubt);
  if (log.line_without_yaw) {
    tell("note", files.trajectory,
         fmt::format("line {} has no yaw: odometry leaves such rows out", *log.line_without_yaw));
  }
  if (const auto encoders = files::ReadIfThere(files.encoders)) {
    const auto note = trajectory::csv::NoteOfEnd(*encoders);
    if (note) tell("note", files.encoders, *note);
    loaded.run.log.encoders = odometry::ReadEncoders(*encoders, files.encoders.string());
  }
  const bool is_told = !program.empty();
  if (is_told || IsThere(files.experiment)) {
    loaded.experiment = experiment::LoadExperiment(is_told ? program : files.experiment.string(),
                                                   {}, files::ReadFile);
    // A simulated run was driven with one draw of the ensemble; the robot itself is none.
    if (!is_told && IsThere(files.truth)) {
      loaded.experiment = experiment::DrawnAt(*loaded.experiment, loaded.experiment->seed);
    }
    if (!loaded.experiment->program.segments.empty()) {
      loaded.run.program = sweep::IdealPath(experiment::TaskOf(*loaded.experiment));
    } else if (is_told) {
      throw std::invalid_argument(
          fmt::format("{}: has no program: name an experiment with program.segments", program));
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

void LeaveOutCopies(std::vector<LoadedRun>& runs,
                    const std::function<void(const std::string&)>& say) {
  std::vector<trajectory::Trajectory> paths;
  for (const LoadedRun& run : runs) paths.push_back(run.run.log.camera);
  const std::vector<std::optional<size_t>> copy_of = gap::CopiesAmong(paths);
  std::vector<LoadedRun> kept;
  for (size_t i = 0; i < runs.size(); ++i) {
    const std::string& name = runs[i].run.log.name;
    if (copy_of[i]) {
      say(fmt::format("warning: {} has the positions of {}: it is left out", name,
                      runs[*copy_of[i]].run.log.name));
      continue;
    }
    kept.push_back(runs[i]);
  }
  runs = std::move(kept);
}

odometry::OdometryResult MeasureOdometry(const std::vector<LoadedRun>& runs,
                                         const OdometryJob& job) {
  std::vector<odometry::ProgramRun> driven;
  std::vector<odometry::RunLog> logs;
  for (const LoadedRun& run : runs) {
    logs.push_back(run.run.log);
    driven.push_back(run.run);
    if (run.experiment) {
      driven.back().wheels = run.experiment->hardware.odometry;
      driven.back().tag_ahead_m = run.experiment->simulation.mocap.tag_ahead_m;
    }
    driven.back().tag_ahead_m = job.tag_ahead_m.value_or(driven.back().tag_ahead_m);
  }
  if (job.calibrate && !odometry::AreOfOneRobot(driven)) {
    throw std::invalid_argument(
        "--calibrate-odometry: the experiments of these runs name different wheels, track or tag "
        "(hardware.odometry, simulation.mocap.tag_ahead_m), and one robot is calibrated: name runs "
        "of one, or its experiment with --program");
  }
  odometry::OdometryResult result =
      odometry::MeasureRuns(driven, AreRepeats(runs), job.run_options);
  if (!job.calibrate) return result;
  std::erase_if(logs, [](const odometry::RunLog& log) { return log.encoders.empty(); });
  result.calibration = odometry::CalibrateOdometry(logs, driven.front().wheels, job.calibration);
  result.confidence = job.calibration.confidence;
  return result;
}

}  // namespace rift::sessions
