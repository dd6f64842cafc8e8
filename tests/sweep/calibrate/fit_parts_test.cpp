// Parts of a fit: scales, weights, traits, series of numbers, lengths, detours.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "rift/statistics/descriptive.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/sweep/calibrate/prediction.hpp"
#include "rift/sweep/calibrate/repeated_trial.hpp"
#include "support/inputs/paths.hpp"
#include "sweep/calibrate/drive_measures.hpp"
#include "sweep/calibrate/errors.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

LogErrors Errors(const std::vector<int>& frames, const std::vector<double>& motions) {
  LogErrors errors{.frames = frames};
  errors.motions = Eigen::VectorXd(static_cast<Eigen::Index>(motions.size()));
  for (size_t i = 0; i < motions.size(); ++i) errors.motions[static_cast<int>(i)] = motions[i];
  errors.traits = Eigen::VectorXd::Zero(kTraits + 1);
  return errors;
}

TEST_CASE("The scale of an error is the scatter of its kind and channel over all logs") {
  // No outliers here: the root mean square.
  CalibrationOptions options;
  options.horizon.most_frames = 3;
  const std::vector<LogErrors> errors{
      Errors({1, 2, 1}, {1.0, -10.0, 0.1, 7.0, 70.0, 0.7, -3.0, 30.0, 0.3}),
      Errors({1}, {2.0, 20.0, -0.2})};
  const Eigen::MatrixXd scale = ScaleOf(errors, options);
  REQUIRE(scale.rows() == 3);
  REQUIRE(scale.cols() == 3);
  CHECK(scale(0, 0) == Approx(std::sqrt(14.0 / 3.0)));
  CHECK(scale(0, 1) == Approx(std::sqrt(1400.0 / 3.0)));
  CHECK(scale(0, 2) == Approx(std::sqrt(0.14 / 3.0)));
  CHECK(scale(1, 0) == Approx(7.0));
  CHECK(scale(1, 2) == Approx(0.7));
  CHECK(scale(2, 0) == 1.0);  // none of three frames
  CHECK(ScaleOf({Errors({1}, {0.0, 0.0, 0.0})}, options)(0, 0) == 1e-9);
}

TEST_CASE("An outlier adds to the scale in proportion, and the deviance is least at that scale") {
  CalibrationOptions options;
  options.horizon.most_frames = 1;
  options.outlier_sd = 3.0;
  std::vector<LogErrors> errors(1);
  std::vector<double> motions;
  for (int i = 0; i < 9; ++i) motions.insert(motions.end(), {i % 2 == 0 ? 1.0 : -1.0, 0.0, 0.0});
  motions.insert(motions.end(), {30.0, 0.0, 0.0});
  errors[0] = Errors(std::vector<int>(10, 1), motions);
  // (9 / s^2 + 3 * 30 / s) / 10 = 1
  const double s = 0.5 * (9.0 + std::sqrt(81.0 + 3.6));
  CHECK(ScaleOf(errors, options)(0, 0) == Approx(s));
  const auto deviance = [&](double scale) {
    const double squares = 9.0 / (scale * scale) + 3.0 * (2.0 * 30.0 / scale - 3.0);
    return squares + 20.0 * std::log(scale);
  };
  const double floors = 40.0 * std::log(1e-9);  // of the two channels without errors
  CHECK(Deviance(errors, options) == Approx(deviance(s) + floors));
  for (const double other : {0.9 * s, 1.1 * s}) CHECK(deviance(other) > deviance(s) + 0.05);
}

TEST_CASE("Errors that grow never lower the deviance, whatever they do to their median") {
  CalibrationOptions options;
  options.horizon.most_frames = 1;
  // Half of the errors go down to a tenth, the others up tenfold: their median says a better fit.
  const std::vector<LogErrors> before{
      Errors(std::vector<int>(5, 1),
             {1.0, 1.0, 1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0})};
  const std::vector<LogErrors> after{Errors(
      std::vector<int>(5, 1),
      {0.1, 0.1, 0.1, -0.1, -0.1, -0.1, 0.1, 0.1, 0.1, -10.0, -10.0, -10.0, 10.0, 10.0, 10.0})};
  CHECK(Deviance(after, options) > Deviance(before, options) + 10.0);
}

