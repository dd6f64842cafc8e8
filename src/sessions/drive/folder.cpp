#include "folder.hpp"

#include <memory>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/vision/camera/camera_file.hpp"

namespace rift::sessions {

void BeginDriveFolder(const std::filesystem::path& folder, const experiment::Experiment& experiment,
                      const vision::CameraModel& camera) {
  files::WriteFile(folder / "experiment.yaml", experiment::WriteExperiment(experiment));
  files::WriteFile(folder / "camera.yaml", vision::WriteCamera(camera));
}

DriveLog::Write WriterInto(const std::filesystem::path& folder,
                           const experiment::Experiment& experiment) {
  const auto files = std::make_shared<DriveFiles>(folder, report::InterruptedDriveJson(experiment));
  return [files](const DriveRows& rows, std::atomic<unsigned>& progress) {
    files->Write(rows, progress);
  };
}

// A disk that failed is not written to again: it may hang.
std::string CloseDrive(const std::filesystem::path& folder,
                       const experiment::Experiment& experiment, const hardware::DriveRun& run,
                       DriveLog& log) {
  std::string failure = log.Close(run.evidence);
  if (failure.empty()) {
    files::WriteFile(folder / "summary.json", report::DriveJson(experiment, run));
  }
  return failure;
}

}  // namespace rift::sessions
