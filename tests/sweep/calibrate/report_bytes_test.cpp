#include "rift/sweep/calibrate/report_bytes.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "support/inputs/paths.hpp"

namespace rift::sweep {
namespace {

CalibrationReport Report() {
  CalibrationReport report;
  report.calibration.parameters = {
      {.parameter = {.key = "simulation.motor.mismatch"}, .value = 0.1}};
  report.calibration.correlation = Eigen::MatrixXd::Constant(1, 1, std::nan(""));
  report.agreement = {{.values = {0.1, 0.2}, .difference = 0.5, .agrees = false}};
  report.values = {0.1};
  report.trials = {{.level = "ground", .trial = "1", .source = "a.csv", .is_held_out = true}};
  report.missing = {"b.csv: no such file"};
  report.judged = {{.level = "all", .side = "fitted"}};
  report.judged[0].after.told_apart.features.resize(3);
  report.judged[0].after.told_apart.all.features = {{.feature = 2, .weight = -1.5}};
  report.errors = {{.side = "fitted"}};
  report.errors[0].after.lag_s = 0.25;
  report.shown_real = test::StraightPath(0.7, 5);
  report.shown_real.channels = {{"power_left", {0.1, 0.2, 0.3, 0.4, 0.5}}};
  report.shown_after = {test::StraightPath(0.6, 4), test::StraightPath(0.5, 3)};
  return report;
}

TEST_CASE("A calibration comes back from its bytes with every list and every number") {
  const std::string bytes = EncodeReport(Report());
  const CalibrationReport back = DecodeReport(bytes);
  CHECK(EncodeReport(back) == bytes);
  CHECK(back.calibration.parameters[0].parameter.key == "simulation.motor.mismatch");
  CHECK(std::isnan(back.calibration.correlation(0, 0)));
  CHECK_FALSE(back.agreement[0].agrees);
  CHECK(back.trials[0].is_held_out);
  CHECK(back.missing == Report().missing);
  CHECK(back.judged[0].after.told_apart.features.size() == 3);
  CHECK(back.judged[0].after.told_apart.all.features[0].weight == -1.5);
  CHECK(back.errors[0].after.lag_s == 0.25);
  CHECK(back.shown_real.channels[0].values[4] == 0.5);
  CHECK(back.shown_after[1].poses.size() == 3);
}

gap::Likeness LikenessFrom(double& next) {
  gap::Likeness path{.reals = 3, .sims = 4};
  for (gap::BothSides* one : {&path.spread_m, &path.weave_m, &path.speed_mps, &path.wavelength_m}) {
    one->sim = next++;
    one->real = next++;
  }
  path.energy_p = next++;
  return path;
}

DriveLikeness DriveFrom(double next) {
  DriveLikeness drive;
  drive.path = LikenessFrom(next);
  for (gap::BothSides* one : {&drive.loop_delay_s, &drive.loop_r2, &drive.steering_gain_rad_s}) {
    one->sim = next++;
    one->real = next++;
  }
  drive.runs = static_cast<int>(next++);
  drive.circled_runs = static_cast<int>(next++);
  drive.failed_runs = static_cast<int>(next++);
  drive.prediction = {.reals = 2, .simulated_m = next++};
  drive.ranks = {.settings = 5, .simulated = next++};
  for (statistics::TwoSampleTest* test :
       {&drive.told_apart.all, &drive.told_apart.without_timing}) {
    test->first = static_cast<size_t>(next++);
    test->second = static_cast<size_t>(next++);
    test->groups = static_cast<size_t>(next++);
    test->accuracy = next++;
    test->accuracy_interval = {next++, next++};
    test->p = next++;
    test->features = {{.feature = 1, .weight = next++}};
  }
  drive.told_apart.features = {{{next++, next++}, {next++, next++}}};
  return drive;
}

void CheckSame(const DriveLikeness& a, const DriveLikeness& b) {
  CHECK(a.path.reals == b.path.reals);
  CHECK(a.path.sims == b.path.sims);
  CHECK(a.path.spread_m.sim == b.path.spread_m.sim);
  CHECK(a.path.wavelength_m.real == b.path.wavelength_m.real);
  CHECK(a.path.energy_p == b.path.energy_p);
  CHECK(a.loop_delay_s.sim == b.loop_delay_s.sim);
  CHECK(a.loop_delay_s.real == b.loop_delay_s.real);
  CHECK(a.loop_r2.real == b.loop_r2.real);
  CHECK(a.steering_gain_rad_s.sim == b.steering_gain_rad_s.sim);
  CHECK(a.runs == b.runs);
  CHECK(a.circled_runs == b.circled_runs);
  CHECK(a.failed_runs == b.failed_runs);
  CHECK(a.prediction.simulated_m == b.prediction.simulated_m);
  CHECK(a.prediction.reals == b.prediction.reals);
  CHECK(a.ranks.simulated == b.ranks.simulated);
  CHECK(a.ranks.settings == b.ranks.settings);
  for (statistics::TwoSampleTest Distinction::*test :
       {&Distinction::all, &Distinction::without_timing}) {
    const statistics::TwoSampleTest &x = a.told_apart.*test, &y = b.told_apart.*test;
    CHECK(x.first == y.first);
    CHECK(x.second == y.second);
    CHECK(x.groups == y.groups);
    CHECK(x.accuracy == y.accuracy);
    CHECK(x.accuracy_interval.low == y.accuracy_interval.low);
    CHECK(x.accuracy_interval.high == y.accuracy_interval.high);
    CHECK(x.p == y.p);
    REQUIRE(x.features.size() == 1);
    CHECK(x.features[0].weight == y.features[0].weight);
  }
  REQUIRE(a.told_apart.features.size() == 1);
  CHECK(a.told_apart.features[0].mean.real == b.told_apart.features[0].mean.real);
  CHECK(a.told_apart.features[0].sd.sim == b.told_apart.features[0].sd.sim);
}

TEST_CASE("Every member of a calibration comes back, each with a value of its own") {
  CalibrationReport report;
  for (const bool is_first : {true, false}) {
    report.calibration.parameters.push_back({.parameter = {.key = is_first ? "a" : "b",
                                                           .min = 1.0,
                                                           .max = 2.0,
                                                           .start = 3.0,
                                                           .prior_mean = 4.0,
                                                           .prior_sd = 5.0},
                                             .value = 6.0,
                                             .low = 7.0,
                                             .high = 8.0,
                                             .has_effect = !is_first,
                                             .is_at_bound = is_first,
                                             .is_identified = !is_first,
                                             .is_from_prior = is_first});
  }
  report.calibration.correlation.resize(2, 2);
  report.calibration.correlation << 1.0, 0.25, 0.75, 0.5;
  report.calibration.loss_before = 9.0;
  report.calibration.loss_after = 10.0;
  report.calibration.loss_noise = 10.5;
  report.calibration.steps = 11;
  report.calibration.has_converged = true;
  report.calibration.trials_simulated = 12;
  report.agreement = {{.values = {0.1}, .difference = 0.5, .agrees = false}};
  report.values = {13.0, 14.0};
  report.trials = {{.level = "l",
                    .trial = "t",
                    .source = "s",
                    .is_held_out = true,
                    .gap_before_m = 15.0,
                    .gap_after_m = 16.0}};
  report.missing = {"m"};
  report.judged = {{"level", "side", DriveFrom(100.0), DriveFrom(200.0)}};
  report.errors = {{.side = "fitted", .before = {.motions = 17}, .after = {.lag_s = 18.0}}};
  report.shown = 19;
  report.shown_real = test::StraightPath(0.7, 5);
  report.shown_before = {test::StraightPath(0.6, 4)};
  report.shown_after = {test::StraightPath(0.5, 3), test::StraightPath(0.4, 3)};

  const CalibrationReport back = DecodeReport(EncodeReport(report));
  REQUIRE(back.calibration.parameters.size() == 2);
  for (const size_t i : {0, 1}) {
    const CalibratedParameter& one = back.calibration.parameters[i];
    CHECK(one.parameter.key == (i == 0 ? "a" : "b"));
    CHECK(one.parameter.min == 1.0);
    CHECK(one.parameter.max == 2.0);
    CHECK(one.parameter.start == 3.0);
    CHECK(one.parameter.prior_mean == 4.0);
    CHECK(one.parameter.prior_sd == 5.0);
    CHECK(one.value == 6.0);
    CHECK(one.low == 7.0);
    CHECK(one.high == 8.0);
    CHECK(one.has_effect == (i == 1));
    CHECK(one.is_at_bound == (i == 0));
    CHECK(one.is_identified == (i == 1));
    CHECK(one.is_from_prior == (i == 0));
  }
  CHECK(back.calibration.correlation == report.calibration.correlation);
  CHECK(back.calibration.loss_before == 9.0);
  CHECK(back.calibration.loss_after == 10.0);
  CHECK(back.calibration.loss_noise == 10.5);
  CHECK(back.calibration.steps == 11);
  CHECK(back.calibration.has_converged);
  CHECK(back.calibration.trials_simulated == 12);
  REQUIRE(back.agreement.size() == 1);
  CHECK(back.agreement[0].values == std::vector<double>{0.1});
  CHECK(back.agreement[0].difference == 0.5);
  CHECK_FALSE(back.agreement[0].agrees);
  CHECK(back.values == report.values);
  REQUIRE(back.trials.size() == 1);
  CHECK(back.trials[0].level == "l");
  CHECK(back.trials[0].trial == "t");
  CHECK(back.trials[0].source == "s");
  CHECK(back.trials[0].is_held_out);
  CHECK(back.trials[0].gap_before_m == 15.0);
  CHECK(back.trials[0].gap_after_m == 16.0);
  CHECK(back.missing == report.missing);
  REQUIRE(back.judged.size() == 1);
  CHECK(back.judged[0].level == "level");
  CHECK(back.judged[0].side == "side");
  CheckSame(back.judged[0].before, report.judged[0].before);
  CheckSame(back.judged[0].after, report.judged[0].after);
  REQUIRE(back.errors.size() == 1);
  CHECK(back.errors[0].side == "fitted");
  CHECK(back.errors[0].before.motions == 17);
  CHECK(back.errors[0].after.lag_s == 18.0);
  CHECK(back.shown == 19);
  CHECK(back.shown_real.poses.size() == 5);
  REQUIRE(back.shown_before.size() == 1);
  CHECK(back.shown_before[0].poses.back().x_m == Approx(0.6));
  REQUIRE(back.shown_after.size() == 2);
  CHECK(back.shown_after[1].poses.back().x_m == Approx(0.4));
}

TEST_CASE("Bytes of a calibration that are cut short, or followed by more, are refused") {
  const std::string bytes = EncodeReport(Report());
  for (size_t length = 0; length < bytes.size(); length += 7) {
    CHECK_THROWS_AS(DecodeReport(bytes.substr(0, length)), std::runtime_error);
  }
  CHECK_THROWS_WITH(DecodeReport(bytes + "x"), Catch::Contains("behind its end"));
}

}  // namespace
}  // namespace rift::sweep