TEST_CASE(
    "Errors count over their scale, motions by their number of frames, traits by their weight") {
  CalibrationOptions options;
  options.horizon.most_frames = 4;
  options.likeness_weight = 9.0;
  options.outlier_sd = 3.0;
  Eigen::MatrixXd scale = Eigen::MatrixXd::Ones(4, 3);
  scale.row(0) << 0.1, 0.2, 0.5;
  scale.row(1) << 1.0, 2.0, 4.0;
  LogErrors errors = Errors({2, 1}, {1.0, 2.0, -4.0, 0.3, -0.2, 0.25});
  errors.traits << 0.5, -1.0, 3.0, 5.0, -15.0;
  const Eigen::VectorXd weighted = Weighted(errors, scale, options);
  REQUIRE(weighted.size() == 11);
  const double expected[] = {0.5, 0.5, -0.5, 1.5, -0.5, 0.25, 1.5, -3.0, 9.0};
  for (int i = 0; i < 9; ++i) CHECK(weighted[i] == Approx(expected[i]));
  // Beyond 3 the square grows in proportion: 3 (2 * 5 - 3) = 21 and 3 (2 * 15 - 3) = 81.
  CHECK(weighted[9] == Approx(3.0 * std::sqrt(21.0)));
  CHECK(weighted[10] == Approx(-3.0 * 9.0));
  // The slope of each is that of its square beyond 3 as well.
  constexpr double kStep = 1e-6;
  LogErrors slope = Errors({2, 1}, {0.7, -1.1, 2.0, 0.05, 0.3, -0.4});
  slope.traits << 1.0, -0.5, 0.25, 2.0, -3.0;
  LogErrors above = errors, below = errors;
  above.motions += kStep * slope.motions;
  above.traits += kStep * slope.traits;
  below.motions -= kStep * slope.motions;
  below.traits -= kStep * slope.traits;
  const Eigen::VectorXd secant =
      (Weighted(above, scale, options) - Weighted(below, scale, options)) / (2.0 * kStep);
  const Eigen::VectorXd weighted_slope = WeightedSlope(errors, slope, scale, options);
  for (int i = 0; i < 11; ++i) {
    INFO(i);
    if (i == 3 || i == 8) continue;  // at 3 the slope beyond begins
    CHECK(weighted_slope[i] == Approx(secant[i]).epsilon(1e-6));
  }
}

TEST_CASE("The mean of traits is over the runs that tell them") {
  CHECK_FALSE(MeanTraits({}));
  CHECK_FALSE(MeanTraits({Traits(), Traits()}));
  const Traits mean = MeanTraits({Traits(Eigen::Vector4d(1.0, 2.0, 3.0, 4.0)), Traits(),
                                  Traits(Eigen::Vector4d(3.0, 2.0, 1.0, 8.0))});
  REQUIRE(mean);
  CHECK(*mean == Eigen::Vector4d(2.0, 2.0, 2.0, 6.0));
}

TEST_CASE("A share is of the values there are") {
  const auto is_large = [](double value) { return value > 2.0; };
  CHECK(ShareOf({1.0, 2.0, 3.0, 4.0}, is_large) == 0.5);
  CHECK(ShareOf({1.0, 2.0, 3.0}, is_large) == Approx(1.0 / 3.0));
  CHECK(std::isnan(ShareOf({}, is_large)));
}

TEST_CASE("A robust scatter is 1.4826 times the median size") {
  CHECK(RobustScatter({-1.0, 2.0, -30.0}) == Approx(1.4826 * 2.0));
  CHECK(RobustScatter({-1.0, 2.0}) == Approx(1.4826 * 1.5));
}

