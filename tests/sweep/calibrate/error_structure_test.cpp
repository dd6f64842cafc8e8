// The shape of errors of robots that drive any way: about half a turn the yaw leaps.
#include "rift/sweep/calibrate/error_structure.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/inputs/paths.hpp"

namespace rift::sweep {
namespace {

/// Weaves along a line from the origin in that direction, seen exactly.
SimulatedTrial Along(double direction_rad, double delay_s) {
  SimulatedTrial trial{
      .task = std::vector<control::Waypoint>{{.name = "a"},
                                             {.name = "b",
                                              .x_m = 1.5 * std::cos(direction_rad),
                                              .y_m = 1.5 * std::sin(direction_rad)}},
      .start = {0.0, 0.0, direction_rad + 0.3},
      .seed = 5};
  simulation::MocapOptions& mocap = trial.simulation.mocap;
  mocap.noise_across_m = mocap.noise_along_m = mocap.noise_yaw_rad = 0.0;
  mocap.blur_across_s = mocap.stamp_jitter_s = mocap.blur_yaw_rad_per_mps = 0.0;
  trial.simulation.link.delay_s = delay_s;
  return trial;
}

TEST_CASE("Errors about half a turn have the structure that they have about none") {
  const trajectory::Trajectory log = Simulate(Along(0.0, 0.05)).result.trajectory;
  const auto structure = [&log](double direction_rad) {
    trajectory::Trajectory turned = test::Moved(log, {0.0, 0.0, direction_rad});
    size_t leaps = 0;
    for (size_t i = 0; i < turned.poses.size(); ++i) {
      double& yaw_rad = turned.poses[i].yaw_rad;
      yaw_rad = std::remainder(yaw_rad, 2.0 * std::numbers::pi);
      leaps += i > 0 && std::abs(yaw_rad - turned.poses[i - 1].yaw_rad) > 3.0;
    }
    CHECK((leaps > 4) == (direction_rad != 0.0));
    const auto twin = [&](size_t, const std::vector<double>&) {
      return Along(direction_rad, 0.15);
    };
    return StructureOfErrors({{.name = "1", .log = turned}}, twin, {},
                             {.most_frames = 3, .phases = 2, .moved_m = 0.05});
  };
  const ErrorStructure none = structure(0.0);
  for (const double half_turn : {3.04, 3.09, std::numbers::pi, -3.04}) {
    const ErrorStructure half = structure(half_turn);
    CHECK(half.motions == none.motions);
    CHECK(half.lag_s == Approx(none.lag_s).margin(1e-6));
    CHECK(half.turned_rad == Approx(none.turned_rad).epsilon(1e-3));
    CHECK(half.ahead_m == Approx(none.ahead_m).epsilon(1e-3));
    CHECK(half.left_m == Approx(none.left_m).epsilon(1e-3));
    CHECK(half.turning_left_rad == Approx(none.turning_left_rad).epsilon(1e-3));
    CHECK(half.turning_right_rad == Approx(none.turning_right_rad).epsilon(1e-3));
    CHECK(half.frequency_hz == Approx(none.frequency_hz));
    CHECK(half.frequency_share == Approx(none.frequency_share).epsilon(1e-3));
  }
  CHECK(std::abs(none.lag_s) > 0.05);
}

TEST_CASE("A simulator that turns later than the log lags, an earlier one leads, up to 0.3 s") {
  const auto lag_s = [](double of_log_s, double of_twin_s) {
    const trajectory::Trajectory log = Simulate(Along(0.0, of_log_s)).result.trajectory;
    const auto twin = [&](size_t, const std::vector<double>&) { return Along(0.0, of_twin_s); };
    return StructureOfErrors({{.name = "1", .log = log}}, twin, {},
                             {.most_frames = 3, .phases = 1, .moved_m = 0.05})
        .lag_s;
  };
  CHECK(lag_s(0.05, 0.15) == Approx(0.12).margin(0.07));
  CHECK(lag_s(0.15, 0.05) == Approx(-0.12).margin(0.07));
  CHECK(lag_s(0.05, 0.31) == Approx(0.26).margin(0.045));
  CHECK(std::abs(lag_s(0.05, 0.55)) < 0.3 + 1e-9);
}

/// Never steers: it is the log that turns.
SimulatedTrial Straight() {
  SimulatedTrial trial = Along(0.0, 0.05);
  trial.start = {};
  trial.control.heading = {0.0, 0.0, 0.0};
  trial.control.w_min = 0.0;
  return trial;
}

/// Rows 0.24 s apart between which it turns by so much.
trajectory::Trajectory Turning(const std::vector<double>& turns_rad) {
  trajectory::Trajectory log{.poses = {{.t_s = 0.0, .x_m = 0.0, .yaw_rad = 0.0}}};
  for (const double turn_rad : turns_rad) {
    const trajectory::StampedPose& last = log.poses.back();
    log.poses.push_back(
        {.t_s = last.t_s + 0.24, .x_m = last.x_m + 0.03, .yaw_rad = last.yaw_rad + turn_rad});
  }
  return log;
}

ErrorStructure OfTurns(const std::vector<std::vector<double>>& turns_rad, int frames = 1) {
  std::vector<CalibrationLog> logs;
  for (const std::vector<double>& turns : turns_rad) {
    logs.push_back({.name = std::to_string(logs.size()), .log = Turning(turns)});
  }
  const auto twin = [](size_t, const std::vector<double>&) { return Straight(); };
  return StructureOfErrors(logs, twin, {}, {.most_frames = frames, .phases = 1, .moved_m = 0.0});
}

TEST_CASE("Two motions have the fastest wave that a horizon can see, and no lag without turns") {
  const ErrorStructure found = OfTurns({{0.25, -0.125}});
  CHECK(found.motions == 2);
  CHECK(found.horizon_s == Approx(0.24));
  CHECK(found.turned_bias_rad == Approx(-0.0625));  // of -0.25 and 0.125
  CHECK(found.turned_rad == Approx(std::sqrt(0.5 * (0.25 * 0.25 + 0.125 * 0.125))));
  // Two errors alternate at 1 / (2 * 0.24 s) = 2.083 Hz: of steps of 0.05 Hz below that the last.
  // The wave through them has twice their variance, and no more than all of it is told.
  CHECK(found.frequency_hz == Approx(2.05));
  CHECK(found.frequency_share == 1.0);
  CHECK(std::isnan(found.lag_s));  // a simulator that does not turn follows no turn
}

/// The largest share of the variance of any wave, by sines and cosines.
double LargestShare(const std::vector<std::vector<double>>& errors, double limit_hz) {
  double n = 0.0, mean = 0.0, variance = 0.0, largest = 0.0;
  for (const std::vector<double>& log : errors) {
    for (const double error : log) n += 1.0, mean += error;
  }
  mean /= n;
  for (const std::vector<double>& log : errors) {
    for (const double error : log) variance += (error - mean) * (error - mean);
  }
  for (int step = 0; 0.2 + 0.05 * step <= limit_hz; ++step) {
    double power = 0.0;
    for (const std::vector<double>& log : errors) {
      double sines = 0.0, cosines = 0.0;
      for (size_t i = 0; i < log.size(); ++i) {
        const double angle =
            2.0 * std::numbers::pi * (0.2 + 0.05 * step) * 0.24 * static_cast<double>(i);
        sines += (log[i] - mean) * std::sin(angle), cosines += (log[i] - mean) * std::cos(angle);
      }
      power += 2.0 * (sines * sines + cosines * cosines) / static_cast<double>(log.size());
    }
    largest = std::max(largest, power);
  }
  return largest / variance;
}

TEST_CASE("The strongest wave is that of all logs, each by its number of motions") {
  const std::vector<std::vector<double>> turns{
      {0.1, -0.2, 0.16, 0.07, -0.11, -0.05, 0.2, 0.03}, {0.05}, {-0.02, 0.12, 0.09, -0.15, 0.01}};
  std::vector<std::vector<double>> errors = turns;
  for (std::vector<double>& log : errors) {
    for (double& error : log) error = -error;
  }
  const double share = LargestShare(errors, 0.5 / 0.24);
  REQUIRE(share < 0.9);
  const ErrorStructure found = OfTurns(turns);
  CHECK(found.motions == 14);
  CHECK(found.frequency_share == Approx(share).epsilon(1e-6));
  // A log that is too short for the longest horizon has no say.
  const ErrorStructure two = OfTurns({turns[0], turns[2]}, 2);
  const ErrorStructure with_short = OfTurns(turns, 2);
  CHECK(two.motions == 11);
  CHECK(with_short.motions == 11);
  CHECK(two.frequency_share > 0.0);
  CHECK(with_short.frequency_share == Approx(two.frequency_share));
  CHECK(with_short.frequency_hz == Approx(two.frequency_hz));
}

}  // namespace
}  // namespace rift::sweep
