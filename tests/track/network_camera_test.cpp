#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/inputs/trials.hpp"
#include "support/processes/child_end.hpp"
#include "support/processes/running_rift.hpp"
#include "support/processes/shell.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"
#include "track/window_user.hpp"

namespace rift {
namespace {

using test::ProcessResult;

const std::string kData = test::SourceDir() + "/data/camera";

/// GStreamer's RTSP server in a process of its own.
class RtspCamera {
 public:
  static bool IsInstalled() {
    return test::RunShell(
               "/usr/bin/python3 -c \"import gi; gi.require_version('GstRtspServer', '1.0'); "
               "from gi.repository import GstRtspServer, Gst; Gst.init(None); "
               "assert Gst.ElementFactory.find('rtpjpegpay')\" >/dev/null 2>&1") == 0;
  }

  explicit RtspCamera(const std::string& port = "0") {
    const std::string command = fmt::format(
        "/usr/bin/python3 {}/tests/vision/rtsp_camera.py {}/frames 15 {} jpeg >{} 2>/dev/null & "
        "echo $! >{}",
        test::SourceDir(), kData, port, folder_ / "out", folder_ / "pid");
    REQUIRE(test::RunShell(command) == 0);
    std::ifstream(folder_ / "pid") >> pid_;
    test::WaitUntil("the RTSP server says its port", [&] {
      std::string word;
      std::ifstream(folder_ / "out") >> word >> port_;
      return word == "port";
    });
  }
  /// Returns when it has ended, so that another may have its port.
  ~RtspCamera() {
    Signal(SIGKILL);
    test::EndsInTime(pid_);
  }
  RtspCamera(const RtspCamera&) = delete;
  RtspCamera& operator=(const RtspCamera&) = delete;

  void Signal(int signal) const { ::kill(pid_, signal); }
  const std::string& Port() const { return port_; }

 private:
  test::TemporaryFolder folder_;
  pid_t pid_ = -1;
  std::string port_;
};

long LinesIn(const std::string& path) {
  if (!std::filesystem::exists(path)) return 0;
  const std::string text = test::ReadFile(path);
  return std::count(text.begin(), text.end(), '\n');
}

TEST_CASE("An RTSP camera is tracked through a stall and through a new start of its server") {
  if (!RtspCamera::IsInstalled()) {
    WARN("SKIPPED: gir1.2-gst-rtsp-server-1.0 or gstreamer1.0-plugins-good is not installed");
    return;
  }
  const test::TemporaryFolder folder;
  const std::string log = folder / "log.csv";
  auto camera = std::make_unique<RtspCamera>();
  const std::string port = camera->Port();
  test::RunningRift rift({"track", "--camera", "rtsp://127.0.0.1:" + port + "/camera",
                          "--calibration", kData + "/camera.yaml", "--out", log, "--give-up", "600",
                          "--set", "track.capture.open_timeout_s=3", "--set",
                          "track.capture.reconnect_s=600"});
  const auto goes_on = [&](const std::string& what) {
    const long before = LinesIn(log);
    rift.WaitUntil(what, [&] { return LinesIn(log) > before + 20; });
  };
  // Once more than before `deed`: a busy machine may have made it say so already.
  const auto says_after = [&](const auto& deed, const std::string& line) {
    const int before = test::CountOf(line, rift.Err());
    deed();
    rift.WaitUntil(line, [&] { return test::CountOf(line, rift.Err()) > before; });
  };
  goes_on("the first rows");
  says_after([&] { camera->Signal(SIGSTOP); }, "nothing came for 3 s");
  camera->Signal(SIGCONT);
  goes_on("rows after the stall");
  says_after([&] { camera.reset(); }, "the stream ended");
  camera = std::make_unique<RtspCamera>(port);
  goes_on("rows after the new start");
  rift.Signal(SIGINT);
  const ProcessResult result = rift.Wait();
  INFO(result.out << result.err);
  REQUIRE(result.exit_code == 0);
  const auto run = nlohmann::json::parse(test::ReadFile(folder / "log.run.json"));
  CHECK(run["reconnects"].get<int>() >= 2);
  // Each row that was measured is one of the pictures.
  const auto truth = test::LoadTrajectory(kData + "/truth.csv", trajectory::Format::kRift);
  const auto poses = test::LoadTrajectory(log, trajectory::Format::kRift);
  for (const trajectory::Channel& channel : poses.channels) {
    if (channel.name != "track_state") continue;
    for (std::size_t i = 0; i < poses.poses.size(); ++i) {
      if (channel.values[i] != 0.0) continue;
      double nearest_m = 1.0;
      for (const auto& pose : truth.poses) {
        nearest_m = std::min(nearest_m, (pose.Position() - poses.poses[i].Position()).norm());
      }
      CHECK(nearest_m < 1e-3);
    }
  }
}

}  // namespace
}  // namespace rift