TEST_CASE("An autocorrelation is of deviations from the mean, with at least eight pairs") {
  const std::vector<double> alternating{6, 4, 6, 4, 6, 4, 6, 4, 6, 4};
  CHECK(Autocorrelation(alternating, 0) == Approx(1.0));
  CHECK(Autocorrelation(alternating, 1) == Approx(-0.9));
  CHECK(Autocorrelation(alternating, 2) == Approx(0.8));
  CHECK(std::isnan(Autocorrelation(alternating, 3)));
  CHECK(std::isnan(Autocorrelation(std::vector<double>(20, 1.0), 1)));
  std::vector<double> step(16, 0.0);
  std::fill(step.begin() + 8, step.end(), 1.0);  // all but one of fifteen pairs agree
  CHECK(Autocorrelation(step, 1) == Approx((14.0 - 1.0) / 16.0));
}

TEST_CASE("Two points are as bimodal as can be, even values 5/9, and skewness counts either way") {
  CHECK(Bimodality({1, 1, 3, 3}) == Approx(1.0));
  CHECK(Bimodality({-1, -1, -1, 2}) == Approx(1.0));  // two points, unevenly often
  CHECK(Bimodality({1, 1, 1, -2}) == Approx(1.0));
  std::vector<double> even;
  for (int i = 0; i < 2000; ++i) even.push_back(0.001 * i);
  CHECK(Bimodality(even) == Approx(5.0 / 9.0).epsilon(1e-3));
  CHECK(std::isnan(Bimodality({2.0, 2.0})));
}

Trajectory Line(const std::vector<double>& x_m) {
  Trajectory path;
  for (const double x : x_m) path.poses.push_back({.t_s = x, .x_m = x});
  return path;
}

TEST_CASE("A length by strides counts moves of 20 mm, from where the last one ended") {
  CHECK(LengthByStrides_m(Line({0.0})) == 0.0);
  CHECK(LengthByStrides_m(Line({0.0, 0.019, 0.0, 0.019})) == 0.0);
  CHECK(LengthByStrides_m(Line({0.0, 0.01, 0.02001, 0.03})) == Approx(0.02001));
  CHECK(LengthByStrides_m(Line({0.0, 0.5, 0.1})) == Approx(0.9));
  Trajectory sideways = Line({0.0, 0.0});
  sideways.poses[1].y_m = -0.3;
  CHECK(LengthByStrides_m(sideways) == Approx(0.3));
}

RepeatedTrial Trial(const std::string& setting, double real_m, const std::vector<double>& runs_m) {
  RepeatedTrial trial{.setting = setting, .real = test::StraightPath(real_m, 50)};
  for (const double run_m : runs_m) trial.runs.push_back(test::StraightPath(run_m, 50));
  return trial;
}

TEST_CASE("Runs beyond the longest real path of their setting times the limit are detours") {
  const std::vector<RepeatedTrial> trials = WithoutDetours(
      {Trial("a", 1.0, {1.9, 2.5}), Trial("a", 1.6, {2.5, 1.0}), Trial("b", 0.8, {1.1, 1.3, 9.0})},
      1.5);
  CHECK(trials[0].runs.size() == 1);  // the longest of a is 1.6: up to 2.4
  CHECK(trials[0].circled_runs == 1);
  CHECK(trials[0].failed_runs == 1);
  CHECK(trials[1].runs.size() == 1);
  CHECK(trials[2].runs.size() == 1);
  CHECK(trials[2].circled_runs == 2);
  CHECK(trials[2].failed_runs == 2);
  const auto longest = LongestBySetting_m(std::vector<RepeatedTrial>(trials), &RepeatedTrial::real);
  CHECK(longest.at("a") == Approx(1.6).margin(0.03));
  CHECK(longest.at("b") == Approx(0.8).margin(0.03));
}

/// One metre along x, so far to the left.
Trajectory Lane(double left_m) {
  return test::Moved(test::StraightPath(1.0, 101), {0.0, left_m, 0.0});
}

