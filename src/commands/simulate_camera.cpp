#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/command.hpp"
#include "rift/files/files.hpp"
#include "rift/report/json/fields.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/twin/twin.hpp"
#include "rift/view/film.hpp"
#include "rift/view/window.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "simulate.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// One line, at once: whoever started the twin waits for it.
void Announce(const twin::TwinAddress& address, const fs::path& calibration) {
  const ordered_json json{{"port", address.port},
                          {"camera", address.camera},
                          {"calibration", fs::absolute(calibration).string()}};
  terminal::PrintData(json.dump() + '\n');
  if (terminal::FlushResults() != 0) {
    throw std::runtime_error("cannot write to stdout: nobody can learn where the twin is");
  }
}

std::string Ending(const twin::TwinRun& run) {
  if (run.is_over) return "the robot drove and stood still again";
  return run.has_driven ? "ended from outside while the robot drove or shortly after"
                        : "ended from outside before the robot drove";
}

std::string TwinJson(const experiment::Experiment& experiment, const twin::TwinRun& run) {
  return report::Dump({{"name", experiment.name},
                       {"rift_version", RIFT_VERSION},
                       {"seed", experiment.seed},
                       {"ending", Ending(run)},
                       {"has_driven", run.has_driven},
                       {"true_path_length_m", run.truth.ArcLength_m()},
                       {"began_steady_s", run.began_s},
                       {"skipped_s", run.skipped_s},
                       {"pictures", run.pictures},
                       {"picture_cpu_s", run.picture_cpu_s},
                       {"picture_late_p99_s", run.picture_late_p99_s},
                       {"robot_stopped_by_itself", run.stops},
                       {"robot_rejected", run.rejected}});
}

void Save(const fs::path& folder, const experiment::Experiment& experiment,
          const twin::TwinRun& run) {
  files::WriteFile(folder / "truth.csv", trajectory::WriteRift(run.truth));
  files::WriteFile(folder / "trajectory.csv", trajectory::WriteRift(run.tag));
  files::WriteFile(folder / "summary.json", TwinJson(experiment, run));
}

/// Serves until the trial is over or a signal comes, says in one line of JSON on stdout where port,
/// camera and calibration are, and writes the run folder: experiment.yaml (with the simulation as
/// the twin is, for `simulate` to repeat), camera.yaml, truth.csv, trajectory.csv (the tag's true
/// path) and summary.json.
int RunTwin(const std::string& experiment_file, const experiment::Experiment& experiment,
            const fs::path& folder) {
  experiment::Experiment as_twin = experiment;
  as_twin.simulation = twin::AsTwin(experiment.simulation, experiment.twin);
  const sweep::SimulatedTrial trial =
      sweep::SimulatedTrialOf(as_twin, {}, experiment.seed, experiment_file, FileInputs());
  vision::SyntheticCameraOptions look = experiment.twin.camera;
  look.tag_family = experiment.track.tag.family;
  look.shutter_s = as_twin.simulation.mocap.exposure_s;
  const twin::TwinSetup setup{as_twin.simulation,
                              experiment.twin,
                              experiment::TaskOf(experiment).Start(),
                              experiment.seed,
                              trial.image,
                              twin::OverheadCamera(experiment::TaskOf(experiment), experiment.twin),
                              look};
  const fs::path calibration = folder / "camera.yaml";
  const auto save_setup = [&] {
    files::WriteFile(calibration, vision::WriteCamera(setup.camera));
    files::WriteFile(folder / "experiment.yaml", experiment::WriteExperiment(as_twin));
  };
  save_setup();

  const terminal::StopSignal stop;
  const twin::TwinRun run = twin::RunTwin(
      setup, [&](const twin::TwinAddress& address) { Announce(address, calibration); },
      [&] { return stop.IsAsked(); });
  if (!fs::exists(folder / "experiment.yaml")) save_setup();  // removed meanwhile
  Save(folder, as_twin, run);
  terminal::Say(fmt::format("{}; {} pictures at {:.1f} ms of one core each; true path: {}",
                            Ending(run), run.pictures, 1e3 * run.picture_cpu_s,
                            (folder / "truth.csv").string()));
  return terminal::kDone;
}

view::Film FilmOf(const experiment::Experiment& experiment, const sweep::SimulatedTrial& trial,
                  const sweep::SimulatedRun& run) {
  const simulation::Terrain terrain(trial.simulation.terrain, trial.image);
  view::Run shown{
      .title = fmt::format("{} on {}", experiment.name, trial.simulation.terrain.surface),
      .body = view::ShapeOf(trial.simulation.body),
      .height_at = [&](double x_m, double y_m) { return terrain.HeightAt(x_m, y_m); },
      .truth = run.truth,
      .logged = run.result.trajectory,
      .outcome = run.result.reason};
  view::ShowTask(shown, trial.task);
  for (const geometry::FloorArea& area : AreasOf(trial.simulation.terrain)) {
    shown.patches.push_back({area.label, area.x_min_m, area.x_max_m, area.y_min_m, area.y_max_m});
  }
  return view::MakeFilm(shown);
}

}  // namespace

int SimulateWithCamera(const SimulateRequest& request) {
  if (request.twin) {
    const TwinJob job = LoadTwinJob(request);
    return RunTwin(request.experiment, job.experiment, job.folder);
  }
  return Simulate(request, [&request](const Simulated& made) {
    view::ShowFilm(FilmOf(made.experiment, made.trial, made.run), request.pictures.video,
                   request.pictures.window, terminal::Say);
  });
}

}  // namespace rift::commands
