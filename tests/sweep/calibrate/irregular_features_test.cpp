// Features of drives whose rows are all different, beside their definitions.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "rift/statistics/descriptive.hpp"
#include "rift/sweep/calibrate/drive_features.hpp"
#include "rift/trajectory/trajectory.hpp"
#include "support/drive_feature.hpp"

namespace rift::sweep {
namespace {

using statistics::Median;
using test::Feature;
using trajectory::Trajectory;

double MedianSize(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return Median(values);
}

constexpr size_t kFirst = 20;  // row of the first motion

/// Twenty rows at rest and forty on the way along x, none like another.
Trajectory Irregular(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  Trajectory log;
  double t_s = 5.0, x_m = 0.0, yaw_rad = 0.0;
  for (size_t i = 0; i < kFirst + 40; ++i) {
    const bool drives = i >= kFirst;
    t_s += 0.03 + 0.02 * uniform();
    x_m += drives ? 0.012 + 0.004 * uniform() : 0.0;
    yaw_rad += drives ? 0.1 * (uniform() - 0.5) : 0.0;
    const double x_noise_m = drives ? 0.0 : 1e-3 * uniform();
    log.poses.push_back({.t_s = t_s,
                         .x_m = x_m + x_noise_m,
                         .y_m = 1e-3 * uniform(),
                         .yaw_rad = yaw_rad + (drives ? 0.0 : 1e-2 * uniform())});
  }
  return log;
}

TEST_CASE("Rows that are all different have the features of their definitions") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    const Trajectory log = Irregular(seed);
    const auto& p = log.poses;
    REQUIRE(Feature(log, "first_motion_s") == Approx(p[kFirst].t_s - p[0].t_s));
    const auto speed_mps = [&p](size_t i) {
      return (p[i + 1].Position() - p[i].Position()).norm() / (p[i + 1].t_s - p[i].t_s);
    };
    std::vector<double> bends_mps, residuals_rad, across_m;
    for (size_t i = kFirst + 1; i + 2 < p.size(); ++i) {
      bends_mps.push_back(speed_mps(i + 1) - 2.0 * speed_mps(i) + speed_mps(i - 1));
    }
    for (size_t i = kFirst + 1; i + 1 < p.size(); ++i) {
      const double before_rad_s = (p[i].yaw_rad - p[i - 1].yaw_rad) / (p[i].t_s - p[i - 1].t_s);
      residuals_rad.push_back(p[i + 1].yaw_rad - p[i].yaw_rad -
                              before_rad_s * (p[i + 1].t_s - p[i].t_s));
    }
    for (size_t i = kFirst; i + 3 < p.size(); ++i) {
      const Eigen::Vector2d third = p[i + 3].Position() - 3.0 * p[i + 2].Position() +
                                    3.0 * p[i + 1].Position() - p[i].Position();
      const Eigen::Vector2d way = (p[i + 3].Position() - p[i].Position()).normalized();
      across_m.push_back(third.dot(Eigen::Vector2d(-way.y(), way.x())));
    }
    CHECK(Feature(log, "speed_roughness") ==
          Approx(1.4826 * MedianSize(bends_mps) / Feature(log, "cruise_mps")).epsilon(1e-4));
    CHECK(Feature(log, "yaw_residual_rad") ==
          Approx(1.4826 * MedianSize(residuals_rad)).epsilon(1e-4));
    CHECK(Feature(log, "lateral_jitter_m") ==
          Approx(1.4826 * MedianSize(across_m) / std::sqrt(20.0)).epsilon(1e-4));

    // All but the two first and the two last rows at rest.
    const auto spread = [&p](double trajectory::StampedPose::*channel) {
      std::vector<double> values;
      for (size_t i = 2; i < kFirst - 2; ++i) values.push_back(p[i].*channel);
      const double middle = Median(values);
      for (double& value : values) value -= middle;
      return 1.4826 * MedianSize(values);
    };
    CHECK(Feature(log, "rest_jitter_m") == Approx(std::hypot(spread(&trajectory::StampedPose::x_m),
                                                             spread(&trajectory::StampedPose::y_m)))
                                               .epsilon(1e-4));
    CHECK(Feature(log, "rest_jitter_rad") ==
          Approx(spread(&trajectory::StampedPose::yaw_rad)).epsilon(1e-4));

