#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rift/hardware/robot_link.hpp"

namespace rift::hardware {

/// What the robot's counts of its wheels say by themselves: whether the wheels rest, whether the
/// counts began anew, and whether wheels turn that were told to stand. Knows no clock.
class CountWatch {
 public:
  /// `m_per_count`: what a wheel rolls for each.
  explicit CountWatch(double m_per_count) : m_per_count_(m_per_count) {}

  /// A command that was sent. Times must rise.
  void SeeCommand(const MilliPower& power, double sent_s);
  /// Counts that the robot had at `read_s`; times must rise. What is wrong with them, in one line:
  /// a wheel that was only ever told to go one way has gone the other way by too much.
  std::optional<std::string> SeeCounts(std::int32_t left, std::int32_t right, double read_s);
  /// What is wrong with the last reading, in one line: a wheel that was told to stand, and has had
  /// the time to, turns.
  std::optional<std::string> CheckStanding() const;
  /// Until `now_s` the robot may have been carried: wheels are watched as if told to stand then.
  void Restart(double now_s);
  /// Whether the last readings are the same, but for a count to each side.
  bool Rest() const;

 private:
  struct Wheel {
    std::int32_t counts = 0;
    std::int32_t rest_counts = 0;  ///< those that it rests at
    double forward_s = -1e9;       ///< when it was last told so
    double backward_s = -1e9;
    int power = 0;                                ///< in force
    std::optional<double> stands_since_s;         ///< as it was told
    std::optional<std::int32_t> standing_counts;  ///< when it had come to rest
  };

  static void SeePower(Wheel& wheel, int power, double sent_s);
  static void SeeWheel(Wheel& wheel, std::int32_t counts, double read_s);
  std::optional<std::string> CheckWheel(const Wheel& wheel, std::int32_t counts, double read_s,
                                        const char* name) const;
  std::optional<std::string> CheckStandingWheel(const Wheel& wheel, const char* name) const;

  double m_per_count_;
  Wheel left_, right_;
  std::optional<double> read_s_;
  double moved_s_ = 0.0;
};

}  // namespace rift::hardware
