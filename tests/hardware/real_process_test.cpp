#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <functional>
#include <memory>

#include "pseudo_terminal.hpp"
#include "rift/hardware/listener.hpp"
#include "rift/hardware/ping.hpp"
#include "rift/hardware/real_robot.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/hardware/signal_watch.hpp"
#include "support/until.hpp"

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

constexpr double kStall_s = 1.0;

/// A host that drives on for ever, as a program would.
int DriveForEver(const std::string& path) {
  SteadyClock clock;
  StillCamera camera(clock);
  HardwareOptions hardware;
  hardware.line.baud = 115200;
  // A loaded machine must not look like a fault; SIGSTOP lasts longer than kStall_s.
  hardware.guard.host_stall_s = kStall_s;
  hardware.guard.link_lag_s = hardware.guard.control_stale_s = 2.0;
  hardware.guard.pose_stale_s = 2.0;
  hardware.line.hello_s = 30.0;
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
  while (robot.state() == DriveState::kArmed) {
    robot.Sense();
    robot.Command({0.25, 0.25});
    robot.Advance(0.02);
  }
  robot.Stop();
  if (robot.Record().stop->reason != StopReason::kPortGone) robot.ConfirmStop(30.0);
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
  bool IsOver() {
    if (!is_over) is_over = ::waitpid(pid, &status, WNOHANG) == pid;
    return is_over;
  }
  int ExitCode() const { return WIFEXITED(status) ? WEXITSTATUS(status) : -1; }

  pid_t pid;
  int status = 0;
  bool is_over = false;
};

/// The robot: the listener behind the pseudo terminal. Its clock may go slower than the machine's,
/// so that its watchdog does not stop it when the machine is busy with something else.
struct RobotEnd {
  double speed = 1.0;
  PseudoTerminal terminal;
  Listener listener;
  SteadyClock clock;

  void Turn() {
    const auto bytes = terminal.Read(2);
    const auto now_ms = static_cast<std::uint32_t>(1000.0 * speed * clock.Now_s());
    terminal.Write(listener.Poll(now_ms, bytes, {1, 2, 5000}));
    if (!bytes.empty()) heard_ms = now_ms;
    before_ms = std::exchange(turned_ms, now_ms);
  }
  void Until(const std::string& what, const std::function<bool()>& is_so) {
    test::WaitUntil(what, [&] {
      Turn();
      return is_so();
    });
  }
  bool Moves() const { return !listener.Motors().IsZero(); }

  // Of the last turn, of the one before it, and of the last one with bytes.
  std::uint32_t turned_ms = 0, before_ms = 0, heard_ms = 0;
};

struct Moving {
  explicit Moving(double speed) : robot{.speed = speed}, host(robot.terminal) {}

  RobotEnd robot;
  Host host;
};

/// A robot that moves at its host's word; begun again where the machine was too busy for the host.
std::unique_ptr<Moving> StartMoving(double speed) {
  std::unique_ptr<Moving> moving;
  test::WaitUntil("a host has made the robot move", [&] {
    moving = std::make_unique<Moving>(speed);
    moving->robot.Until("the robot moves or its host has given up",
                        [&] { return moving->robot.Moves() || moving->host.IsOver(); });
    return moving->robot.Moves();
  });
  return moving;
}

TEST_CASE("The listener alone stops the motors of a host that was killed") {
  const std::unique_ptr<Moving> moving = StartMoving(0.3);
  RobotEnd& robot = moving->robot;
  Host& host = moving->host;
  ::kill(host.pid, SIGKILL);
  robot.Until("the robot stands", [&] { return !robot.Moves(); });
  // In its first turn 300 ms or more after the last command, and in none before.
  CHECK(robot.listener.Stops() >= 1);  // on a busy machine it may have waited for its host before
  CHECK(robot.turned_ms - robot.heard_ms >= Listener::kWatchdog_ms);
  CHECK(robot.before_ms - robot.heard_ms < Listener::kWatchdog_ms);
}

TEST_CASE("A host that was stopped and continued has been stopped for good") {
  const std::unique_ptr<Moving> moving = StartMoving(0.3);
  RobotEnd& robot = moving->robot;
  Host& host = moving->host;
  ::kill(host.pid, SIGSTOP);
  const double stopped_s = robot.clock.Now_s();
  robot.Until("the robot stands", [&] { return !robot.Moves(); });
  CHECK(robot.listener.Stops() >= 1);  // on a busy machine it may have waited for its host before
  robot.Until("the host stood still for too long",
              [&] { return robot.clock.Now_s() > stopped_s + 1.2 * kStall_s; });
  ::kill(host.pid, SIGCONT);
  bool moved = false;
  robot.Until("the host ends", [&] {
    moved = moved || robot.Moves();
    return host.IsOver();
  });
  CHECK_FALSE(moved);
  CHECK(host.ExitCode() == 100 + static_cast<int>(StopReason::kHostStalled));
}

TEST_CASE("A signal stops the robot before the program ends and the stop is acknowledged") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGTTIN, SIGTTOU}) {
    INFO("SIG" << sigabbrev_np(signal));
    const std::unique_ptr<Moving> moving = StartMoving(0.1);
    RobotEnd& robot = moving->robot;
    Host& host = moving->host;
    ::kill(host.pid, signal);
    // The host is asked first: what it ended with, the robot had heard by then.
    robot.Until("the robot stands", [&] {
      const bool is_over = host.IsOver();
      CHECK_FALSE((is_over && robot.Moves()));
      return !robot.Moves();
    });
    CHECK(robot.listener.Stops() == 0);  // by the host's word
    robot.Until("the host ends", [&] { return host.IsOver(); });
    CHECK_FALSE(robot.Moves());
    CHECK(host.ExitCode() == 100 + static_cast<int>(StopReason::kSignal));
  }
}

TEST_CASE("A pseudo terminal that closes is a port that went away") {
  const std::unique_ptr<Moving> moving = StartMoving(1.0);
  RobotEnd& robot = moving->robot;
  Host& host = moving->host;
  robot.terminal.Close();
  test::WaitUntil("the host ends", [&] { return host.IsOver(); });
  CHECK(host.ExitCode() == static_cast<int>(StopReason::kPortGone));
}

}  // namespace
}  // namespace rift::hardware
