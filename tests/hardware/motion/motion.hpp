#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hardware/motion_check.hpp"
#include "rift/geometry/pose2.hpp"

namespace rift::hardware {

inline constexpr double kTrack_m = 0.09;

/// What wheels and poses do over time.
struct Motion {
  std::function<std::pair<double, double>(double)> wheels_m = [](double) {
    return std::pair(0.0, 0.0);
  };
  std::function<geometry::Pose2(double)> pose = [](double) { return geometry::Pose2{}; };
  /// Since when the picture is the same.
  std::function<std::optional<double>(double)> repeats_since_s = [](double) {
    return std::optional<double>();
  };
  EvidenceOptions options{};
  std::optional<double> latency_s = 0.0;  ///< none: not measured
  bool is_measured = true;                ///< the wheels, by encoders
  double late_s = 0.0;                    ///< of the poses
  std::vector<double> times_s{};          ///< of the pictures
};

inline std::vector<double> Every(double period_s, double end_s = 3.0) {
  std::vector<double> times_s;
  for (int i = 0; period_s * i < end_s; ++i) times_s.push_back(period_s * i);
  return times_s;
}

struct Found {
  double t_s = 0.0;
  StopReason reason = StopReason::kFinished;
  std::string text;
};

/// The first contradiction that is found; kFinished: none.
inline Found StopOf(const Motion& motion) {
  MotionCheck check(motion.options, kTrack_m);
  if (motion.latency_s) check.SetLatency(*motion.latency_s);
  for (const double t_s : motion.times_s) {
    const auto [left_m, right_m] = motion.wheels_m(t_s);
    check.SeeWheels({t_s, left_m, right_m}, motion.is_measured);
    const double seen_s = t_s - motion.late_s;
    std::optional<double> repeats_s = motion.repeats_since_s(seen_s);
    if (repeats_s) *repeats_s += motion.late_s;
    check.SeePose({t_s, motion.pose(seen_s), 0.0, 0.0, 0.0}, repeats_s);
    if (const auto found = check.Check()) return {seen_s, found->reason, found->text};
  }
  return {};
}

}  // namespace rift::hardware
