#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "rift/statistics/random.hpp"
#include "rift/trial/robot.hpp"

namespace rift::simulation {

struct LinkOptions {
  double delay_s = 0.040;
  double baud = 9600.0;
  double poll_s = 0.100;
  std::optional<double> poll_phase;
  int uart_bytes = 32;
  bool two_decimals = true;
  double late_share = 0.0;
  double late_s = 1.7;
  double line_loss = 0.0;
  double byte_loss = 0.0;
  double watchdog_s = 0.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field(
        "delay_s", self.delay_s, 0.0, 2.0,
        "from the command to the robot's serial line in s (BLE connection interval: 0.03 to 0.05)");
    field(
        "baud", self.baud, 0.0, 10e6,
        "bits a second on the robot's serial line, 10 bits a byte (HM-10: 9600); 0: no line time");
    field("poll_s", self.poll_s, 0.0, 2.0,
          "interval in s at which the listener reads its serial line and takes the newest complete "
          "line (authors' robot: 0.1); 0: reads at once");
    field(
        "poll_phase", self.poll_phase, 0.0, 1.0,
        "when the listener first looks, as a share of poll_s; absent: each run draws its own, for "
        "its clock knows nothing of the host's");
    field("uart_bytes", self.uart_bytes, 0, 1'000'000,
          "bytes the serial line keeps between two reads, the rest are lost (RP2040: 32); 0: all");
    field("two_decimals", self.two_decimals,
          "powers are sent as %.2f, as by the authors; false: exactly");
    field(
        "late_share", self.late_share, 0.0, 1.0,
        "share of the runs in which the connection stands late: what is sent before is lost "
        "(authors' logs: in a quarter the robot moves a second or more later than in the others)");
    field("late_s", self.late_s, 0.0, 60.0,
          "by how much then, the mean of an exponential distribution in s (the same logs: 1.7)");
    field("line_loss", self.line_loss, 0.0, 1.0, "share of the lines lost as a whole");
    field("byte_loss", self.byte_loss, 0.0, 1.0,
          "share of the bytes lost one by one (BLE bridge at one line in 33 ms: 0.0006)");
    field("watchdog_s", self.watchdog_s, 0.0, 60.0,
          "motors stop when no line was understood for so long, in s; 0: the last command is held "
          "for ever (authors' robot)");
  }
  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;
};

/// The way of a command from the host to the motors: radio delay, line time, a small receive buffer
/// and a listener that looks into it now and then. Works on bytes, since a line cut by an overrun
/// can parse as another number. Times are events in s, so nothing depends on a step.
class Link {
 public:
  Link(const LinkOptions& options, std::uint64_t seed);

  /// Writes one command line at `at_s`, no earlier than the last Advance.
  void Send(double at_s, const control::WheelPower& power);
  /// As Send, but drops the lines that are still on their way.
  void SendUrgently(double at_s, const control::WheelPower& power);

  /// Lets time pass up to `to_s`; returns the mean power at the motors since the last call, which
  /// makes a step respond to the very moment a command takes effect.
  control::WheelPower Advance(double to_s);
  /// The power the motors hold now.
  const control::WheelPower& Held() const { return held_; }

 private:
  struct Byte {
    double arrives_s;
    char value;
  };

  void Enqueue(double at_s, const std::string& line);
  double NextListening_s() const;
  void Listen(double now_s);
  void Understand(const std::string& line, double now_s);
  void Hold(double until_s);
  double SilentAfter_s() const;

  LinkOptions options_;
  statistics::CounterRandom noise_;
  std::deque<Byte> in_flight_;
  std::string partial_line_;
  double line_free_s_ = 0.0;
  double next_poll_s_;
  double now_s_ = 0.0;
  double understood_s_ = 0.0;
  std::uint64_t lines_sent_ = 0;
  std::uint64_t polls_ = 0;
  double phase_s_;
  double connected_s_ = 0.0;  ///< lines sent before are lost
  control::WheelPower held_, integral_;
};

}  // namespace rift::simulation
