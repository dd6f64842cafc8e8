// Numbers of drives and of predicted motions that no hand works out, beside those that were
// approved: a change of any of them is a difference that somebody reads.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "rift/statistics/random.hpp"
#include "rift/sweep/calibrate/drive_features.hpp"
#include "rift/sweep/calibrate/error_structure.hpp"
#include "rift/sweep/calibrate/short_horizon.hpp"
#include "support/pinned.hpp"
#include "sweep/calibrate/drive_measures.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// A robot that waits, turns, weaves with `period_m` and slows down behind each of two waypoints,
/// seen with noise at uneven times.
Trajectory Drive(std::uint64_t seed, double period_m, double wait_s) {
  statistics::Random random(seed, 1);
  Trajectory log;
  double way_m = 0.0, t_s = 5.0;
  for (int i = 0; i < 150; ++i) {
    const double interval_s = 0.045 + 0.01 * random.Uniform() + (i % 7 == 0 ? 0.02 : 0.0);
    t_s += interval_s;
    const bool is_slow = (way_m > 0.62 && way_m < 0.68) || (way_m > 1.22 && way_m < 1.26);
    if (t_s > 5.0 + wait_s) way_m += interval_s * (is_slow ? 0.1 : 0.3 + 0.03 * std::sin(9 * t_s));
    const double angle = 6.283185307179586 * way_m / period_m;
    const double heading_rad = 0.3 * std::sin(angle);
    log.poses.push_back(
        {.t_s = t_s,
         .x_m = 0.7 + way_m + 4e-4 * random.Normal(),
         .y_m = -0.2 - 0.3 * period_m / 6.2832 * std::cos(angle) + 4e-4 * random.Normal(),
         .yaw_rad = 3.1 + heading_rad + 3e-3 * random.Normal(),
         .target_x_m = way_m < 0.6   ? 1.3
                       : way_m < 1.2 ? 1.9
                                     : 2.5,
         .target_y_m = -0.22});
  }
  return log;
}

TEST_CASE("Features of drives with noise, weaves and stops are those that were approved") {
  std::string text;
  for (const auto& [period_m, wait_s] : {std::pair{0.25, 0.9}, {0.6, 0.45}, {0.11, 1.3}}) {
    const Trajectory log = Drive(3, period_m, wait_s);
    text += fmt::format("a weave of {} m\n", period_m);
    const std::vector<double> values = FeaturesOf(log, {});
    for (size_t i = 0; i < values.size(); ++i) {
      text += fmt::format("  {} {:.10g}\n", DriveFeatures()[i].name, values[i]);
    }
    const gap::LikenessOptions options;
    const DriveMeasures measures(log, options);
    text += fmt::format("  first {} passed {} rest {:.10g} {:.10g}\n", measures.first,
                        fmt::join(measures.passed, " "), measures.rest_m.x(), measures.rest_m.y());
  }
  CHECK(test::DifferenceFromPinned("sweep/drive_features.txt", text) == "");
}

TEST_CASE("Errors of predicted motions, and their structure, are those that were approved") {
  SimulatedTrial robot{
      .task =
          std::vector<control::Waypoint>{
              {.name = "a"}, {.name = "b", .x_m = 0.5}, {.name = "c", .x_m = 0.6, .y_m = 0.4}},
      .seed = 5};
  std::vector<CalibrationLog> logs(2);
  logs[0].log = Simulate(robot).result.trajectory;
  robot.start.yaw_rad = 0.3;
  logs[1].log = Simulate(robot).result.trajectory;
  for (auto& pose : logs[1].log.poses) pose.t_s += 100.0;
  std::string text;
  for (const double period_s : {0.0, 0.04, 0.07}) {
    const auto twin = [&](size_t log, const std::vector<double>& values) {
      SimulatedTrial one = robot;
      one.seed = 70 + log;
      one.start.yaw_rad = log == 0 ? 0.0 : 0.3;
      one.simulation.motor.mismatch = values[0];
      one.simulation.mocap.tag_ahead_m = 0.01;
      if (period_s > 0.0) one.simulation.mocap.host_period_s = period_s;
      return one;
    };
    const ShortHorizonOptions horizon{.most_frames = 3, .phases = 2, .moved_m = 0.05};
    const auto errors = ShortHorizonErrors(twin(1, {0.04}), logs[1].log, horizon);
    text += fmt::format("host every {} s, {} motions\n", period_s, errors.size());
    for (size_t i = 0; i < errors.size(); i += 37) {
      text += fmt::format("  {} {}: {:.9f} {:.9f} {:.9f}\n", errors[i].from, errors[i].frames,
                          errors[i].ahead_m, errors[i].left_m, errors[i].turned_rad);
    }
    const ErrorStructure found = StructureOfErrors(logs, twin, {0.04}, horizon);
    text += fmt::format("  lag {:.9f} frequency {:.9f} share {:.9f} left {:.9f} right {:.9f}\n",
                        found.lag_s, found.frequency_hz, found.frequency_share,
                        found.turning_left_rad, found.turning_right_rad);
  }
  CHECK(test::DifferenceFromPinned("sweep/short_horizon.txt", text) == "");
}

}  // namespace
}  // namespace rift::sweep
