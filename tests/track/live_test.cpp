#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"
#include "support/inputs/paper_camera.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/running_rift.hpp"
#include "support/tree.hpp"
#include "vision/mjpeg_server.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using nlohmann::json;
using test::Environment;
using test::ProcessResult;
using test::RunRift;
using vision::synthetic::MjpegServer;

const std::string kData = test::SourceDir() + "/data/camera";
const std::string kCamera = kData + "/camera.yaml";
// A busy machine must not look like a camera that fell silent.
const std::string kPatient = "track.capture.silent_s=60";

std::vector<std::string> Tracking(const std::string& camera, const std::string& out,
                                  const std::string& seconds) {
  return {"track", "--camera", camera,       "--calibration", kCamera,
          "--out", out,        "--duration", seconds};
}

/// Those that are whole; none while there is no file.
long LinesIn(const std::string& path) {
  if (!std::filesystem::exists(path)) return 0;
  const std::string text = test::ReadFile(path);
  return std::count(text.begin(), text.end(), '\n');
}

const std::vector<double>& Column(const trajectory::Trajectory& log, const std::string& name) {
  for (const trajectory::Channel& channel : log.channels) {
    if (channel.name == name) return channel.values;
  }
  throw std::runtime_error("no column " + name);
}

TEST_CASE("A V4L2 camera of 30 and 60 Hz gives rows of its pictures' times with their latency") {
  const int fps = GENERATE(30, 60);
  const test::TemporaryFolder folder;
  const Environment shim("LD_PRELOAD", test::BuildDir() + "/tests/librift_v4l2_shim.so");
  const Environment jpegs("RIFT_SHIM_JPEGS", kData + "/frames");
  test::RunningRift rift([&] {
    std::vector<std::string> words = Tracking("/dev/video0", folder / "log.csv", "600");
    words.insert(words.end(), {"--fps", std::to_string(fps), "--set", kPatient});
    return words;
  }());
  rift.WaitUntil("rows are written", [&] { return LinesIn(folder / "log.csv") > 20; });
  rift.Signal(SIGINT);
  const ProcessResult result = rift.Wait();
  INFO(result.out << result.err);
  REQUIRE(result.exit_code == 0);
  const json run = json::parse(test::ReadFile(folder / "log.run.json"));
  CHECK(run["latency_s"]["p50"].get<double>() > 0.011);  // the shim's transfer
  CHECK(run["rows_per_s"].get<double>() > 0.0);
  CHECK(run["rows_per_s"].get<double>() < 1.01 * fps);
  const auto log = test::LoadTrajectory(folder / "log.csv", trajectory::Format::kRift);
  for (const double latency_s : Column(log, "latency_s")) CHECK(latency_s > 0.0);
  // However many pictures a busy machine leaves out, each row has the time of its own.
  for (const trajectory::StampedPose& pose : log.poses) {
    const double pictures = (pose.t_s - log.poses.front().t_s) * fps;
    CHECK(std::abs(pictures - std::round(pictures)) < 0.01);
  }
}

TEST_CASE("A camera that fails ends the tracking with its state and exit code 3") {
  struct Fault {
    std::string name, state;
  };
  const Fault fault =
      GENERATE(Fault{"unplug", "unplugged"}, Fault{"eio", "frozen"}, Fault{"hang", "frozen"},
               Fault{"freeze", "frozen"}, Fault{"black", "black"}, Fault{"busy", "busy"});
  const test::TemporaryFolder folder;
  const Environment shim("LD_PRELOAD", test::BuildDir() + "/tests/librift_v4l2_shim.so");
  const Environment jpegs("RIFT_SHIM_JPEGS", kData + "/frames");
  const Environment what("RIFT_SHIM_FAULT", fault.name);
  // By its state, not after its time.
  std::vector<std::string> words = Tracking("/dev/video0", folder / "log.csv", "600");
  // Of the shim's pictures only the raw ones, which show no tag, can be dark.
  const bool is_raw = fault.name == "black";
  words.insert(words.end(),
               {"--set", is_raw ? "track.capture.format=yuyv" : "track.capture.format=mjpg"});
  words.insert(words.end(), {"--give-up", "0.3"});
  const bool falls_silent = fault.name == "eio" || fault.name == "hang";
  if (!falls_silent) words.insert(words.end(), {"--set", kPatient});
  const ProcessResult result = RunRift(words);
  INFO(fault.name << "\n" << result.out << result.err);
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Contains("camera " + fault.state + ": "));
  const json run = json::parse(test::ReadFile(folder / "log.run.json"));
  CHECK(run["state"] == fault.state);
  const bool saw_tag = fault.name != "busy" && !is_raw;
  CHECK((run["rows"].get<int>() > 0) == saw_tag);  // what was seen before is kept
}

TEST_CASE("A camera without a readable format is named with those it has") {
  const test::TemporaryFolder folder;
  const Environment shim("LD_PRELOAD", test::BuildDir() + "/tests/librift_v4l2_shim.so");
  const Environment formats("RIFT_SHIM_FORMATS", "H264,NV12");
  const ProcessResult result = RunRift(Tracking("/dev/video0", folder / "log.csv", "5"));
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Contains("camera wrong format") && Contains("H264, NV12"));
}

