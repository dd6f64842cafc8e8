#pragma once

#include <array>
#include <string>
#include <string_view>

namespace rift::hardware {

enum class Protocol { kAuto, kPlain, kFramed };
constexpr std::array<std::string_view, 3> EnumNames(Protocol) {
  return {"auto", "plain", "framed"};
}

struct LineOptions {
  int baud = 9600;
  Protocol protocol = Protocol::kAuto;
  double line_share = 0.5;
  double heartbeat_s = 0.05;
  double write_timeout_s = 0.05;
  double hello_s = 2.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("baud", self.baud, 50, 4'000'000, "bits a second, 8N1 (HM-10: 9600)");
    field("protocol", self.protocol,
          "the authors' text, frames with sequence and checksum, or what the robot answers to");
    field("line_share", self.line_share, 0.01, 1.0,
          "share of the line that is used at most (back-to-back writes over BLE lose 58 % of the "
          "bytes, a line in 33 ms 0.06 %)");
    field("heartbeat_s", self.heartbeat_s, 0.005, 0.2,
          "a command is sent again after this long, if the control step behind it is fresh");
    field("write_timeout_s", self.write_timeout_s, 1e-3, 1.0, "a write gives up after this long");
    field("hello_s", self.hello_s, 0.1, 30.0, "how long a robot may take to answer the hello");
  }
};

/// When the robot is stopped for good.
struct GuardOptions {
  double pose_stale_s = 0.15;
  double control_stale_s = 0.1;
  double link_lag_s = 0.25;
  double host_stall_s = 0.25;
  double jump_m = 0.1;
  double jump_deg = 60.0;
  double max_speed_mps = 2.0;
  double max_power = 1.0;
  double battery_min_v = 0.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("pose_stale_s", self.pose_stale_s, 0.02, 2.0,
          "no power while the newest pose was captured longer ago");
    field("control_stale_s", self.control_stale_s, 0.02, 2.0,
          "no power while the last control step is longer ago");
    field("link_lag_s", self.link_lag_s, 0.02, 2.0,
          "a command must be answered within this (framed protocol)");
    field("host_stall_s", self.host_stall_s, 0.05, 2.0,
          "rift itself may not stand still for longer (SIGSTOP, suspend, overload)");
    field("jump_m", self.jump_m, 1e-3, 10.0, "a pose this far from where it can be is a jump");
    field("jump_deg", self.jump_deg, 1.0, 180.0,
          "a turn by more than this between two poses is one");
    field("max_speed_mps", self.max_speed_mps, 0.01, 100.0,
          "how fast a robot can move between poses");
    field("max_power", self.max_power, 0.0, 1.0, "a command above this stops the trial");
    field("battery_min_v", self.battery_min_v, 0.0, 30.0,
          "the trial stops below this (3pi+: four cells, 3.6 V is empty); 0: not watched");
  }
};

/// What the stopping distance is worked out from.
struct StoppingOptions {
  double full_power_speed_mps = 1.6;
  double braking_mps2 = 2.0;
  double robot_watchdog_s = 0.3;
  double delay_s = 0.1;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("full_power_speed_mps", self.full_power_speed_mps, 0.01, 100.0,
          "speed at power 1 (trials: 0.311 m/s at 0.20, 0.241 at 0.15)");
    field("braking_mps2", self.braking_mps2, 0.01, 100.0,
          "how fast it loses speed with the motors off; a cautious guess, measure it");
    field("robot_watchdog_s", self.robot_watchdog_s, 0.0, 60.0,
          "the robot's own; rift's listener: 0.3. The authors' has none");
    field("delay_s", self.delay_s, 0.0, 5.0,
          "from host to motor, until rift drive --ping has measured it");
  }
};

struct PingOptions {
  double duration_s = 3.0;
  double max_p99_s = 0.15;
  double max_loss = 0.05;
  int max_burst = 3;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("duration_s", self.duration_s, 0.5, 600.0, "how long the link is measured before arming");
    field("max_p99_s", self.max_p99_s, 1e-3, 10.0, "budget: 99 % of the round trips are shorter");
    field("max_loss", self.max_loss, 0.0, 1.0, "budget: share of the commands without an answer");
    field("max_burst", self.max_burst, 0, 1000,
          "budget: commands lost in a row (the robot stops by itself after 300 ms)");
  }
};

/// How the robot has to stand before it may start, and how it starts.
struct StartOptions {
  /// The authors put their robot down 59 times by hand, within 0.045 m and 3.4 deg.
  double within_m = 0.05;
  double within_deg = 5.0;
  double countdown_s = 3.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("within_m", self.within_m, 1e-3, 1e3,
          "a drive does not start farther from the first waypoint");
    field("within_deg", self.within_deg, 0.1, 180.0, "nor turned further from its heading");
    field("countdown_s", self.countdown_s, 0.0, 60.0,
          "from Enter to the first power, time to cancel; 0: none");
  }
};

/// The real robot: its line, when it is stopped, how the link is judged.
struct HardwareOptions {
  LineOptions line;
  GuardOptions guard;
  StoppingOptions stopping;
  PingOptions ping;
  StartOptions start;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("line", self.line, "the serial line to the robot");
    field("guard", self.guard, "when the robot is stopped for good");
    field("stopping", self.stopping, "what the printed stopping distance is worked out from");
    field("ping", self.ping, "how the link is measured, and what it must keep");
    field("start", self.start, "how the robot must stand before it starts, and the countdown");
  }

  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;
};

/// Farthest that the robot goes after the host has fallen silent, at `power`: speed times watchdog
/// and delay, and the braking.
double StoppingDistance_m(const StoppingOptions& options, double power);

}  // namespace rift::hardware
