#include "folder.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <utility>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/vision/camera/camera_file.hpp"

namespace rift::sessions {

namespace fs = std::filesystem;

void RequireNoDrive(const fs::path& folder) {
  for (const char* name : {"trajectory.csv", "experiment.yaml", "camera.yaml", "summary.json",
                           "commands.csv", "stages.csv", "encoders.csv"}) {
    std::error_code no_folder;
    if (!fs::exists(fs::symlink_status(folder / name, no_folder))) continue;
    throw std::invalid_argument(
        fmt::format("{} holds a run already, or part of one: {} is there, and a drive replaces no "
                    "file, since a robot does not repeat itself: choose another --out",
                    folder.string(), name));
  }
}

BegunFolder::BegunFolder(fs::path folder)
    : folder_(std::move(folder)), was_there_(fs::exists(folder_)) {}

BegunFolder::~BegunFolder() {
  std::error_code stays;
  if (is_kept_ || fs::exists(folder_ / "trajectory.csv", stays)) return;
  for (const fs::path& path : made_) fs::remove(path, stays);
  if (!was_there_) fs::remove(folder_, stays);  // when nothing else came into it
}

void BegunFolder::WriteOne(const char* name, const std::string& text) {
  files::WriteFile(folder_ / name, text);
  made_.push_back(folder_ / name);
}

void BegunFolder::Write(const experiment::Experiment& experiment,
                        const vision::CameraModel& camera) {
  WriteOne("experiment.yaml", experiment::WriteExperiment(experiment));
  WriteOne("camera.yaml", vision::WriteCamera(camera));
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
