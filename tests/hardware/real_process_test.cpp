#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <functional>

#include "pseudo_terminal.hpp"
#include "rift/hardware/listener.hpp"
#include "rift/hardware/ping.hpp"
#include "rift/hardware/real_robot.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/hardware/signal_watch.hpp"

namespace rift::hardware {
namespace {

/// A camera that always sees the robot where it was.
class StillCamera : public PoseSource {
 public:
  explicit StillCamera(Clock& clock) : clock_(clock) {}
  PoseNews Newest() override {
    const double now_s = clock_.Now_s();
    PoseNews news;
    news.newest = PoseSample{{now_s - 0.01, {}, 0.0, 0.0, 0.0}, now_s - 0.005, now_s};
    news.looked_s = now_s - 0.01;
    return news;
  }

 private:
  Clock& clock_;
};

/// A host that drives on for ever, as a program would.
int DriveForEver(const std::string& path) {
  SteadyClock clock;
  StillCamera camera(clock);
  HardwareOptions hardware;
  hardware.line.baud = 115200;
  // A loaded machine must not look like a fault; SIGSTOP lasts longer.
  hardware.guard.host_stall_s = hardware.guard.link_lag_s = hardware.guard.control_stale_s = 0.6;
  SerialPort port(path, 115200, 0.05);
  const SignalWatch signals;
  RealRobotOptions options;
  options.hardware = hardware;
  options.protocol = FindProtocol(port, clock, hardware.line);
  RealRobot robot(port, camera, clock, options);
  robot.AddStopper([&]() -> std::optional<std::pair<StopReason, std::string>> {
    if (const auto name = signals.Seen()) return std::pair(StopReason::kSignal, *name);
    return std::nullopt;
  });
  robot.Advance(0.2);
  clock.Wait(0.1);
  robot.Arm();
  for (int i = 0; i < 1000 && robot.state() == DriveState::kArmed; ++i) {
    robot.Sense();
    robot.Command({0.25, 0.25});
    robot.Advance(0.02);
  }
  robot.Stop();
  robot.ConfirmStop(1.0);
  const DriveRecord evidence = robot.Record();
  return static_cast<int>(evidence.stop->reason) + (evidence.stop_acknowledged == true ? 100 : 0);
}

struct Host {
  explicit Host(PseudoTerminal& terminal) : pid(::fork()) {
    if (pid != 0) return;
    terminal.Close();  // else its own copy would keep the port open
    try {
      ::_exit(DriveForEver(terminal.path()));
    } catch (const std::exception&) {
      ::_exit(99);
    }
  }
  ~Host() {
    ::kill(pid, SIGKILL);
    ::kill(pid, SIGCONT);
    if (!is_over) ::waitpid(pid, nullptr, 0);
  }
  int ExitCode() {
    int status = 0;
    ::waitpid(pid, &status, 0);
    is_over = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  pid_t pid;
  bool is_over = false;
};

/// The robot: the listener behind the pseudo terminal, in real time.
struct RobotEnd {
  PseudoTerminal terminal;
  Listener listener;
  SteadyClock clock;

  void Turn() {
    const auto bytes = terminal.Read(2);
    terminal.Write(
        listener.Poll(static_cast<std::uint32_t>(clock.Now_s() * 1000.0), bytes, {1, 2, 5000}));
  }
  /// Seconds until `is_so`, at most 8.
  double Until(const std::function<bool()>& is_so) {
    const double start_s = clock.Now_s();
    while (!is_so() && clock.Now_s() < start_s + 8.0) Turn();
    return clock.Now_s() - start_s;
  }
  bool Moves() const { return !listener.Motors().IsZero(); }
};

constexpr double kScheduling_s = 0.2;  // a loaded machine may look away that long

TEST_CASE("The listener alone stops the motors of a host that was killed") {
  RobotEnd robot;
  Host host(robot.terminal);
  REQUIRE(robot.Until([&] { return robot.Moves(); }) < 8.0);
  ::kill(host.pid, SIGKILL);
  CHECK(robot.Until([&] { return !robot.Moves(); }) < 0.3 + kScheduling_s);
}

TEST_CASE("A host that was stopped and continued has been stopped for good") {
  RobotEnd robot;
  Host host(robot.terminal);
  REQUIRE(robot.Until([&] { return robot.Moves(); }) < 8.0);
  ::kill(host.pid, SIGSTOP);
  CHECK(robot.Until([&] { return !robot.Moves(); }) < 0.3 + kScheduling_s);
  const double start_s = robot.clock.Now_s();
  robot.Until([&] { return robot.clock.Now_s() > start_s + 0.7; });
  ::kill(host.pid, SIGCONT);
  bool moved = false;
  for (const double end_s = robot.clock.Now_s() + 0.5; robot.clock.Now_s() < end_s;) {
    robot.Turn();
    moved = moved || robot.Moves();
  }
  CHECK_FALSE(moved);
  CHECK(host.ExitCode() == 100 + static_cast<int>(StopReason::kHostStalled));
}

TEST_CASE("A signal stops the robot before the program ends and the stop is acknowledged") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    RobotEnd robot;
    Host host(robot.terminal);
    REQUIRE(robot.Until([&] { return robot.Moves(); }) < 8.0);
    ::kill(host.pid, signal);
    CHECK(robot.Until([&] { return !robot.Moves(); }) < 0.1 + kScheduling_s);
    const double start_s = robot.clock.Now_s();
    robot.Until([&] { return robot.clock.Now_s() > start_s + 0.3; });
    CHECK(host.ExitCode() == 100 + static_cast<int>(StopReason::kSignal));
  }
}

TEST_CASE("A pseudo terminal that closes is a port that went away") {
  RobotEnd robot;
  Host host(robot.terminal);
  REQUIRE(robot.Until([&] { return robot.Moves(); }) < 8.0);
  robot.terminal.Close();
  CHECK(host.ExitCode() == static_cast<int>(StopReason::kPortGone));
}

}  // namespace
}  // namespace rift::hardware
