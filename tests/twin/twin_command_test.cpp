#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>

#include "rift/hardware/robot_link.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/camera/capture_thread.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"
#include "support/documented.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"
#include "twin_process.hpp"

namespace rift::twin {
namespace {

constexpr double kPower = 0.2;

// Limits that a loaded machine keeps as well.
constexpr const char* kPatient = R"(
track: {tag: {acquire_decimate: 1, lost_after_s: 5}, capture: {silent_s: 20, same_s: 20, open_timeout_s: 60}}
trial: {pose_stale_s: 5, lost_after_s: 20, timeout_s: 60}
hardware:
  line: {hello_s: 20}
  guard: {pose_stale_s: 2, control_stale_s: 2, link_lag_s: 2, host_stall_s: 2}
  ping: {duration_s: 0.5, max_p99_s: 10, max_loss: 1, max_burst: 1000}
  start: {countdown_s: 0}
)";

/// The host's end of the serial line, obeying nobody.
struct Host {
  explicit Host(const std::string& port)
      : line(port, options.baud, options.write_timeout_s),
        link(line, options, hardware::FindProtocol(line, clock, options)) {}

  /// The power until it is so.
  void Drive(double power, const std::string& what, const std::function<bool()>& is_so) {
    link.Put({power, power}, true);
    longest_pause_s = 0.0;
    test::WaitUntil(what, [&] {
      clock.Wait(0.001);
      const double now_s = clock.Now_s();
      const size_t sent = link.sent_count();
      link.Tick(now_s);
      if (link.sent_count() != sent) {
        longest_pause_s = std::max(longest_pause_s, now_s - last_word_s);
        last_word_s = now_s;
      }
      for (const auto& heard : link.TakeHeard()) {
        answer = heard.answer;
        ++answers;
      }
      return is_so();
    });
  }
  void Stand() {
    const int before = answers;
    Drive(0.0, "the robot answered zeros", [&] { return answers >= before + 5; });
  }
  /// Drives until it is so; when the machine looked away for longer than the robot's watchdog
  /// waits, the robot wants a zero before it moves again.
  void DriveUntil(const std::string& what, const std::function<bool()>& is_so) {
    bool is_there = false;
    test::WaitUntil(what, [&] {
      ++beginnings;
      Stand();
      Drive(kPower, what, [&] {
        is_there = is_so();
        return is_there || link.Lag_s(clock.Now_s()) > 0.5;  // it answers no power then
      });
      return is_there;
    });
  }

