#include "rift/sessions/simulate/twin.hpp"

#include "rift/experiment/task.hpp"
#include "rift/files/files.hpp"
#include "rift/files/outputs.hpp"
#include "rift/report/json/fields.hpp"
#include "rift/sessions/simulate/run.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/vision/camera/camera_file.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;

std::string TwinJson(const experiment::Experiment& experiment, const twin::TwinRun& run) {
  return report::Dump({{"name", experiment.name},
                       {"rift_version", RIFT_VERSION},
                       {"seed", experiment.seed},
                       {"ending", EndingOf(run)},
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

void SaveSetup(const PreparedTwin& prepared) {
  files::WriteFile(prepared.Calibration(), vision::WriteCamera(prepared.setup.camera));
  files::WriteFile(prepared.folder / "experiment.yaml",
                   experiment::WriteExperiment(prepared.experiment));
}

void SaveRun(const PreparedTwin& prepared, const twin::TwinRun& run) {
  const fs::path& folder = prepared.folder;
  files::WriteFile(folder / "truth.csv", trajectory::WriteRift(run.truth));
  files::WriteFile(folder / "trajectory.csv", trajectory::WriteRift(run.tag));
  files::WriteFile(folder / "summary.json", TwinJson(prepared.experiment, run));
}

}  // namespace

void CheckTwinNames(const fs::path& folder, const std::vector<fs::path>& inputs, bool force) {
  RefuseDriveFolder(folder);
  files::Outputs outputs{.folder = folder, .force = force};
  for (const char* name :
       {"experiment.yaml", "camera.yaml", "truth.csv", "trajectory.csv", "summary.json"}) {
    outputs.files.push_back(folder / name);
  }
  files::CheckOutputs(inputs, outputs);
}

PreparedTwin PrepareTwin(const experiment::Experiment& loaded, const std::string& experiment_file,
                         const fs::path& folder, const sweep::Inputs& inputs) {
  const experiment::Experiment experiment = experiment::DrawnAt(loaded, loaded.seed);
  experiment::Experiment as_twin = experiment;
  as_twin.simulation = twin::AsTwin(experiment.simulation, experiment.twin);
  const sweep::SimulatedTrial trial =
      sweep::SimulatedTrialOf(as_twin, {}, experiment.seed, experiment_file, inputs);
  vision::SyntheticCameraOptions look = experiment.twin.camera;
  look.tag_family = experiment.track.tag.family;
  look.shutter_s = as_twin.simulation.mocap.exposure_s;
  const control::Task task = experiment::TaskOf(experiment);
  const PreparedTwin prepared{
      as_twin,
      {as_twin.simulation, experiment.twin, experiment::AxleAtStart(experiment), experiment.seed,
       trial.image, twin::OverheadCamera(task, experiment.twin), look},
      folder};
  SaveSetup(prepared);
  return prepared;
}

twin::TwinRun ServeTwin(const PreparedTwin& prepared,
                        const std::function<void(const twin::TwinAddress&)>& announce,
                        const std::function<bool()>& is_stopped) {
  const twin::TwinRun run = twin::RunTwin(prepared.setup, announce, is_stopped);
  if (!fs::exists(prepared.folder / "experiment.yaml")) SaveSetup(prepared);  // removed meanwhile
  SaveRun(prepared, run);
  return run;
}

std::string AddressJson(const PreparedTwin& prepared, const twin::TwinAddress& address) {
  const nlohmann::ordered_json json{{"port", address.port},
                                    {"camera", address.camera},
                                    {"calibration", fs::absolute(prepared.Calibration()).string()}};
  // A folder may have a name that is no text.
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

std::string EndingOf(const twin::TwinRun& run) {
  if (run.is_over) return "the robot drove and stood still again";
  return run.has_driven ? "ended from outside while the robot drove or shortly after"
                        : "ended from outside before the robot drove";
}

}  // namespace rift::sessions