RepeatedTrial Lanes(const std::string& setting, double real_m, const std::vector<double>& runs_m) {
  RepeatedTrial trial{.setting = setting,
                      .real = Lane(real_m),
                      .waypoints = {{.name = "s"}, {.name = "e", .x_m = 1.0}}};
  for (const double run_m : runs_m) trial.runs.push_back(Lane(run_m));
  return trial;
}

TEST_CASE("A simulator predicts by its mean path, beside what the other real trials would") {
  gap::LikenessOptions options;
  options.bootstrap.resamples = 200;
  std::vector<RepeatedTrial> trials{Lanes("a", 0.00, {0.02, 0.04}), Lanes("a", 0.05, {0.06}),
                                    Lanes("b", 0.10, {0.10, 0.12}), Lanes("c", 0.3, {0.2}),
                                    Lanes("d", 0.3, {})};
  trials[2].other_reals = {Lane(0.13), Lane(0.05)};
  trials[4].other_reals = {Lane(0.13)};  // without a run
  const PathPrediction found = MeasurePrediction(trials, {}, options, 1);
  CHECK(found.reals == 3);  // c has no other real trial
  // Simulated: 0.03, 0.01, 0.01; others: 0.05, 0.05, (0.03 + 0.05) / 2.
  CHECK(found.simulated_m == Approx(0.05 / 3.0));
  CHECK(found.other_real_m == Approx(0.14 / 3.0));
  CHECK(found.difference_m == Approx(-0.03));
  CHECK(found.difference_interval_m.low <= found.difference_m);
  CHECK(found.difference_interval_m.high >= found.difference_m);
  CHECK(std::isnan(MeasurePrediction({trials[3]}, {}, options, 1).simulated_m));
  // Settings are drawn anew: a quarter of the draws hold one of two alone.
  trials[2].runs = {Lane(0.2)};
  const PathPrediction unlike =
      MeasurePrediction({trials[0], trials[1], trials[2]}, {}, options, 1);
  CHECK(unlike.difference_interval_m.low == Approx(-0.03));
  CHECK(unlike.difference_interval_m.high == Approx(0.1 - 0.04));
  CHECK(MeasurePrediction({trials[3]}, {}, options, 1).reals == 0);
}

/// Stands for so many rows before it drives, and jitters by 4 mm.
Trajectory AfterStanding(Trajectory path, int rows) {
  std::vector<trajectory::StampedPose> standing;
  for (int i = 0; i < rows; ++i) {
    standing.push_back(path.poses.front());
    standing.back().t_s += 0.01 * (i - rows);
    standing.back().x_m -= i % 2 == 0 ? 0.004 : 0.0;
  }
  path.poses.insert(path.poses.begin(), standing.begin(), standing.end());
  return path;
}

TEST_CASE("Trimmed runs are averaged after their standstill is left out, however long each is") {
  gap::LikenessOptions options;
  options.bootstrap.resamples = 50;
  std::vector<RepeatedTrial> trials{Lanes("a", 0.00, {0.02, 0.04}), Lanes("a", 0.05, {0.06, 0.08})};
  for (RepeatedTrial& trial : trials) {
    trial.real = AfterStanding(trial.real, 20);
    trial.runs[0] = AfterStanding(trial.runs[0], 100);
  }
  gap::GapOptions gap{.trim_standstill = true, .standstill_radius_m = 0.0095};
  const PathPrediction found = MeasurePrediction(trials, gap, options, 1);
  CHECK(found.simulated_m == Approx((0.03 + 0.02) / 2.0).margin(0.0005));
  CHECK(found.other_real_m == Approx(0.05).margin(0.0005));
  gap.trim_standstill = false;
  CHECK(MeasurePrediction(trials, gap, options, 1).simulated_m > 0.05);
}

