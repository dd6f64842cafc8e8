#include "rift/trial/loop_delay.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "rift/trial/trial.hpp"
#include "support/inputs/fake_robot.hpp"
#include "support/inputs/paper_waypoints.hpp"
#include "support/inputs/trials.hpp"

namespace rift::trial {
namespace {

trajectory::Trajectory Log(double command_delay_s, double sensing_delay_s) {
  test::FakeRobotOptions options;
  options.world_from_start = control::StartPose(test::PaperWaypoints());
  options.command_delay_s = command_delay_s;
  options.sensing_delay_s = sensing_delay_s;
  options.frame_period_s = 0.06;  // three control periods: every picture is as old as the next
  test::FakeRobot robot(options);
  TrialOptions trial;
  trial.pace = Pace::kNewPose;
  const TrialResult result = RunTrial(robot, test::PaperWaypoints(), {}, trial);
  REQUIRE(result.outcome == Outcome::kReached);
  return result.trajectory;
}

LoopDelay Estimate(const trajectory::Trajectory& log) {
  return EstimateLoopDelay(log, test::PaperWaypoints(), {});
}

TEST_CASE("The loop delay of a simulated log is found whatever its share of sensing") {
  for (const double sensing_delay_s : {0.0, 0.1}) {
    for (const double command_delay_s : {0.0, 0.1, 0.22}) {
      const LoopDelay delay = Estimate(Log(command_delay_s, sensing_delay_s));
      INFO("sensing " << sensing_delay_s << ", command " << command_delay_s << ", found "
                      << delay.lag_s << " with R2 " << delay.r2 << ", gain " << delay.gain_rad_s);
      CHECK(delay.lag_s == Approx(sensing_delay_s + command_delay_s).margin(0.004));
      CHECK(delay.r2 > 0.98);
      CHECK(delay.gain_rad_s == Approx(1.2064 / 0.083).epsilon(0.03));
      CHECK(std::abs(delay.bias_rad_s) < 0.05);
    }
  }
}

TEST_CASE("The curve of R2 has one value a lag and its peak where the delay is") {
  const LoopDelay delay = Estimate(Log(0.22, 0.1));
  REQUIRE(delay.lags_s.size() == 61);
  REQUIRE(delay.r2_at_lag.size() == 61);
  CHECK(delay.r2_at_lag[0] < 0.5 * delay.r2);
  CHECK(*std::max_element(delay.r2_at_lag.begin(), delay.r2_at_lag.end()) ==
        Approx(delay.r2).margin(0.02));
}

TEST_CASE("A log without yaw or without motion is refused") {
  trajectory::Trajectory log = Log(0.1, 0.0);
  trajectory::Trajectory still = log;
  for (trajectory::StampedPose& pose : still.poses) pose.x_m = pose.y_m = 0.0;
  CHECK_THROWS_WITH(Estimate(still), Catch::Contains("intervals in motion"));
  log.poses[3].yaw_rad = trajectory::StampedPose::kNotLogged;
  CHECK_THROWS_WITH(Estimate(log), Catch::Contains("without yaw"));
}

/// The Webots rows carry wall-clock times of an unsteady host; their steps are all alike.
LoopDelay EstimateTrial(test::TrialLog trial, double row_period_s) {
  control::NavigatorOptions options;
  options.v_min = trial.v_min;
  options.v_max = trial.v_max;
  for (size_t i = 0; row_period_s > 0.0 && i < trial.log.poses.size(); ++i) {
    trial.log.poses[i].t_s = row_period_s * static_cast<double>(i);
  }
  return EstimateLoopDelay(trial.log, test::PaperWaypoints(), options);
}

struct Medians {
  double lag_s = 0.0, r2 = 0.0, r2_at_zero = 0.0, gain_rad_s = 0.0;
};

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

Medians SurfaceMedians(const std::vector<test::TrialLog>& trials, double row_period_s) {
  std::vector<double> lags_s, r2, r2_at_zero, gains_rad_s;
  for (const test::TrialLog& trial : trials) {
    const LoopDelay delay = EstimateTrial(trial, row_period_s);
    lags_s.push_back(delay.lag_s);
    r2.push_back(delay.r2);
    r2_at_zero.push_back(delay.r2_at_lag[0]);
    gains_rad_s.push_back(delay.gain_rad_s);
  }
  return {Median(lags_s), Median(r2), Median(r2_at_zero), Median(gains_rad_s)};
}

TEST_CASE("The authors' robot answers its steering about 0.32 s late on every surface") {
  RIFT_SKIP_WITHOUT_TRIALS();
  for (const std::string surface : {"ground", "cardboard", "parchment", "downhill", "bump"}) {
    const auto trials = test::LogsOn(surface, trajectory::Format::kTracker);
    const Medians medians = SurfaceMedians(trials, 0.0);
    INFO(surface << ": lag " << medians.lag_s << " s, R2 " << medians.r2 << ", at zero "
                 << medians.r2_at_zero << ", gain " << medians.gain_rad_s);
    CHECK(medians.lag_s == Approx(0.32).margin(0.04));
    CHECK(medians.r2 > 0.4);
    CHECK(medians.r2_at_zero < 0.25);
  }
}

TEST_CASE("The authors' simulator answers its steering at once") {
  RIFT_SKIP_WITHOUT_TRIALS();
  for (const std::string surface : {"ground", "cardboard", "parchment"}) {
    const auto trials = test::LogsOn(surface, trajectory::Format::kWebots);
    const Medians medians = SurfaceMedians(trials, 0.032);
    INFO(surface << ": lag " << medians.lag_s << " s, R2 " << medians.r2 << ", gain "
                 << medians.gain_rad_s);
    CHECK(medians.lag_s < 0.01);
    CHECK(medians.r2 > (surface == "parchment" ? 0.45 : 0.85));  // on parchment it slips
  }
}

}  // namespace
}  // namespace rift::trial