TEST_CASE("A log whose folder is removed, moved or replaced during the tracking is exit 3") {
  const std::string picture = test::ReadFile(kData + "/frames/000.jpg");
  MjpegServer server(std::vector<std::uint8_t>{picture.begin(), picture.end()}, {.fps = 20.0});
  const test::TemporaryFolder folder;
  const fs::path out = folder / "out", elsewhere = folder / "elsewhere", log = out / "log.csv";
  fs::create_directory(out);
  const int trouble = GENERATE(range(0, 3));
  test::RunningRift rift({"track", "--camera", server.Url(), "--calibration", kCamera, "--out", log,
                          "--set", "track.capture.same_s=60", "--set", kPatient});
  rift.WaitUntil("the first rows", [&] {
    std::error_code not_there;
    return fs::exists(log) && fs::file_size(log, not_there) > 1000;
  });
  if (trouble == 0) fs::remove_all(out);
  if (trouble > 0) fs::rename(out, elsewhere);
  if (trouble > 1) fs::copy(elsewhere, out);
  const ProcessResult result = rift.Wait();
  INFO(trouble << ": " << result.out << result.err);
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Contains("log.csv was removed or moved while it was being written"));
  CHECK_FALSE(fs::exists(out / "log.run.json"));
}

TEST_CASE("Ctrl-C ends the tracking cleanly with its summary") {
  const test::TemporaryFolder folder;
  const Environment shim("LD_PRELOAD", test::BuildDir() + "/tests/librift_v4l2_shim.so");
  const Environment jpegs("RIFT_SHIM_JPEGS", kData + "/frames");
  std::vector<std::string> words = Tracking("/dev/video0", folder / "log.csv", "600");
  words.insert(words.end(), {"--set", kPatient});
  test::RunningRift rift(words);
  rift.WaitUntil("rows are written", [&] { return LinesIn(folder / "log.csv") > 1; });
  rift.Signal(SIGINT);
  const ProcessResult result = rift.Wait();
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("rows in") && Contains("dropped") && Contains("p95"));
  CHECK(json::parse(test::ReadFile(folder / "log.run.json"))["rows"].get<int>() > 0);
}

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

// A whole picture of 1080p at AprilTag's finest for every frame takes several frames' time.
TEST_CASE("A reader that is too slow for its http camera leaves pictures out and lags no further") {
  constexpr int kPictures = 90;
  const test::TemporaryFolder folder;
  const vision::CameraModel camera = test::PaperCamera();
  test::WriteText(folder / "cam.yaml", vision::WriteCamera(camera));
  vision::SyntheticCamera renderer(camera, {});
  std::mt19937_64 generator(1);
  vision::RobotMotion robot;
  robot.world_from_tag.translation() = Eigen::Vector3d(0.1, 0.05, 0.03);
  const auto jpeg = renderer.Render(robot, vision::PixelFormat::kJpeg, generator).bytes;
  MjpegServer server([&] { return jpeg; }, {.pictures = kPictures});
  const ProcessResult result = RunRift(
      {"track", "--camera", server.Url(), "--calibration", folder / "cam.yaml", "--out",
       folder / "log.csv", "--set", "track.tag.acquire_decimate=2", "--set",
       "track.tag.recheck_every=1", "--set", "track.tag.least_contrast=5", "--set",
       "track.capture.same_s=60", "--set", "track.capture.reconnect_s=0", "--set", kPatient});
  INFO(result.out << result.err);
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Contains("camera unplugged"));
  const std::vector<double> sent_s = server.SentTimes_s();
  REQUIRE(sent_s.size() == kPictures);
  const json run = json::parse(test::ReadFile(folder / "log.run.json"));
  const double zero_s = run["zero_of_t_s_on_the_steady_clock"];
  CHECK(run["delivered"] == kPictures);
  CHECK(run["dropped"].get<int>() > 10);
  // No trajectory: the tag stands, and under load there may be a single row.
  std::istringstream log(test::ReadFile(folder / "log.csv"));
  std::string line;
  std::getline(log, line);
  const std::vector<std::string> names = Cells(line);
  const auto frame = std::find(names.begin(), names.end(), "frame") - names.begin();
  // How many were sent before a picture was read: what piles up on the way would be dozens.
  std::vector<long> behind;
  while (std::getline(log, line)) {
    const std::vector<std::string> cells = Cells(line);
    const double read_s = zero_s + std::stod(cells.at(0));
    const auto own = sent_s.begin() + std::stol(cells.at(frame));
    CHECK(read_s >= *own);
    behind.push_back(std::lower_bound(own, sent_s.end(), read_s) - own - 1);
  }
  REQUIRE(!behind.empty());
  std::sort(behind.begin(), behind.end());
  INFO(behind.size() << " rows, median " << behind[behind.size() / 2] << " pictures, worst "
                     << behind.back());
  CHECK(behind[behind.size() / 2] < 8);
}

}  // namespace
}  // namespace rift