  hardware::LineOptions options{.hello_s = 30.0};
  hardware::SteadyClock clock;
  hardware::SerialPort line;
  hardware::RobotLink link;
  std::optional<hardware::Answer> answer;
  int answers = 0;
  int beginnings = 0;            ///< from a standstill
  double last_word_s = 0.0;      ///< a moment before the last command was sent
  double longest_pause_s = 0.0;  ///< between two commands since the power was changed
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

/// False when this machine looked away for longer than the twin stands, or than its watchdog waits.
bool IsSeenToDriveAndStop() {
  test::TwinProcess twin({"--set", "twin.still_s=1"});
  Eye eye(twin.Get("camera"), twin.Get("calibration"));
  const auto start = eye.Look(test::kGiveUp.count());
  REQUIRE(start);
  double last_word_s = 0.0;
  try {
    Host host(twin.Get("port"));
    CHECK(host.link.protocol() == hardware::Protocol::kFramed);
    const std::int32_t counts = 400;  // 0.11 m
    host.DriveUntil("the wheels turned", [&] { return host.answer->left > counts; });
    last_word_s = host.last_word_s;
    // Begun anew, it may have stopped by itself where it was to be.
    if (host.longest_pause_s > 0.25 || host.beginnings > 1) return false;
  } catch (const hardware::LineGone&) {
    return false;
  }
  std::optional<vision::Sighting> last = start;
  test::WaitUntil("the twin ends", [&] {
    if (const auto seen = eye.Look(0.05)) last = seen;
    return vision::IsFinal(eye.capture.Status().state);
  });
  if (const auto seen = eye.Look()) last = seen;  // of what came during the last look
  CHECK(twin.ExitCode() == 0);
  const auto summary = nlohmann::json::parse(test::ReadFile(twin.Folder() + "/summary.json"));
  if (summary.at("skipped_s").get<double>() > 0.25) return false;
  CHECK((last->map_from_tag.translation() - start->map_from_tag.translation()).norm() > 0.1);

  CHECK(summary.at("robot_stopped_by_itself") >= 1);
  CHECK(summary.at("has_driven") == true);
  CHECK(test::KeysOf(summary) == test::DocumentedKeys("summary.json of rift simulate --twin"));
  const auto tag = ReadRun(twin, "trajectory.csv");
  CHECK(Off_m(*start, tag.poses.front()) < 0.001);
  CHECK(Off_m(*last, tag.poses.back()) < 0.001);
  // No sooner than its watchdog; how much later is told on a fake clock (twin_robot_test.cpp).
  const double stood_s = summary.at("began_steady_s").get<double>() +
                         summary.at("skipped_s").get<double>() +
                         LastMotion_s(ReadRun(twin, "truth.csv"));
  CHECK(stood_s > last_word_s + 0.25);
  return true;
}

TEST_CASE("A port that is written to without end makes its writer wait, as a radio does") {
  const test::TwinProcess twin;
  const int port = ::open(twin.Get("port").c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  REQUIRE(port >= 0);
  const std::vector<char> bytes(4096, 'x');
  hardware::SteadyClock clock;
  std::size_t taken = 0;
  for (const double until_s = clock.Now_s() + 0.5; clock.Now_s() < until_s;) {
    const ssize_t written = ::write(port, bytes.data(), bytes.size());
    if (written > 0) taken += static_cast<std::size_t>(written);
    clock.Wait(0.001);
  }
  ::close(port);
  CHECK(taken > 4096);    // what is on the way
  CHECK(taken < 65'536);  // with the system's own buffers
}

TEST_CASE("The twin is seen to drive as it is told and to stop after the last command") {
  test::WaitUntil("a twin was driven without a pause", IsSeenToDriveAndStop);
}

/// Drives on until it is killed; writes a byte when the wheels have turned.
pid_t ForkHost(const std::string& port, int moved) {
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  try {
    Host host(port);
    host.DriveUntil("the wheels turn", [&] { return host.answer && host.answer->left > 20; });
    if (::write(moved, "m", 1) != 1) ::_exit(1);
    host.DriveUntil("the end", [] { return false; });
  } catch (const std::exception&) {
  }
  ::_exit(1);
}

TEST_CASE("A twin with a tag of another family is driven by rift drive to its last waypoint") {
  const std::vector<std::string> family{"--set", "track.tag.family=tag25h9", "--set",
                                        "track.tag.id=9"};
  test::ProcessResult result;
  // A busy machine stops a drive.
  test::WaitUntil("a drive was not interrupted", [&] {
    std::vector<std::string> of_twin = family;
    of_twin.insert(of_twin.end(), {"--set", "twin.camera.tag_id=9", "--set", "twin.still_s=60"});
    test::TwinProcess twin(of_twin);
    const test::TemporaryFolder folder;
    test::WriteText(folder / "task.yaml",
                    "include: " + test::SourceDir() + "/configs/twin.yaml\n" + kPatient);
    std::vector<std::string> words{
        "drive",    folder / "task.yaml", "--port",        twin.Get("port"),
        "--camera", twin.Get("camera"),   "--calibration", twin.Get("calibration"),
        "--out",    folder / "run",       "--yes"};
    words.insert(words.end(), family.begin(), family.end());
    result = test::RunRift(words);
    twin.Signal(SIGTERM);
    CHECK(twin.ExitCode() == 0);
    return result.exit_code == 0;
  });
  INFO(result.out << result.err);
  CHECK(result.exit_code == 0);
  // Its tag is as far above the floor as the drive believes.
  CHECK_THAT(result.err, !Catch::Contains("not on the floor"));
}

TEST_CASE("A killed host stops the twin and its port can be opened again") {
  test::TwinProcess twin({"--set", "twin.still_s=60"});
  Eye eye(twin.Get("camera"), twin.Get("calibration"));
  int moved[2];
  REQUIRE(::pipe(moved) == 0);
  const pid_t pid = ForkHost(twin.Get("port"), moved[1]);
  ::close(moved[1]);
  char byte = 0;
  const bool has_moved = ::read(moved[0], &byte, 1) == 1;
  ::close(moved[0]);
  CHECK_THROWS_WITH(Host(twin.Get("port")), Catch::Contains("in use by another program"));
  ::kill(pid, SIGKILL);
  ::waitpid(pid, nullptr, 0);
  REQUIRE(has_moved);
  // The twin's own time goes on by 1/30 s at least with each picture: 1 s, then the robot stands.
  for (int pictures = 0; pictures < 30; ++pictures) {
    REQUIRE(eye.capture.Next(test::kGiveUp.count()));
  }

  Host host(twin.Get("port"));
  host.Stand();
  REQUIRE(host.answer);
  CHECK(host.answer->stops >= 1);
  CHECK(host.answer->left > 20);
  const auto counts = host.answer->left;
  host.Stand();
  CHECK(std::abs(host.answer->left - counts) <= 1);
  twin.Signal(SIGTERM);
  CHECK(twin.ExitCode() == 0);
  CHECK(ReadRun(twin, "truth.csv").ArcLength_m() > 0.01);
}

TEST_CASE("A twin whose folder is removed leaves a whole run all the same") {
  test::TwinProcess twin;
  const std::string camera = test::ReadFile(twin.Get("calibration"));
  std::filesystem::remove_all(twin.Folder());
  twin.Signal(SIGTERM);
  CHECK(twin.ExitCode() == 0);
  CHECK(test::ReadFile(twin.Get("calibration")) == camera);
  for (const char* name : {"experiment.yaml", "truth.csv", "trajectory.csv", "summary.json"}) {
    CHECK(std::filesystem::exists(twin.Folder() + "/" + name));
  }
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
