#include "replay.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "rift/commands/arguments/inputs.hpp"
#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/view/film.hpp"
#include "rift/view/window.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

void RequireDrive(const fs::path& folder) {
  for (const char* name : {"experiment.yaml", "trajectory.csv"}) {
    std::error_code not_there;
    if (fs::exists(folder / name, not_there)) continue;
    throw std::invalid_argument(
        fmt::format("{} holds no drive: there is no {} in it", folder.string(), name));
  }
}

trajectory::Trajectory ReadDriven(const fs::path& path) {
  trajectory::Log log = trajectory::ReadLog(files::ReadFile(path), path.string());
  for (const std::string& note : log.notes) {
    terminal::Say(fmt::format("note: {}: {}", path.string(), note));
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

int ReplayDrive(const DriveRequest& request) {
  const fs::path folder = request.replay;
  RequireDrive(folder);
  const bool has_files = !request.video.empty() || !request.copies.Files().empty();
  const bool window = !has_files || request.view;
  if (window) view::RequireDisplay();
  const experiment::Experiment experiment = ReadExperiment(folder / "experiment.yaml");
  const trajectory::Trajectory seen = ReadDriven(folder / "trajectory.csv");
  const std::string ending =
      report::DriveEnding(files::ReadIfThere(folder / "summary.json").value_or(""));
  view::Run shown{.title = fmt::format("{}, {}", experiment.name, folder.string()),
                  .body = view::ShapeOf(experiment.simulation.body),
                  .truth = OnTheFloor(seen),
                  .logged = seen,
                  .outcome = ending};
  view::ShowTask(shown, experiment::TaskOf(experiment));
  terminal::PrintText(
      fmt::format("{}\n{} poses over {:.2f} s\n", ending, seen.poses.size(), seen.Duration_s()));
  terminal::FlushResults();
  WriteLogCopies(request.copies, seen);
  if (!window && request.video.empty()) return terminal::kDone;
  view::ShowFilm(view::MakeFilm(shown), request.video, window, terminal::Say);
  return terminal::kDone;
}

}  // namespace rift::commands