TEST_CASE("Settings are ranked by how far their last real trial, its runs, and the others stray") {
  gap::LikenessOptions options;
  options.bootstrap.resamples = 200;
  std::vector<RepeatedTrial> trials;
  const auto add = [&](const char* setting, double real, double run_mean, double other) {
    trials.push_back(Lanes(setting, other, {9.0}));  // not the last: its runs do not count
    trials.push_back(Lanes(setting, real, {run_mean - 0.001, run_mean + 0.001}));
  };
  add("a", 0.01, 0.05, 0.04);
  add("b", 0.02, 0.06, 0.03);
  add("c", 0.03, 0.07, 0.02);
  add("d", 0.04, 0.08, 0.01);
  RankAgreement ranks = MeasureRanks(trials, {}, options, 1);
  CHECK(ranks.settings == 4);
  CHECK(ranks.simulated == Approx(1.0));
  CHECK(ranks.real == Approx(-1.0));
  CHECK(ranks.simulated_interval.low == Approx(1.0));
  CHECK(ranks.real_interval.high == Approx(-1.0));
  trials.back().real = Lane(0.0);  // d now is the least
  ranks = MeasureRanks(trials, {}, options, 1);
  CHECK(ranks.simulated == Approx(-0.2));  // ranks 2 3 4 1 and 1 2 3 4
  CHECK(ranks.real == Approx(0.2));
  trials.back().runs.clear();
  CHECK(MeasureRanks(trials, {}, options, 1).settings == 3);
  trials.back() = Lanes("d", 0.04, {0.08});
  trials.back().waypoints.pop_back();
  CHECK(MeasureRanks(trials, {}, options, 1).settings == 3);
  trials.erase(trials.begin());  // a has no other real trial
  CHECK(MeasureRanks(trials, {}, options, 1).settings == 2);
  CHECK(std::isnan(MeasureRanks(trials, {}, options, 1).simulated));
}

TEST_CASE("Likeness counts every run, those that failed and those that circled") {
  gap::LikenessOptions options;
  options.bootstrap.resamples = 50;
  options.shuffles = 19;
  std::vector<RepeatedTrial> trials;
  for (int i = 0; i < 4; ++i) {
    trials.push_back(Lanes(i < 2 ? "a" : "b", 0.01 * i, {0.01 * i + 0.001}));
  }
  trials[1].failed_runs = 2;
  trials[3].runs.push_back(test::StraightPath(1.8, 50));
  std::mt19937_64 generator(1);
  const DriveLikeness likeness = MeasureDriveLikeness(trials, true, {}, options, generator);
  CHECK(likeness.runs == 4 + 2 + 1);
  CHECK(likeness.failed_runs == 3);
  CHECK(likeness.circled_runs == 1);
  CHECK(likeness.prediction.reals == 4);
  CHECK(likeness.prediction.simulated_m == Approx(0.001));
  CHECK(likeness.prediction.other_real_m == Approx(0.01));
  CHECK(likeness.told_apart.features.size() == DriveFeatures().size());
  CHECK(std::isnan(likeness.loop_delay_s.sim));  // straight ways tell none
}

TEST_CASE(
    "Runs are matched to the real trial that they set out as, or belong to all of a setting") {
  gap::LikenessOptions options;
  options.bootstrap.resamples = 50;
  options.shuffles = 19;
  const std::vector<RepeatedTrial> trials{Lanes("a", 0.0, {0.001}), Lanes("a", 0.1, {0.101})};
  const auto gap_m = [&](bool is_matched) {
    std::mt19937_64 generator(1);
    return MeasureDriveLikeness(trials, is_matched, {}, options, generator).path.mean_path_gap_m;
  };
  CHECK(gap_m(true) == Approx(0.001));
  CHECK(gap_m(false) == Approx(0.05));  // all runs lie in the middle, as a mean
}

