#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "floor.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/files/files.hpp"
#include "support/inputs/paper_waypoints.hpp"
#include "support/processes/process.hpp"
#include "support/processes/running_rift.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"

namespace rift::test {

// Limits that a loaded machine keeps as well; those of a real drive are tested on a fake clock.
inline constexpr const char* kPatient = R"(
track: {tag: {acquire_decimate: 1, lost_after_s: 5}, capture: {silent_s: 20, same_s: 20, open_timeout_s: 60}}
trial: {pose_stale_s: 5, lost_after_s: 20, timeout_s: 60}
hardware:
  line: {baud: 115200, hello_s: 20}
  guard: {pose_stale_s: 2, control_stale_s: 2, link_lag_s: 2, host_stall_s: 2}
  ping: {duration_s: 0.5, max_p99_s: 10, max_loss: 1, max_burst: 1000}
  start: {countdown_s: 0}
)";

/// A floor with the robot on the first waypoint, and what rift drive needs to be told.
struct Scene {
  explicit Scene(int moving_pictures = 1'000'000)
      : floor(control::StartPose(PaperWaypoints()), moving_pictures) {
    WriteText(folder / "cam.yaml", vision::WriteCamera(SmallCamera()));
    WriteText(folder / "task.yaml", "include: " + SourceDir() + "/configs/waypoints/paper.yaml\n" +
                                        std::string(kPatient));
  }
  std::vector<std::string> Arguments() const {
    return {"drive",    folder / "task.yaml", "--port",        floor.Port(),
            "--camera", floor.Camera(),       "--calibration", folder / "cam.yaml",
            "--out",    folder / "run",       "--yes"};
  }
  /// Those of a drive to the first waypoint behind the start, for drives that only have to arrive.
  std::vector<std::string> ShortArguments() const {
    std::vector<std::string> arguments = Arguments();
    const std::string way =
        "waypoints=[{x: -0.2822, y: -0.0655, heading: -0.9}, {x: -0.0716, y: -0.0852, stop: true}]";
    arguments.insert(arguments.begin() + 2, {"--set", way});
    return arguments;
  }
  nlohmann::json Summary() const {
    return nlohmann::json::parse(files::ReadFile(folder / "run/summary.json"));
  }

  TemporaryFolder folder;
  Floor floor;
};

/// True when the guard stopped the drive since somebody looked away for longer than the most
/// patient limits, as it must on a machine that is that busy, when pictures came too unevenly for
/// the start or the drive, or when the robot's answer to the stop came too late to be waited for.
/// `planted`: the reason for which the test wants it stopped.
inline bool WasInterrupted(Scene& scene, int exit_code, const std::string& planted = "") {
  if (!std::filesystem::exists(scene.folder / "run/summary.json")) return exit_code == 3;
  const auto summary = scene.Summary();
  if (!summary.contains("stop")) return false;  // killed
  const std::string reason = summary["stop"]["reason"];
  INFO(scene.floor.Told());
  CHECK(scene.floor.WasObedient());
  if (summary["stop"]["acknowledged"] != true) return true;
  const std::set<std::string> of_busy_machines{"link_lagging",  "host_stalled",   "pose_stale",
                                               "control_stale", "robot_stopped",  "pose_stands",
                                               "pose_lags",     "pose_disagrees", "pose_disorder"};
  return reason != planted && of_busy_machines.contains(reason);
}

/// Or when poses came too late to steer by, and the robot circled until its time was over. Of
/// drives that are to arrive.
inline bool WasInterruptedOrLate(Scene& scene, int exit_code) {
  return WasInterrupted(scene, exit_code) || scene.Summary()["outcome"] == "timed_out";
}

/// What `rift drive --json` says of a drive that was stopped since its log could not be written;
/// none where a busy machine came first, or kept it from starting.
inline std::optional<nlohmann::json> StoppedForItsLog(const ProcessResult& result) {
  if (result.out.empty()) return std::nullopt;
  nlohmann::json summary = nlohmann::json::parse(result.out);
  const bool is_so =
      summary["stop"]["reason"] == "log_failed" && summary["stop"]["acknowledged"] == true;
  return is_so ? std::optional(std::move(summary)) : std::nullopt;
}

/// Runs `drive` on a new scene, which returns false for a drive that was interrupted, until one
/// was not.
template <class Drive>
void Uninterrupted(int moving_pictures, const Drive& drive) {
  WaitUntil("a drive was not interrupted", [&] {
    Scene scene(moving_pictures);
    return drive(scene);
  });
}

inline constexpr int kAll = 1'000'000;

/// Or for the end of a drive that was interrupted.
inline void WaitForMotion(RunningRift& rift, Scene& scene) {
  WaitUntil("the robot moves or the drive is over",
            [&] { return scene.floor.Moves() || !rift.IsRunning(); });
}

}  // namespace rift::test
