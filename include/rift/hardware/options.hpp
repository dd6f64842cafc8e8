#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "rift/odometry/odometry.hpp"

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

/// What stops a robot whose link breaks.
enum class Watchdog { kUnknown, kRobot, kNone };
constexpr std::array<std::string_view, 3> EnumNames(Watchdog) {
  return {"unknown", "robot", "none"};
}

/// The lines of a robot that does not answer. The defaults are the authors' listener's.
struct PlainOptions {
  std::string format = "{left:.2f} {right:.2f}\n";
  std::vector<double> range{-1.0, 1.0};
  Watchdog watchdog = Watchdog::kUnknown;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("format", self.format,
          "a command: {left} and {right} with formats as in Python, the text between, its ending");
    field("range", self.range, -1e6, 1e6,
          "what full power backward and full power forward are in the robot's own unit");
    field("watchdog", self.watchdog,
          "what stops it when the link breaks: robot, stopping.robot_watchdog_s after the last "
          "command; none; unknown, and then it is not driven");
  }
  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;
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
          "no power while the newest picture's time stamp is older; what the camera's stamps are "
          "late by themselves, up to evidence.max_latency_s, comes on top");
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

/// When what the camera shows and what the wheels do contradict each other.
struct EvidenceOptions {
  double still_m = 0.006;
  double still_deg = 4.0;
  double blind_m = 0.012;
  double blind_s = 0.1;
  double repeats_s = 0.1;
  double pushed_m = 0.03;
  double pushed_deg = 15.0;
  double agree_m = 0.05;
  double agree_share = 0.4;
  double slip_share = 0.2;
  double max_latency_s = 0.25;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("still_m", self.still_m, 1e-4, 1.0,
          "a pose that moved less stands (a standing tag jitters by 1 mm at most)");
    field("still_deg", self.still_deg, 0.1, 90.0, "and turned less (it jitters by 0.5 deg)");
    field(
        "blind_m", self.blind_m, 1e-3, 10.0,
        "how far a wheel may roll while the pose stands; three times as far where the robot tells "
        "no encoders and its commands must do");
    field("blind_s", self.blind_s, 0.0, 2.0,
          "and what it rolls in this time on top (plus max_latency_s while the camera's latency is "
          "not measured)");
    field("repeats_s", self.repeats_s, 0.0, 3600.0,
          "how long all pictures may be the same one while the wheels roll by 5 mm; with "
          "max_latency_s and guard.link_lag_s on top, while the robot is told to drive, whatever "
          "its wheels tell");
    field("pushed_m", self.pushed_m, 1e-3, 10.0,
          "how far the pose may move while the wheels stand");
    field("pushed_deg", self.pushed_deg, 0.1, 180.0, "and turn");
    field("agree_m", self.agree_m, 1e-3, 10.0,
          "how far pose and wheels may part within 0.4 s, whatever the wheels did");
    field("agree_share", self.agree_share, 0.0, 10.0,
          "and for each metre that the wheels rolled (slip)");
    field("slip_share", self.slip_share, 0.0, 10.0,
          "how far the pose may fall behind for each metre that the wheels roll, over up to 4 s; "
          "what they roll in max_latency_s comes on top. Where pictures are missing as well, they "
          "are taken to be held back, and only max_latency_s counts");
    field(
        "max_latency_s", self.max_latency_s, 0.02, 2.0,
        "budget: from the light to a picture's time stamp, and how far a pose may lag the wheels");
  }
};

/// The turn on the spot before a drive, from which the camera's latency is measured.
struct TurnOptions {
  bool enabled = true;
  double power = 0.08;
  double most_power = 0.3;
  double pulse_s = 0.06;
  double enough_deg = 3.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("enabled", self.enabled,
          "turn a few degrees to and fro before the first leg; without it the camera's latency is "
          "not known, and only a drive that contradicts it is stopped");
    field("power", self.power, 0.01, 1.0, "of the first pulses; the next are stronger");
    field("most_power", self.most_power, 0.01, 1.0, "of the last");
    field("pulse_s", self.pulse_s, 0.02, 0.5, "length of a pulse");
    field("enough_deg", self.enough_deg, 0.5, 30.0, "pulses grow until the robot turns this far");
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
  PlainOptions plain;
  GuardOptions guard;
  EvidenceOptions evidence;
  TurnOptions turn;
  odometry::OdometryOptions odometry;
  StoppingOptions stopping;
  PingOptions ping;
  StartOptions start;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("line", self.line, "the serial line to the robot");
    field("plain", self.plain, "the commands of a robot that does not speak rift's protocol");
    field("guard", self.guard, "when the robot is stopped for good");
    field("evidence", self.evidence, "what camera and wheels must agree on");
    field("turn", self.turn, "the turn before a drive that measures the camera's latency");
    field("odometry", self.odometry, "wheels and encoders of the robot");
    field("stopping", self.stopping, "what the printed stopping distance is worked out from");
    field("ping", self.ping, "how the link is measured, and what it must keep");
    field("start", self.start, "how the robot must stand before it starts, and the countdown");
  }

  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;
};

/// How far the robot goes on after a fault at worst, at `power`: speed times delay and the time
/// until something stops it, and the braking. That time is the robot's watchdog, when the host
/// falls silent, or `blind_s`, when the camera does: what the host may still drive by the last
/// picture.
double StoppingDistance_m(const StoppingOptions& options, double power, double blind_s = 0.0);

}  // namespace rift::hardware
