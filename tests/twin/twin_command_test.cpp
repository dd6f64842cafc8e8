#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <optional>

#include "rift/hardware/robot_link.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/camera/capture_thread.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"
#include "support/documented.hpp"
#include "support/tree.hpp"
#include "support/trials.hpp"
#include "twin_process.hpp"

namespace rift::twin {
namespace {

constexpr double kPower = 0.2;

/// The host's end of the serial line, obeying nobody.
struct Host {
  explicit Host(const std::string& port)
      : line(port, options.baud, options.write_timeout_s),
        link(line, options, hardware::FindProtocol(line, clock, options)) {}

  /// The power, for so long.
  void Drive(
      double power, double duration_s, const std::function<void()>& meanwhile = [] {}) {
    link.Put({power, power}, true);
    for (const double end_s = clock.Now_s() + duration_s; clock.Now_s() < end_s;
         clock.Wait(0.002)) {
      link.Tick(clock.Now_s());
      for (const auto& heard : link.TakeHeard()) answer = heard.answer;
      meanwhile();
    }
  }

  hardware::LineOptions options;
  hardware::SteadyClock clock;
  hardware::SerialPort line;
  hardware::RobotLink link;
  std::optional<hardware::Answer> answer;
};

/// The camera's side of a host: where the tag was seen, and when the picture came.
struct Eye {
  Eye(const std::string& url, const std::string& calibration)
      : capture([url] { return vision::OpenCamera(url, {}); }, {}),
        tracker(vision::ReadCamera(test::ReadFile(calibration), calibration), {}) {}

  std::optional<vision::Sighting> Look(double timeout_s = 0.0) {
    const auto frame = capture.Next(timeout_s);
    if (!frame) return std::nullopt;
    return tracker.Track(*frame).sighting;
  }

  vision::CaptureThread capture;
  vision::TagTracker tracker;
};

trajectory::Trajectory ReadRun(const test::TwinProcess& twin, const std::string& file) {
  return trajectory::ReadLog(test::ReadFile(twin.Folder() + "/" + file), file).trajectory;
}

double LastMotion_s(const trajectory::Trajectory& truth) {
  double t_s = 0.0;
  for (size_t i = 1; i < truth.poses.size(); ++i) {
    const auto &before = truth.poses[i - 1], &pose = truth.poses[i];
    if ((pose.Position() - before.Position()).norm() > 1e-4) t_s = pose.t_s;
  }
  return t_s;
}

double Off_m(const vision::Sighting& seen, const trajectory::StampedPose& truth) {
  return std::hypot(seen.map_from_tag.translation().x() - truth.x_m,
                    seen.map_from_tag.translation().y() - truth.y_m);
}

TEST_CASE("The twin is seen to drive as it is told and to stop after the last command") {
  test::TwinProcess twin({"--set", "twin.still_s=1.5"});
  Eye eye(twin.Get("camera"), twin.Get("calibration"));
  const auto start = eye.Look(30.0);
  REQUIRE(start);
  Host host(twin.Get("port"));
  CHECK(host.link.protocol() == hardware::Protocol::kFramed);
  host.Drive(0.0, 0.3);
  host.Drive(kPower, 0.8);
  const double last_word_s = host.clock.Now_s();

  std::optional<vision::Sighting> last = start;
  while (host.clock.Now_s() < last_word_s + 1.2) {
    if (const auto seen = eye.Look(0.05)) last = seen;
  }
  CHECK((last->map_from_tag.translation() - start->map_from_tag.translation()).norm() > 0.1);
  CHECK(twin.ExitCode() == 0);

  const auto summary = nlohmann::json::parse(test::ReadFile(twin.Folder() + "/summary.json"));
  CHECK(summary.at("robot_stopped_by_itself") == 1);
  CHECK(summary.at("has_driven") == true);
  CHECK(test::KeysOf(summary) == test::DocumentedKeys("summary.json of rift simulate --twin"));
  const auto tag = ReadRun(twin, "trajectory.csv");
  CHECK(Off_m(*start, tag.poses.front()) < 0.001);
  CHECK(Off_m(*last, tag.poses.back()) < 0.001);
  const double stood_s =
      summary.at("began_steady_s").get<double>() + LastMotion_s(ReadRun(twin, "truth.csv"));
  // The robot's watchdog, the radio, its roll-out; a loaded machine looks away.
  CHECK(stood_s - last_word_s > 0.2);
  CHECK(stood_s - last_word_s < 0.3 + 0.4);
}

/// Drives on until it is killed.
pid_t ForkHost(const std::string& port) {
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  try {
    Host host(port);
    host.Drive(0.0, 0.3);
    host.Drive(kPower, 60.0);
  } catch (const std::exception&) {
  }
  ::_exit(1);
}

TEST_CASE("A killed host stops the twin and its port can be opened again") {
  test::TwinProcess twin({"--set", "twin.still_s=20"});
  const pid_t pid = ForkHost(twin.Get("port"));
  hardware::SteadyClock clock;
  clock.Wait(1.5);
  CHECK_THROWS_WITH(Host(twin.Get("port")), Catch::Contains("in use by another program"));
  ::kill(pid, SIGKILL);
  ::waitpid(pid, nullptr, 0);
  clock.Wait(1.0);

  Host host(twin.Get("port"));
  host.Drive(0.0, 0.5);
  REQUIRE(host.answer);
  CHECK(host.answer->stops >= 1);
  CHECK(host.answer->left > 20);
  const auto counts = host.answer->left;
  host.Drive(0.0, 0.5);
  CHECK(std::abs(host.answer->left - counts) <= 1);
  twin.Signal(SIGTERM);
  CHECK(twin.ExitCode() == 0);
  CHECK(ReadRun(twin, "truth.csv").ArcLength_m() > 0.01);
}

TEST_CASE("What the twin cannot do is refused in one line") {
  const std::string experiment = test::SourceDir() + "/configs/twin.yaml";
  const test::TemporaryFolder folder;
  test::WriteText(folder / "empty.yaml", "name: empty\n");
  const auto refused = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"simulate", "--twin", "--out", folder / "out"};
    words.insert(words.end(), more.begin(), more.end());
    const test::ProcessResult result = test::RunRift(words);
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    return result.err;
  };
  CHECK_THAT(refused({folder / "empty.yaml"}), Catch::Contains("waypoint"));
  CHECK_THAT(refused({}), Catch::Contains("EXPERIMENT is missing"));
  CHECK_THAT(refused({experiment, "--video", "a.mp4"}), Catch::Contains("--video"));
  CHECK_THAT(refused({experiment, "--set", "twin.camera_height_m=0.3"}),
             Catch::Contains("camera must hang at"));
}

}  // namespace
}  // namespace rift::twin
