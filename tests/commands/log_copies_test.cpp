// --tum and --mcap, beside the log of every command that makes one.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "rift/trajectory/log.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/npm.hpp"
#include "support/processes/process.hpp"
#include "support/processes/shell.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ReadFile;
using test::RunRift;

trajectory::Trajectory LogOf(const std::string& path) {
  return trajectory::ReadLog(ReadFile(path), path).trajectory;
}

void CheckTum(const std::string& path, const trajectory::Trajectory& log) {
  const trajectory::Trajectory copy = LogOf(path);
  REQUIRE(copy.poses.size() == log.poses.size());
  for (size_t i = 0; i < log.poses.size(); ++i) {
    REQUIRE(copy.poses[i].t_s == log.poses[i].t_s);
    REQUIRE(copy.poses[i].x_m == log.poses[i].x_m);
    REQUIRE(copy.poses[i].y_m == log.poses[i].y_m);
    REQUIRE(copy.poses[i].yaw_rad == Approx(log.poses[i].yaw_rad).margin(1e-12));
  }
}

/// Read by the reader of the format's authors.
void CheckMcap(const std::string& path, const trajectory::Trajectory& log) {
  if (!test::HasNpm("@mcap/core")) return;
  const std::string seen = path + ".json";
  const std::string command = fmt::format("node '{}/tests/npm/read_mcap.mjs' '{}' '{}' > '{}'",
                                          test::SourceDir(), test::NpmDir(), path, seen);
  REQUIRE(test::RunShell(command) == 0);
  const json file = json::parse(ReadFile(seen));
  CHECK(file["done"] == true);
  CHECK(file["schemas"].contains("foxglove.PoseInFrame"));
  const json& poses = file["topics"]["/pose"];
  REQUIRE(poses.size() == log.poses.size());
  const double zero_s = std::min(0.0, log.poses[0].t_s);
  for (size_t i = 0; i < poses.size(); ++i) {
    const trajectory::StampedPose& pose = log.poses[i];
    REQUIRE(poses[i]["time_ns"].get<double>() == Approx(1e9 * (pose.t_s - zero_s)).margin(1.0));
    const json& message = poses[i]["message"];
    REQUIRE(message["timestamp"]["sec"].get<double>() +
                1e-9 * message["timestamp"]["nsec"].get<double>() ==
            Approx(pose.t_s - zero_s).margin(1e-9));
    REQUIRE(message["pose"]["position"]["x"] == pose.x_m);
    REQUIRE(message["pose"]["position"]["y"] == pose.y_m);
    const json& turn = message["pose"]["orientation"];
    const Eigen::Quaterniond expected = trajectory::WorldFromBody(pose);
    REQUIRE(turn["z"].get<double>() == Approx(expected.z()).margin(1e-12));
    REQUIRE(turn["w"].get<double>() == Approx(expected.w()).margin(1e-12));
  }
  const json& targets = file["topics"]["/target"];
  REQUIRE(targets.empty() == std::isnan(log.poses.back().target_x_m));
  if (!targets.empty()) {
    CHECK(targets.back()["message"]["pose"]["position"]["x"] == log.poses.back().target_x_m);
    CHECK(targets.back()["message"]["pose"]["position"]["y"] == log.poses.back().target_y_m);
  }
  const json& signals = file["topics"]["/signals"];
  REQUIRE(signals.size() == log.poses.size());
  for (const trajectory::Channel& channel : log.channels) {
    const json& value = signals.back()["message"][channel.name];
    if (std::isnan(channel.values.back())) {
      CHECK(value.is_null());
    } else {
      CHECK(value == channel.values.back());
    }
    CHECK(file["schemas"]["rift.Signals"]["properties"].contains(channel.name));
  }
}