    // Rates over 50 ms from the first motion on, between the rows.
    std::vector<double> yaws_rad, rates;
    size_t row = kFirst;
    for (int k = 0; p[kFirst].t_s + 0.05 * k <= p.back().t_s; ++k) {
      const double t_s = p[kFirst].t_s + 0.05 * k;
      while (row + 2 < p.size() && p[row + 1].t_s < t_s) ++row;
      const double share = (t_s - p[row].t_s) / (p[row + 1].t_s - p[row].t_s);
      yaws_rad.push_back(p[row].yaw_rad + share * (p[row + 1].yaw_rad - p[row].yaw_rad));
      if (k > 0) rates.push_back((yaws_rad.back() - yaws_rad[yaws_rad.size() - 2]) / 0.05);
    }
    const double mean = statistics::Mean(rates);
    double squares = 0.0;
    for (const double rate : rates) squares += (rate - mean) * (rate - mean);
    CHECK(Feature(log, "yaw_rate_sd_rad_s") ==
          Approx(std::sqrt(squares / (static_cast<double>(rates.size()) - 1.0))));
    for (const auto& [name, lag] : {std::pair("yaw_rate_correlation_100ms", size_t{2}),
                                    {"yaw_rate_correlation_200ms", size_t{4}},
                                    {"yaw_rate_correlation_400ms", size_t{8}},
                                    {"yaw_rate_correlation_800ms", size_t{16}}}) {
      double products = 0.0;
      for (size_t i = 0; i + lag < rates.size(); ++i) {
        products += (rates[i] - mean) * (rates[i + lag] - mean);
      }
      CHECK(Feature(log, name) == Approx(products / squares));
    }
  }
}

TEST_CASE("Steps in frames count from the second row of a drive, above 0.7 of cruise") {
  // On the way from the first row on: 20 mm each in 50 ms, but for a few.
  Trajectory log;
  std::vector<double> steps_m(30, 0.02);
  steps_m[0] = steps_m[2] = 0.018;
  steps_m[1] = 0.024;
  steps_m[12] = 0.0166;  // three rows at 0.66 of the speed, and 0.78 and 0.72 beside them
  steps_m[13] = 0.0100;
  steps_m[14] = 0.0130;
  double x_m = 1.0;
  for (int i = 0; i < 30; ++i) {
    log.poses.push_back({.t_s = 0.05 * i, .x_m = x_m});
    x_m += steps_m[static_cast<size_t>(i)];
  }
  double sum = 0.0, count = 0.0;
  for (size_t i = 1; i + 2 < log.poses.size(); ++i) {
    const double local_mps = (steps_m[i - 1] + steps_m[i] + steps_m[i + 1]) / 0.15;
    if (local_mps < 0.7 * 0.4) continue;
    sum += std::cos(2.0 * std::numbers::pi * steps_m[i] / (local_mps / 30.0));
    count += 1.0;
  }
  REQUIRE(count == 26.0);
  CHECK(Feature(log, "cruise_mps") == Approx(0.4));
  CHECK(Feature(log, "step_grid") == Approx(sum / count));
}

TEST_CASE("A tracker that jumps while the robot stands makes no step of a drive") {
  const auto drive = [](double jump_m) {
    Trajectory log;
    for (int i = 0; i < 80; ++i) {
      const double way_m = i < 20 ? 0.0 : 0.015 * (i - 19);
      log.poses.push_back({.t_s = 0.05 * i, .x_m = way_m, .y_m = i == 8 ? jump_m : 0.0});
    }
    return log;
  };
  CHECK(Feature(drive(0.02), "first_motion_s") == Approx(1.0));
  CHECK(Feature(drive(0.02), "step_grid") == Approx(Feature(drive(0.0), "step_grid")));
}

}  // namespace
}  // namespace rift::sweep
