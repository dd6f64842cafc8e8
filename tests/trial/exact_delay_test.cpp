// A log whose yaw rate answers known commands exactly, by a known delay, gain and bias.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "rift/trial/loop_delay.hpp"

namespace rift::trial {
namespace {

constexpr double kTwoPi = 6.283185307179586;

/// Steering (right minus left) that changes every 0.35 s, and what a heading makes of it.
double SteeringAt(double t_s) {
  if (t_s < 0.0) return 0.0;
  const double values[] = {0.2, -0.1, 0.3, 0.0, -0.25, 0.1, 0.4, -0.3};
  return values[static_cast<size_t>(t_s / 0.35) % 8];
}

struct Made {
  trajectory::Trajectory log;
  std::vector<SentCommand> sent;
};

/// Ten seconds at 20 Hz, 0.2 m/s, from `starts_s` on the clock.
Made Answering(double lag_s, double gain, double bias, double starts_s = 100.0) {
  Made made;
  for (int i = 0; i * 0.35 < 10.0; ++i) {
    const double t_s = 0.35 * i, half = 0.5 * SteeringAt(t_s + 1e-6);
    made.sent.push_back({starts_s + t_s, {0.3 - half, 0.3 + half}});
  }
  double yaw_rad = 3.0;  // it passes half a turn
  constexpr double kStep_s = 1e-3;
  for (int i = 0; i <= 10'000; ++i) {
    const double t_s = i * kStep_s;
    if (i % 50 == 0) {
      made.log.poses.push_back(
          {.t_s = starts_s + t_s, .x_m = 0.2 * t_s, .yaw_rad = std::remainder(yaw_rad, kTwoPi)});
    }
    yaw_rad += kStep_s * (gain * SteeringAt(t_s + 0.5 * kStep_s - lag_s) + bias);
  }
  return made;
}

TEST_CASE("A command's delay, gain and bias are found as they are") {
  for (const double lag_s : {0.0, 0.12, 0.3}) {
    const Made made = Answering(lag_s, 5.0, 0.2);
    const LoopDelay found =
        EstimateCommandDelay(made.log, made.sent, {.max_lag_s = 0.6, .lag_step_s = 0.02});
    INFO(lag_s);
    CHECK(found.lag_s == Approx(lag_s).margin(0.005));
    CHECK(found.gain_rad_s == Approx(5.0).epsilon(0.02));
    CHECK(found.bias_rad_s == Approx(0.2).margin(0.02));
    CHECK(found.r2 > 0.99);
    REQUIRE(found.lags_s.size() == 31);
    CHECK(found.lags_s[30] == Approx(0.6));
    CHECK(found.r2_at_lag.size() == 31);
  }
}

TEST_CASE(
    "Between the lags that are tried the delay is where a parabola through three is highest") {
  for (const double lag_s : {0.107, 0.113, 0.129}) {
    const Made made = Answering(lag_s, 5.0, 0.2);
    const LoopDelay found =
        EstimateCommandDelay(made.log, made.sent, {.max_lag_s = 0.3, .lag_step_s = 0.02});
    size_t best = 0;
    for (size_t i = 0; i < found.r2_at_lag.size(); ++i) {
      if (found.r2_at_lag[i] > found.r2_at_lag[best]) best = i;
    }
    REQUIRE((best > 0 && best + 1 < found.r2_at_lag.size()));
    // Through any three points (Numerical Recipes, 10.3.1).
    const double a = found.lags_s[best - 1], b = found.lags_s[best], c = found.lags_s[best + 1];
    const double of_a = found.r2_at_lag[best - 1], of_b = found.r2_at_lag[best],
                 of_c = found.r2_at_lag[best + 1];
    const double top_s =
        b - 0.5 * ((b - a) * (b - a) * (of_b - of_c) - (b - c) * (b - c) * (of_b - of_a)) /
                ((b - a) * (of_b - of_c) - (b - c) * (of_b - of_a));
    CHECK(found.lag_s == Approx(top_s).margin(1e-9));
    CHECK(std::abs(found.lag_s - b) > 1e-3);
  }
}

TEST_CASE("What a robot does after its last waypoint tells no loop delay") {
  trajectory::Trajectory log;  // 10 mm a row; the last waypoint counts as reached in row 95
  for (int i = 0; i <= 150; ++i) {
    log.poses.push_back({.t_s = 0.05 * i, .x_m = 0.001 + 0.01 * i, .yaw_rad = 0.0});
  }
  const std::vector<control::Waypoint> way{{.name = "a"}, {.name = "b", .x_m = 1.0}};
  control::NavigatorOptions navigator;
  navigator.reach_radius_m = 0.05;
  CHECK(EstimateLoopDelay(log, way, navigator, {.moved_m = 0.0}).intervals == 95);
}

TEST_CASE("Steering that turns the robot the other way explains nothing at its delay") {
  const Made made = Answering(0.12, -5.0, 0.0);
  const LoopDelay found =
      EstimateCommandDelay(made.log, made.sent, {.max_lag_s = 0.2, .lag_step_s = 0.02});
  CHECK(found.r2_at_lag[6] == 0.0);
  const Made still = Answering(0.12, 0.0, 0.0);
  const LoopDelay none = EstimateCommandDelay(still.log, still.sent);
  CHECK(none.lag_s == -1.0);
  CHECK(none.r2 == 0.0);
}

TEST_CASE("A log counts from where the robot has moved so far on") {
  const Made made = Answering(0.1, 5.0, 0.0);
  const auto intervals = [&](double moved_m) {
    return EstimateCommandDelay(made.log, made.sent, {.moved_m = moved_m}).intervals;
  };
  CHECK(intervals(0.0) == 200);
  CHECK(intervals(0.4995) == 150);  // 0.01 m a row
  CHECK(intervals(1.0005) == 99);
}

TEST_CASE("Lags must step, logs must have rows and a yaw, and commands must be there") {
  Made made = Answering(0.1, 5.0, 0.0);
  const auto refusal = [&](const LoopDelayOptions& options) -> std::string {
    try {
      EstimateCommandDelay(made.log, made.sent, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal({.lag_step_s = 0.0}).starts_with("lag_step_s is 0 and max_lag_s"));
  CHECK(refusal({.max_lag_s = -0.1}).find("max_lag_s -0.1") != std::string::npos);
  CHECK(refusal({.max_lag_s = 0.0}).empty());
  CHECK(refusal({.moved_m = 1.92}) ==
        "the loop delay needs 10 intervals in motion, and the log has 8");
  const auto log = made.log;
  made.log.poses.resize(10);
  CHECK(refusal({}) == "the loop delay needs yaw and more than 10 poses, and the log has 10");
  made.log = log;
  made.log.poses[5].yaw_rad = std::nan("");
  CHECK(refusal({}) ==
        "the loop delay needs yaw and more than 10 poses, and the log has 201 without yaw");
  made.log = log;
  made.sent.clear();
  CHECK(refusal({}) == "the loop delay needs commands, and none was sent");
}

TEST_CASE("By default lags up to 0.6 s are tried every 10 ms, from 20 mm on") {
  const LoopDelayOptions options;
  CHECK(options.max_lag_s == 0.6);
  CHECK(options.lag_step_s == 0.01);
  CHECK(options.moved_m == 0.02);
  const Made made = Answering(0.1, 5.0, 0.0);
  const LoopDelay found = EstimateCommandDelay(made.log, made.sent);
  REQUIRE(found.lags_s.size() == 61);
  CHECK(found.lags_s[1] == 0.01);
  CHECK(found.lags_s[60] == Approx(0.6));
}

}  // namespace
}  // namespace rift::trial
