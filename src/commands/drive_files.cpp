#include "drive_files.hpp"

#include "drive_output.hpp"
#include "files.hpp"
#include "rift/report/json/trial.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/vision/camera/camera_file.hpp"

namespace rift::commands {

void BeginDriveFolder(const std::filesystem::path& folder, const experiment::Experiment& experiment,
                      const vision::CameraModel& camera) {
  WriteFile(folder / "experiment.yaml", experiment::WriteExperiment(experiment));
  WriteFile(folder / "camera.yaml", vision::WriteCamera(camera));
}

void SaveDrive(const std::filesystem::path& folder, const experiment::Experiment& experiment,
               const DriveRun& run) {
  WriteFile(folder / "commands.csv", report::CommandsCsv(run.trial));
  WriteFile(folder / "stages.csv", StagesCsv(run.evidence));
  WriteFile(folder / "encoders.csv", EncodersCsv(run.evidence));
  WriteFile(folder / "summary.json", DriveJson(experiment, run));
  WriteFile(folder / "trajectory.csv", trajectory::WriteRift(run.trial.trajectory));
}

}  // namespace rift::commands