TEST_CASE("Loop delay, its share and the steering gain are medians of each side by itself") {
  std::vector<RepeatedTrial> trials(3);
  std::vector<double> lags_s[2], r2[2], gains[2];
  for (size_t i = 0; i < trials.size(); ++i) {
    for (const bool is_real : {false, true}) {
      SimulatedTrial one{
          .task =
              std::vector<control::Waypoint>{
                  {.name = "a"}, {.name = "b", .x_m = 0.4}, {.name = "c", .x_m = 0.4, .y_m = 0.3}},
          .seed = 20 + i};
      one.simulation.link.delay_s = is_real ? 0.02 : 0.12;
      const Trajectory path = Simulate(one).result.trajectory;
      const trial::LoopDelay delay =
          trial::EstimateLoopDelay(path, one.task.waypoints, one.control);
      lags_s[is_real].push_back(delay.lag_s);
      r2[is_real].push_back(delay.r2);
      gains[is_real].push_back(delay.gain_rad_s);
      trials[i].waypoints = one.task.waypoints;
      trials[i].control = one.control;
      if (is_real) {
        trials[i].real = path;
      } else {
        trials[i].runs = {path};
      }
    }
  }
  gap::LikenessOptions options;
  options.bootstrap.resamples = 50;
  options.shuffles = 19;
  options.classifier.permutations = 19;
  std::mt19937_64 generator(1);
  const DriveLikeness likeness = MeasureDriveLikeness(trials, true, {}, options, generator);
  CHECK(likeness.loop_delay_s.sim > likeness.loop_delay_s.real + 0.05);
  CHECK(likeness.loop_delay_s.sim == Approx(statistics::Median(lags_s[0])));
  CHECK(likeness.loop_delay_s.real == Approx(statistics::Median(lags_s[1])));
  CHECK(likeness.loop_r2.sim == Approx(statistics::Median(r2[0])));
  CHECK(likeness.loop_r2.real == Approx(statistics::Median(r2[1])));
  CHECK(likeness.steering_gain_rad_s.sim == Approx(statistics::Median(gains[0])));
  CHECK(likeness.steering_gain_rad_s.real == Approx(statistics::Median(gains[1])));
}

TEST_CASE("Settings are ranked beside their own way, along x or along y") {
  gap::LikenessOptions options;
  options.bootstrap.resamples = 50;
  std::vector<RepeatedTrial> trials;
  const auto add = [&](const char* setting, bool is_along_y, double real_m, double run_m,
                       double other_m) {
    trials.push_back(Lanes(setting, real_m, {run_m}));
    RepeatedTrial& trial = trials.back();
    trial.other_reals = {Lane(other_m)};
    if (!is_along_y) return;
    for (Trajectory* path : {&trial.real, &trial.runs[0], &trial.other_reals[0]}) {
      for (auto& pose : path->poses) std::swap(pose.x_m, pose.y_m);
    }
    trial.waypoints[1] = {.name = "e", .y_m = 1.0};
  };
  add("a", false, 0.01, 0.08, 0.02);
  add("b", true, 0.02, 0.07, 0.03);
  add("c", false, 0.03, 0.06, 0.04);
  add("d", true, 0.04, 0.05, 0.05);
  const RankAgreement ranks = MeasureRanks(trials, {}, options, 1);
  CHECK(ranks.settings == 4);
  CHECK(ranks.simulated == Approx(-1.0));
  CHECK(ranks.real == Approx(1.0));
}

TEST_CASE("A drive stood at the median of its first five rows, in x and in y") {
  Trajectory log;
  const double x_mm[] = {1, 2, 3, 4, 5}, y_mm[] = {9, 1, 5, 7, 3};
  for (int i = 0; i < 30; ++i) {
    const bool rests = i < 5;
    log.poses.push_back({.t_s = 0.05 * i,
                         .x_m = rests ? 1e-3 * x_mm[i] : 0.02 * i,
                         .y_m = rests ? 1e-3 * y_mm[i] : 0.01 * i});
  }
  const gap::LikenessOptions options;
  const DriveMeasures measures(log, options);
  CHECK(measures.rest_m.x() == Approx(0.003));
  CHECK(measures.rest_m.y() == Approx(0.005));
  CHECK(measures.first == 5);
}

}  // namespace
}  // namespace rift::sweep
