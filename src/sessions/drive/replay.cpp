#include "rift/sessions/drive/replay.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "rift/experiment/experiment.hpp"
#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;

trajectory::Trajectory ReadDriven(const fs::path& path,
                                  const std::function<void(const std::string&)>& say) {
  trajectory::Log log = trajectory::ReadLog(files::ReadFile(path), path.string());
  for (const std::string& note : log.notes) {
    say(fmt::format("note: {}: {}", path.string(), note));
  }
  return std::move(log.trajectory);
}

/// The camera saw the tag, which is neither the axle nor without noise: the robot is drawn level on
/// the floor.
trajectory::Trajectory OnTheFloor(trajectory::Trajectory seen) {
  for (trajectory::StampedPose& pose : seen.poses) {
    pose.z_m = pose.roll_rad = pose.pitch_rad = trajectory::StampedPose::kNotLogged;
  }
  return seen;
}

}  // namespace

void RequireDrive(const fs::path& folder) {
  for (const char* name : {"experiment.yaml", "trajectory.csv"}) {
    std::error_code not_there;
    if (fs::exists(folder / name, not_there)) continue;
    throw std::invalid_argument(
        fmt::format("{} holds no drive: there is no {} in it", folder.string(), name));
  }
}

view::Run LoadDrive(const fs::path& folder, const std::function<void(const std::string&)>& say) {
  const experiment::Experiment experiment =
      experiment::LoadExperiment((folder / "experiment.yaml").string(), {}, files::ReadFile);
  const trajectory::Trajectory seen = ReadDriven(folder / "trajectory.csv", say);
  view::Run shown{
      .title = fmt::format("{}, {}", experiment.name, folder.string()),
      .body = view::ShapeOf(experiment.simulation.body),
      .truth = OnTheFloor(seen),
      .logged = seen,
      .outcome = report::DriveEnding(files::ReadIfThere(folder / "summary.json").value_or(""))};
  view::ShowTask(shown, experiment::TaskOf(experiment));
  return shown;
}

}  // namespace rift::sessions
