#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rift/hardware/robot_link.hpp"

namespace rift::hardware {

/// What the robot's counts of its wheels say by themselves: whether the wheels rest, and whether
/// the counts began anew. Knows no clock.
class CountWatch {
 public:
  /// `m_per_count`: what a wheel rolls for each.
  explicit CountWatch(double m_per_count) : m_per_count_(m_per_count) {}

  /// A command that was sent. Times must rise.
  void SeeCommand(const MilliPower& power, double sent_s);
  /// Counts that the robot had at `read_s`; times must rise. What is wrong with them, in one line:
  /// a wheel that was only ever told to go one way has gone the other way by too much.
  std::optional<std::string> SeeCounts(std::int32_t left, std::int32_t right, double read_s);
  /// Whether the last readings are the same, but for a count to each side.
  bool Rest() const;

 private:
  struct Wheel {
    std::int32_t counts = 0;
    std::int32_t rest_counts = 0;  ///< those that it rests at
    double forward_s = -1e9;       ///< when it was last told so
    double backward_s = -1e9;
    int power = 0;  ///< in force
  };

  static void SeePower(Wheel& wheel, int power, double sent_s);
  std::optional<std::string> CheckWheel(const Wheel& wheel, std::int32_t counts, double read_s,
                                        const char* name) const;

  double m_per_count_;
  Wheel left_, right_;
  std::optional<double> read_s_;
  double moved_s_ = 0.0;
};

}  // namespace rift::hardware
