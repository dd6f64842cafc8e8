#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>

#include "support/inputs/png_bytes.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

using Catch::Contains;
using test::ProcessResult;
using test::RunRift;
using test::WriteText;

const std::string kExample = test::SourceDir() + "/data/example/";

std::string HeightfieldTask(const std::string& image) {
  return "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]\n"
         "reference: {kind: nominal, trials: 2}\nspace: {v_min: [0.14, 0.16]}\n"
         "simulation: {terrain: {surface: field, surfaces: {field: {shape: heightfield, image: " +
         image + "}}}}\n";
}

void CheckRefused(const ProcessResult& result, const std::string& says) {
  INFO(result.err);
  CHECK(result.exit_code == 2);
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK_THAT(result.err, Contains(says));
  CHECK_THAT(result.err, Contains("--large-inputs lifts this limit"));
}

TEST_CASE("A small PNG of very many pixels is refused by its header") {
  const test::TemporaryFolder folder;
  const std::string image = folder / "huge.png", task = folder / "task.yaml";
  WriteText(image, test::BlackPng(16'000));
  WriteText(task, HeightfieldTask(image));
  REQUIRE(std::filesystem::file_size(image) < 300'000);
  const std::string says = "huge.png: PNG height image: 256000000 pixels: at most 16777216";
  CheckRefused(RunRift({"simulate", task, "--out", folder / "run"}), says);
  CheckRefused(RunRift({"sweep", task, "--out", folder / "sweep"}), says);
  WriteText(image, test::BlackPng(64));
  CHECK(RunRift({"simulate", task, "--out", folder / "run"}).exit_code <= 1);
}

TEST_CASE("A file or a device without an end is refused at the limit") {
  CheckRefused(RunRift({"gap", "/dev/zero", kExample + "robot1.csv"}), "/dev/zero: ");
  CheckRefused(RunRift({"gap", kExample + "robot1.csv", "/dev/full"}), "/dev/full: ");
  const test::TemporaryFolder folder;
  const std::string sparse = folder / "sparse.csv";
  WriteText(sparse, "t_s,x_m,y_m,yaw_rad\n");
  std::filesystem::resize_file(sparse, 1ULL << 40);
  CheckRefused(RunRift({"gap", sparse, sparse}), "sparse.csv: 1099511627776 bytes");
  const ProcessResult yaml = RunRift({"sweep", "/dev/zero"});
  CHECK(yaml.exit_code == 2);
  CHECK_THAT(yaml.err, Contains("at most"));
}

TEST_CASE("More samples of the gap than the limit need the flag that lifts it") {
  const std::vector<std::string> logs{kExample + "simulator.csv", kExample + "robot1.csv"};
  const auto gap = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"gap", logs[0], logs[1]};
    words.insert(words.end(), more.begin(), more.end());
    return RunRift(words);
  };
  CheckRefused(gap({"--samples", "1000001"}), "--samples: 1000001 samples: at most 1000000");
  CHECK(gap({"--samples", "1000000"}).exit_code == 0);
  CHECK(gap({"--samples", "1000001", "--large-inputs"}).exit_code == 0);
}

TEST_CASE("A log of more rows than the limit is refused before it is read") {
  const test::TemporaryFolder folder;
  const std::string log = folder / "long.csv";
  std::string text = "t_s,x_m,y_m,yaw_rad\n";
  for (int i = 0; i < 2'000'001; ++i) text += "1,2,3,4\n";
  WriteText(log, text);
  const std::string says = "long.csv: 2000003 rows: at most 2000000";
  CheckRefused(RunRift({"gap", log, log}), says);
  CheckRefused(RunRift({"gap", log, log, "--sim-columns", "t=t_s,x=x_m,y=y_m"}), says);
}

TEST_CASE("A log or an encoder log of very many columns is refused by its header") {
  const test::TemporaryFolder folder;
  WriteText(folder / "trajectory.csv", "t_s,x_m,y_m" + std::string(1'000'000, ',') + "\n0,0,0\n");
  CheckRefused(RunRift({"gap", folder / "trajectory.csv", kExample + "robot1.csv"}),
               "trajectory.csv:1: 1000003 columns: at most 10000");
  WriteText(folder / "trajectory.csv", "t_s,x_m,y_m\n0,0,0\n1,1,0\n");
  WriteText(folder / "encoders.csv", "t_s,left,right" + std::string(1'000'000, ',') + "\n0,0,0\n");
  CheckRefused(RunRift({"gap", folder.Path(), "--odometry"}),
               "encoders.csv:1: 1000003 columns: at most 10000");
}

TEST_CASE("A camera file of more than the limit of YAML is refused") {
  const test::TemporaryFolder folder;
  WriteText(folder / "camera.yaml", "#" + std::string(1 << 20, 'x') + "\n");
  CheckRefused(
      RunRift({"track", "--camera", test::SourceDir() + "/data/camera/frames/*.jpg", "--fps", "15",
               "--calibration", folder / "camera.yaml", "--out", folder / "log.csv"}),
      "camera.yaml: 1048578 bytes of YAML: at most 1048576");
}

TEST_CASE("Experiments of very many waypoints or trials are refused at once") {
  const test::TemporaryFolder folder;
  const std::string task = folder / "task.yaml";
  const auto write = [&](int count, const std::string& more) {
    std::string text = "waypoints:\n- {x: 0, y: 0, heading: 0}\n";
    for (int i = 1; i < count; ++i) text += "- {x: " + std::to_string(i % 7) + ", y: 1}\n";
    WriteText(task, text + more);
  };
  write(1'000'000, "");
  CheckRefused(RunRift({"simulate", task, "--out", folder / "run"}), "bytes of YAML: at most");
  write(10'001, "");
  CheckRefused(RunRift({"simulate", task, "--out", folder / "run"}), "task.yaml: 10001 waypoints");
  write(
      3,
      "reference: {kind: nominal, trials: 1000}\n"
      "space: {surface: [ground, parchment], v_min: [" +
          [] {
            std::string list;
            for (int i = 0; i < 501; ++i) list += std::to_string(0.1 + 1e-6 * i) + ", ";
            return list;
          }() +
          "0.3]}\n");
  CheckRefused(RunRift({"sweep", task, "--out", folder / "sweep"}),
               "task.yaml: 1004000 trials of a grid: at most 1000000");
  CHECK_FALSE(std::filesystem::exists(folder / "sweep"));
}

TEST_CASE("A gnuplot that is killed is told with its signal") {
  const test::TemporaryFolder folder;
  WriteText(folder / "gnuplot", "#!/bin/sh\nkill -9 $$\n");
  ::chmod((folder / "gnuplot").c_str(), 0755);
  const std::string path = std::string(::getenv("PATH"));
  ::setenv("PATH", (folder.Path().string() + ":" + path).c_str(), 1);
  const ProcessResult killed = RunRift(
      {"gap", kExample + "simulator.csv", kExample + "robot1.csv", "--figure", folder / "gap.svg"});
  WriteText(folder / "gnuplot", "#!/bin/sh\nexit 7\n");
  const ProcessResult failed = RunRift(
      {"gap", kExample + "simulator.csv", kExample + "robot1.csv", "--figure", folder / "gap.svg"});
  ::setenv("PATH", path.c_str(), 1);
  CHECK(killed.exit_code == 3);
  CHECK_THAT(killed.err, Contains("gnuplot ended by signal 9 (Killed)"));
  CHECK(failed.exit_code == 3);
  CHECK_THAT(failed.err, Contains("gnuplot ended with exit code 7"));
  CHECK_FALSE(std::filesystem::exists(folder / "gap.svg"));
}

}  // namespace
}  // namespace rift
