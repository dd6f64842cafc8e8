#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"
#include "support/environment.hpp"
#include "support/paper_camera.hpp"
#include "support/running_rift.hpp"
#include "support/tree.hpp"
#include "support/trials.hpp"
#include "vision/mjpeg_server.hpp"

namespace rift {
namespace {

using Catch::Matchers::Contains;
using nlohmann::json;
using test::Environment;
using test::ProcessResult;
using test::RunRift;
using vision::synthetic::MjpegServer;

const std::string kData = test::SourceDir() + "/data/camera";
const std::string kCamera = kData + "/camera.yaml";

std::vector<std::string> Tracking(const std::string& camera, const std::string& out,
                                  const std::string& seconds) {
  return {"track", "--camera", camera,       "--calibration", kCamera,
          "--out", out,        "--duration", seconds};
}

double Seconds(const std::function<void()>& what) {
  const auto begin = std::chrono::steady_clock::now();
  what();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

const std::vector<double>& Column(const trajectory::Trajectory& log, const std::string& name) {
  for (const trajectory::Channel& channel : log.channels) {
    if (channel.name == name) return channel.values;
  }
  throw std::runtime_error("no column " + name);
}

TEST_CASE("A V4L2 camera of 30 and 60 Hz gives as many rows a second with their latency") {
  const int fps = GENERATE(30, 60);
  const test::TemporaryFolder folder;
  const Environment shim("LD_PRELOAD", test::BuildDir() + "/tests/librift_v4l2_shim.so");
  const Environment jpegs("RIFT_SHIM_JPEGS", kData + "/frames");
  std::vector<std::string> words = Tracking("/dev/video0", folder / "log.csv", "4");
  words.insert(words.end(), {"--fps", std::to_string(fps)});
  const ProcessResult result = RunRift(words);
  INFO(result.out << result.err);
  REQUIRE(result.exit_code == 0);
  const json run = json::parse(test::ReadFile(folder / "log.run.json"));
  CHECK(run["delivered"].get<double>() > 0.7 * 4.0 * fps);  // however busy the machine
  CHECK(run["latency_s"]["p50"].get<double>() > 0.011);     // the shim's transfer
  // Where finding the tag alone takes more than half of a picture's time, rows may be left out.
  const bool has_time = run["finding_s"]["p95"].get<double>() < 0.5 / fps;
  if (has_time) CHECK(run["rows_per_s"].get<double>() == Approx(fps).epsilon(0.1));
  if (has_time) CHECK(run["latency_s"]["p50"].get<double>() < 0.060);
  const auto log = test::LoadTrajectory(folder / "log.csv", trajectory::Format::kRift);
  for (const double latency_s : Column(log, "latency_s")) CHECK(latency_s > 0.0);
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
  ProcessResult result;
  std::vector<std::string> words = Tracking("/dev/video0", folder / "log.csv", "20");
  // Of the shim's pictures only the raw ones, which show no tag, can be dark.
  const bool is_raw = fault.name == "black";
  words.insert(words.end(),
               {"--set", is_raw ? "track.capture.format=yuyv" : "track.capture.format=mjpg"});
  const double took_s = Seconds([&] { result = RunRift(words); });
  INFO(fault.name << " took " << took_s << " s\n" << result.out << result.err);
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Contains("camera " + fault.state + ": "));
  // Long before its 20 s; how soon a fault is named, tests/vision/device_test.cpp measures.
  CHECK(took_s < 12.0);
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

TEST_CASE("Ctrl-C ends the tracking cleanly with its summary") {
  const test::TemporaryFolder folder;
  const Environment shim("LD_PRELOAD", test::BuildDir() + "/tests/librift_v4l2_shim.so");
  const Environment jpegs("RIFT_SHIM_JPEGS", kData + "/frames");
  test::RunningRift rift(Tracking("/dev/video0", folder / "log.csv", "60"));
  for (int i = 0; i < 100 && !std::filesystem::exists(folder / "log.csv"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  rift.Signal(SIGINT);
  ProcessResult result;
  CHECK(Seconds([&] { result = rift.Wait(); }) < 1.5);
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("rows in") && Contains("dropped") && Contains("p95"));
  CHECK(json::parse(test::ReadFile(folder / "log.run.json"))["rows"].get<int>() > 0);
}

// A whole picture of 1080p at AprilTag's finest for every frame takes several frames' time.
TEST_CASE("A reader that is too slow for its http camera stays below 100 ms behind") {
  const test::TemporaryFolder folder;
  const vision::CameraModel camera = test::PaperCamera();
  test::WriteText(folder / "cam.yaml", vision::WriteCamera(camera));
  vision::SyntheticCamera renderer(camera, {});
  std::mt19937_64 generator(1);
  vision::RobotMotion robot;
  robot.world_from_tag.translation() = Eigen::Vector3d(0.1, 0.05, 0.03);
  const vision::Frame frame = renderer.Render(robot, vision::PixelFormat::kJpeg, generator);
  MjpegServer server(frame.bytes, {.pictures = 90});
  ProcessResult result;
  result = RunRift({"track", "--camera", server.Url(), "--calibration", folder / "cam.yaml",
                    "--out", folder / "log.csv", "--set", "track.tag.acquire_decimate=2", "--set",
                    "track.tag.recheck_every=1", "--set", "track.tag.least_contrast=5", "--set",
                    "track.capture.same_s=60"});
  const double ended_s = MjpegServer::Now_s();
  INFO(result.out << result.err);
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Contains("camera unplugged"));
  const std::vector<double> sent_s = server.SentTimes_s();
  REQUIRE(sent_s.size() == 90);
  CHECK(ended_s - sent_s.back() < 2.0);
  const json run = json::parse(test::ReadFile(folder / "log.run.json"));
  const double zero_s = run["zero_of_t_s_on_the_steady_clock"];
  CHECK(run["dropped"].get<int>() > 10);
  const auto log = test::LoadTrajectory(folder / "log.csv", trajectory::Format::kRift);
  const std::vector<double>& index = Column(log, "frame");
  std::vector<double> behind_s;
  for (std::size_t i = 0; i < index.size(); ++i) {
    behind_s.push_back(zero_s + log.poses[i].t_s - sent_s.at(static_cast<std::size_t>(index[i])));
  }
  std::sort(behind_s.begin(), behind_s.end());
  INFO(behind_s.size() << " rows, median " << behind_s[behind_s.size() / 2] << " s, worst "
                       << behind_s.back() << " s");
  CHECK(behind_s[behind_s.size() / 2] < 0.100);
  CHECK(behind_s.front() >= 0.0);
}

}  // namespace
}  // namespace rift