TEST_CASE("A simulated run and a drive are copied for evo and for Foxglove alike") {
  const test::TemporaryFolder folder;
  const std::string paper = test::SourceDir() + "/configs/waypoints/paper.yaml";
  const std::string tum = folder / "run.tum", mcap = folder / "run.mcap";
  const test::ProcessResult run =
      RunRift({"simulate", paper, "--out", folder / "run", "--tum", tum, "--mcap", mcap});
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const trajectory::Trajectory log = LogOf(folder / "run/trajectory.csv");
  CheckTum(tum, log);
  CheckMcap(mcap, log);
  CHECK(RunRift({"gap", tum, tum}).exit_code == 0);

  // A simulated run's folder is laid out as a drive's is.
  const std::vector<std::string> replay{
      "drive", "--replay",          folder / "run", "--mcap", folder / "drive.mcap",
      "--tum", folder / "drive.tum"};
  const test::ProcessResult drive = RunRift(replay);
  INFO(drive.err);
  REQUIRE(drive.exit_code == 0);
  CHECK(ReadFile(folder / "drive.mcap") == ReadFile(mcap));
  CHECK(ReadFile(folder / "drive.tum") == ReadFile(tum));

  const test::ProcessResult again = RunRift(replay);
  CHECK(again.exit_code == 2);
  CHECK_THAT(again.err, Catch::Contains("drive.tum") && Catch::Contains("--force"));
}

TEST_CASE("A drive of hours is copied, though it is too long for a film") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "experiment.yaml",
                  "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]\n");
  test::WriteText(folder / "trajectory.csv", "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n5000,0.1,0.02,0.3\n");
  const test::ProcessResult copied =
      RunRift({"drive", "--replay", folder.Path(), "--tum", folder / "log.tum"});
  INFO(copied.err);
  CHECK(copied.exit_code == 0);
  CHECK_THAT(copied.out, Catch::EndsWith("\n2 poses over 5000.00 s\n"));
  CheckTum(folder / "log.tum", LogOf(folder / "trajectory.csv"));
  const test::ProcessResult filmed =
      RunRift({"drive", "--replay", folder.Path(), "--video", folder / "log.mp4"});
  CHECK(filmed.exit_code == 2);
  CHECK(filmed.err ==
        "rift: a film of 5000 s at 30 pictures a second has 150000 pictures, but at most 100000 "
        "are possible: lower fps\n");
}

TEST_CASE("A tracked log is copied for evo and for Foxglove") {
  const test::TemporaryFolder folder;
  const std::string data = test::SourceDir() + "/data/camera";
  const test::ProcessResult tracked =
      RunRift({"track", "--camera", data + "/frames/*.jpg", "--fps", "15", "--calibration",
               data + "/camera.yaml", "--out", folder / "log.csv", "--tum", folder / "log.tum",
               "--mcap", folder / "log.mcap"});
  INFO(tracked.err);
  REQUIRE(tracked.exit_code == 0);
  const trajectory::Trajectory log = LogOf(folder / "log.csv");
  CheckTum(folder / "log.tum", log);
  CheckMcap(folder / "log.mcap", log);
}

TEST_CASE("Copies of a log that is no single file are refused") {
  const test::TemporaryFolder folder;
  const auto refusal = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--mcap", folder / "a.mcap"});
    const test::ProcessResult result = RunRift(arguments);
    CHECK(result.exit_code == 2);
    CHECK_FALSE(fs::exists(fs::path(folder / "a.mcap")));
    return result.err;
  };
  CHECK_THAT(refusal({"track", "--camera", "x.mp4", "--calibration", "c.yaml", "--out", "-"}),
             Catch::Contains("--out LOG.csv"));
  CHECK_THAT(refusal({"track", "--camera", "x.mp4", "--calibration", "c.yaml", "--id", "0,3",
                      "--out", folder / "a.csv"}),
             Catch::Contains("a single tag"));
  CHECK_THAT(refusal({"drive", "--ping", "--port", "/dev/null"}),
             Catch::Contains("one drive's log"));
}

}  // namespace
}  // namespace rift
