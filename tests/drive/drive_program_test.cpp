#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "rift/files/files.hpp"
#include "rift/odometry/program_runs.hpp"
#include "rift/trajectory/log.hpp"
#include "support/processes/process.hpp"
#include "support/processes/until_done.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;

// Limits that a loaded machine keeps as well, and a floor that is free of slip.
constexpr const char* kTask = R"(
name: lap
waypoints: [{x: 0.0, y: 0.0, heading: 0.0}]
program:
  power: 0.2
  segments: [{straight_m: 0.15}, {turn_deg: 90, radius_m: 0.1}, {hold_s: 0.3}, {turn_deg: 45}]
twin: {fps: 15, still_s: 60}
track: {tag: {acquire_decimate: 2, lost_after_s: 5}, capture: {silent_s: 20, same_s: 20, open_timeout_s: 60}}
trial: {pose_stale_s: 5, lost_after_s: 20, timeout_s: 60, settle_s: 0.5}
hardware:
  line: {hello_s: 20}
  guard: {pose_stale_s: 2, control_stale_s: 2, link_lag_s: 2, host_stall_s: 2}
  ping: {duration_s: 0.5, max_p99_s: 10, max_loss: 1, max_burst: 1000}
  start: {countdown_s: 0}
)";

trajectory::Trajectory Read(const fs::path& path) {
  return trajectory::ReadLog(files::ReadFile(path), path.string()).trajectory;
}

/// Where the twin really ended, seen from where it stood at the time of the first reading.
geometry::Pose2 TrueMotion(const trajectory::Trajectory& truth) {
  return geometry::Inverse(truth.poses.front().Planar()) * truth.poses.back().Planar();
}

TEST_CASE("A program is driven on the twin and its odometry is the twin's true motion") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "task.yaml",
                  "include: " + test::SourceDir() + "/configs/twin.yaml\n" + kTask);
  // The turn on the spot before a drive is no part of its program.
  const std::vector<std::string> command{"drive",
                                         folder / "task.yaml",
                                         "--yes",
                                         "--repeat",
                                         "1",
                                         "--set",
                                         "hardware.turn.enabled=false",
                                         "--out",
                                         folder / "run",
                                         "--before-each",
                                         test::BuildDir() + "/rift simulate " +
                                             (folder / "task.yaml") + " --twin --force --out " +
                                             (folder / "twin")};
  const test::ProcessResult result = test::RunUntilDone(command);
  INFO(result.out << result.err);
  REQUIRE(result.exit_code == 0);
  const fs::path run = folder / "run/1";
  const std::vector<odometry::EncoderReading> encoders =
      odometry::ReadEncoders(files::ReadFile(run / "encoders.csv"), "encoders.csv");
  REQUIRE(encoders.size() > 50);
  CHECK(encoders.front().battery_v > 3.0);

  const trajectory::Trajectory path = odometry::OdometryPath(encoders, {}, {});
  const geometry::Pose2 rolled = path.poses.back().Planar();
  const geometry::Pose2 moved = TrueMotion(Read(folder / "twin/truth.csv"));
  CHECK((rolled.Position() - moved.Position()).norm() < 0.01);
  CHECK(std::abs(geometry::WrapToPi(rolled.yaw_rad - moved.yaw_rad)) < 0.05);

  const test::ProcessResult told =
      test::RunRift({"gap", run.string(), "--odometry", "--json", "-"});
  INFO(told.err);
  REQUIRE(told.exit_code == 0);
  const auto measures = nlohmann::json::parse(told.out)["runs"][0];
  CHECK(measures["did_move"] == true);
  CHECK(measures["deviation_m"] > 0.0);
  // A busy machine loses pictures at the end of the drive; what rolled and what moved agree above.
  CHECK(measures["odometry_gap_m"] < 0.1);
}

}  // namespace
}  // namespace rift
