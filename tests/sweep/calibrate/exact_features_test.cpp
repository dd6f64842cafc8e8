// Features of drives that were made so that each number is known.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "rift/sweep/calibrate/distinction.hpp"
#include "rift/sweep/calibrate/drive_features.hpp"
#include "rift/trajectory/trajectory.hpp"
#include "support/drive_feature.hpp"
#include "sweep/calibrate/drive_measures.hpp"

namespace rift::sweep {
namespace {

using test::Feature;
using trajectory::StampedPose;
using trajectory::Trajectory;

/// Twenty rows at rest, then `rows` rows of 15 mm each, 50 ms apart, along x from (1, 2) on.
Trajectory Drive(int rows = 60) {
  Trajectory log;
  for (int i = 0; i < 20 + rows; ++i) {
    const double way_m = i < 20 ? 0.0 : 0.015 * (i - 19);
    log.poses.push_back({.t_s = 7.0 + 0.05 * i,
                         .x_m = 1.0 + way_m,
                         .y_m = 2.0,
                         .yaw_rad = 0.0,
                         .target_x_m = 1.0 + 0.015 * rows,
                         .target_y_m = 2.0});
  }
  return log;
}

/// As Drive, each row changed by its place.
Trajectory Changed(const std::function<void(StampedPose&, int)>& change, int rows = 60) {
  Trajectory log = Drive(rows);
  for (size_t i = 0; i < log.poses.size(); ++i) change(log.poses[i], static_cast<int>(i));
  return log;
}

TEST_CASE("Intervals have their median, their scatter, their rate and their frames") {
  // 33, 67, 33, 67 ms ...
  double t_s = 0.0;
  const Trajectory log = Changed([&](StampedPose& pose, int i) {
    pose.t_s = t_s;
    t_s += i % 2 == 0 ? 1.0 / 30.0 : 2.0 / 30.0;
  });
  CHECK(Feature(log, "interval_median_s") == Approx(1.0 / 30.0));  // 40 of 79
  CHECK(Feature(log, "interval_near_33ms") == Approx(40.0 / 79.0));
  CHECK(Feature(log, "interval_near_67ms") == Approx(39.0 / 79.0));
  CHECK(Feature(log, "interval_sd_s") == Approx(1.0 / 60.0).epsilon(0.01));
  CHECK(Feature(log, "interval_bimodality") == Approx(1.0));
  CHECK(Feature(log, "interval_autocorrelation") == Approx(-78.0 / 79.0).epsilon(1e-3));
  CHECK(Feature(log, "rows_per_s") == Approx(79.0 / (40.0 / 30.0 + 78.0 / 30.0)));
  // Within 5 ms of a frame, and not beyond.
  for (const auto& [off_s, is_near] : {std::pair{0.0049, true}, {0.0051, false}}) {
    for (const double sign : {1.0, -1.0}) {
      const Trajectory even = Changed([&, off_s = off_s](StampedPose& pose, int i) {
        pose.t_s = i * (1.0 / 30.0 + sign * off_s);
      });
      CHECK(Feature(even, "interval_near_33ms") == (is_near ? 1.0 : 0.0));
    }
  }
}

TEST_CASE("A drive begins with its first row of motion and ends with its last row") {
  const Trajectory log = Drive();
  CHECK(Feature(log, "first_motion_s") == Approx(1.0));  // row 20, 15 mm on
  CHECK(Feature(log, "drive_s") == Approx(59 * 0.05));
  CHECK(Feature(log, "cruise_mps") == Approx(0.3));
  CHECK(Feature(log, "speed_variation") == Approx(0.0).margin(1e-9));
  CHECK(Feature(log, "standing_share") == 0.0);
  CHECK(Feature(log, "length_ratio") == Approx(1.0).epsilon(0.02));
  CHECK(Feature(log, "end_m") == Approx(0.0).margin(1e-9));
}

TEST_CASE("A turn to the left until 50 mm from the start is above zero, one to the right below") {
  for (const double side : {1.0, -1.0}) {
    const Trajectory log = Changed([&](StampedPose& pose, int i) {
      // 0.1 rad a row from the first row of motion on: the fourth is 60 mm from the start.
      pose.yaw_rad = 0.7 + (i < 20 ? 0.0 : side * 0.1 * (i - 19));
    });
    CHECK(Feature(log, "start_turn_rad") == Approx(side * 0.4));
  }
}

TEST_CASE("Speeds that change show as their variation, and slow rows as standing") {
  // Ten rows of 3 mm (0.06 m/s) in the middle: over strides of three rows.
  double x_m = 1.0;
  const Trajectory log = Changed([&](StampedPose& pose, int i) {
    if (i > 19) x_m += i >= 40 && i < 50 ? 0.003 : 0.015;
    pose.x_m = x_m;
  });
  CHECK(Feature(log, "cruise_mps") == Approx(0.3));
  // 57 strides; those with three slow rows are 8, with two (0.14) 2 and with one (0.22) 2.
  CHECK(Feature(log, "standing_share") == Approx(8.0 / 57.0));
  const double mean = (45 * 0.3 + 8 * 0.06 + 2 * 0.14 + 2 * 0.22) / 57.0;
  const double squares = 45 * std::pow(0.3 - mean, 2) + 8 * std::pow(0.06 - mean, 2) +
                         2 * std::pow(0.14 - mean, 2) + 2 * std::pow(0.22 - mean, 2);
  CHECK(Feature(log, "speed_variation") == Approx(std::sqrt(squares / 56.0) / 0.3));
}

TEST_CASE("A drive to the left of its line is on that side, by as much") {
  for (const double side : {1.0, -1.0}) {
    const Trajectory log = Changed([&](StampedPose& pose, int i) {
      if (i >= 20 && i < 79) pose.y_m += side * 0.01;  // back on the line in its last row
    });
    CHECK(Feature(log, "side_m") == Approx(side * 0.01 * 59.0 / 60.0));
    CHECK(Feature(log, "lateral_rms_m") == Approx(0.01 * std::sqrt(59.0 / 60.0)));
  }
}

TEST_CASE("Rows that jump to either side in turns are noise across the motion") {
  const Trajectory log = Changed([](StampedPose& pose, int i) {
    if (i >= 18) pose.y_m += i % 2 == 0 ? 1e-4 : -1e-4;
  });
  // Third differences are eight times as large, and sqrt(20) times that of white noise.
  CHECK(Feature(log, "lateral_jitter_m") == Approx(1.4826 * 8e-4 / std::sqrt(20.0)).epsilon(0.01));
  CHECK(Feature(Drive(), "lateral_jitter_m") == Approx(0.0).margin(1e-9));
}

TEST_CASE("Noise at rest is that of places and of yaws before the first motion") {
  const Trajectory log = Changed([](StampedPose& pose, int i) {
    const double one = i % 2 == 0 ? 1.0 : -1.0;
    if (i < 20) pose.x_m += 3e-4 * one, pose.y_m += 4e-4 * one, pose.yaw_rad += 2e-3 * one;
  });
  CHECK(Feature(log, "rest_jitter_m") == Approx(1.4826 * 5e-4));
  CHECK(Feature(log, "rest_jitter_rad") == Approx(1.4826 * 2e-3));
}

TEST_CASE("Yaw while driving has its scatter, its rate and its changes of side") {
  // Half a radian a second to the left for half a second, then to the right, and so on.
  const auto swinging = [](double rate_rad_s) {
    double yaw_rad = 0.0;
    return Changed([=](StampedPose& pose, int i) mutable {
      if (i > 20) yaw_rad += 0.05 * rate_rad_s * (((i - 21) / 10) % 2 == 0 ? 1.0 : -1.0);
      pose.yaw_rad = yaw_rad;
    });
  };
  const Trajectory log = swinging(0.5);
  CHECK(Feature(log, "yaw_rate_sd_rad_s") == Approx(0.5).epsilon(0.03));
  // 59 intervals of 50 ms: sides change after 10, 20, 30, 40 and 50 of them.
  CHECK(Feature(log, "reversals_per_s") == Approx(5.0 / (59 * 0.05)).epsilon(0.05));
  CHECK(Feature(swinging(0.21), "reversals_per_s") > 1.0);
  CHECK(Feature(swinging(0.19), "reversals_per_s") == 0.0);
  CHECK(Feature(log, "yaw_rate_correlation_100ms") > 0.4);
  CHECK(Feature(log, "yaw_rate_correlation_800ms") < Feature(log, "yaw_rate_correlation_100ms"));
  CHECK(Feature(log, "heading_sd_rad") == Approx(0.25 / std::sqrt(12.0)).epsilon(0.1));
  const Trajectory ramp = Changed([](StampedPose& pose, int i) {
    pose.yaw_rad = std::remainder(3.0 + 0.01 * i, 6.283185307179586);  // past half a turn
  });
  CHECK(Feature(ramp, "heading_sd_rad") == Approx(0.6 / std::sqrt(12.0)).epsilon(0.03));
  CHECK(Feature(ramp, "yaw_residual_rad") == Approx(0.0).margin(1e-9));
}

TEST_CASE("A length by strides is held against the distance of both ends") {
  const Trajectory log = Changed([](StampedPose& pose, int i) {
    if (i >= 50) pose.x_m = 1.0 + 0.015 * 31 - 0.015 * (i - 50);  // half way, and back
  });
  const double there_m = 0.015 * 31, back_m = 0.015 * 29;
  CHECK(Feature(log, "length_ratio") ==
        Approx((there_m + back_m) / (there_m - back_m)).epsilon(0.1));
}

TEST_CASE("Misses are the least distances to the targets, the last one to the end") {
  const Trajectory log = Changed([](StampedPose& pose, int i) {
    pose.target_x_m = i < 50 ? 1.45 : 1.95;  // at its side, and beyond its end
    pose.target_y_m = i < 50 ? 2.03 : 2.0;
  });
  CHECK(Feature(log, "end_m") == Approx(0.05));
  CHECK(Feature(log, "miss_m") == Approx(0.5 * (0.03 + 0.05)));
  const gap::LikenessOptions options;
  const DriveMeasures measures(log, options);
  CHECK(measures.passed == std::vector<size_t>{50});
  CHECK(measures.first == 20);
  CHECK(measures.IsMoving());
  CHECK(measures.RowSpeed_mps(30) == Approx(0.3));
}

TEST_CASE("A stop behind a waypoint has its lowest speed and its time below 0.6 of cruise") {
  double x_m = 1.0;
  const Trajectory log = Changed([&](StampedPose& pose, int i) {
    // Six rows of a third of the speed behind row 50, where the target changes.
    if (i > 19) x_m += i > 52 && i <= 58 ? 0.005 : 0.015;
    pose.x_m = x_m;
    pose.target_x_m = i < 50 ? 1.45 : 1.9;
  });
  CHECK(Feature(log, "speed_after_stop") == Approx(1.0 / 3.0));
  CHECK(Feature(log, "slow_after_stop_s") == Approx(6 * 0.05));
  const Trajectory later = Changed([&](StampedPose& pose, int i) {
    pose.x_m = log.poses[static_cast<size_t>(i)].x_m;
    pose.target_x_m = i < 35 ? 1.45 : 1.9;  // 0.9 s before it slows down
  });
  CHECK(Feature(later, "speed_after_stop") == Approx(1.0));
  CHECK(Feature(later, "slow_after_stop_s") == 0.0);
}

TEST_CASE("A slow row counts up to 0.6 s or 0.8 s behind a waypoint, below 0.6 of cruise") {
  const auto drive = [](int rows_behind, double share) {
    double x_m = 1.0;
    return Changed([=](StampedPose& pose, int i) mutable {
      if (i > 19) x_m += (i == 51 + rows_behind ? share : 1.0) * 0.015;
      pose.x_m = x_m;
      pose.target_x_m = i < 50 ? 1.45 : 1.9;
    });
  };
  CHECK(Feature(drive(11, 0.5), "speed_after_stop") == Approx(0.5));
  CHECK(Feature(drive(13, 0.5), "speed_after_stop") == Approx(1.0));
  CHECK(Feature(drive(15, 0.5), "slow_after_stop_s") == Approx(0.05));
  CHECK(Feature(drive(17, 0.5), "slow_after_stop_s") == 0.0);
  CHECK(Feature(drive(15, 0.58), "slow_after_stop_s") == Approx(0.05));
  CHECK(Feature(drive(15, 0.62), "slow_after_stop_s") == 0.0);
}

TEST_CASE("Too few rows tell no stops and no changes of side, one more does") {
  std::set<size_t> rates;
  for (const int rows : {7, 8, 9, 10, 11}) {
    const Trajectory log = Drive(rows);
    const gap::LikenessOptions options;
    const size_t count = DriveMeasures(log, options).yaw_rates_rad_s.size();
    rates.insert(count);
    CHECK(std::isnan(Feature(log, "reversals_per_s")) == (count < 8));
  }
  CHECK(rates.count(7) == 1);
  CHECK(rates.count(8) == 1);
  for (const int left : {3, 4}) {  // rows from the waypoint on, the last of which has no speed
    const Trajectory log = Changed([&](StampedPose& pose, int i) {
      if (i < 80 - left) pose.target_x_m = 1.45;
    });
    CHECK(std::isnan(Feature(log, "speed_after_stop")) == (left == 3));
    CHECK(std::isnan(Feature(log, "slow_after_stop_s")) == (left == 3));
  }
}

TEST_CASE("A waypoint is missed by the nearest row until seven rows after the next one's first") {
  for (const int nearest : {57, 58}) {
    const Trajectory log = Changed([&](StampedPose& pose, int i) {
      if (i < 50) pose.target_x_m = 1.0 + 0.015 * (nearest - 19);
    });
    CHECK(Feature(log, "miss_m") == Approx(nearest == 57 ? 0.0 : 0.5 * 0.015).margin(1e-9));
  }
}

TEST_CASE("Targets a little apart are two, and a robot that shifts by two centimetres stands") {
  const gap::LikenessOptions options;
  const Trajectory near = Changed([](StampedPose& pose, int i) {
    if (i < 50) pose.target_x_m -= 0.01;
  });
  CHECK(DriveMeasures(near, options).passed == std::vector<size_t>{50});
  Trajectory still = Drive(20);
  for (size_t i = 20; i < still.poses.size(); ++i) still.poses[i].x_m = i < 30 ? 1.0 : 1.02;
  const DriveMeasures measures(still, options);
  CHECK(measures.first == still.poses.size());
  CHECK_FALSE(measures.IsMoving());
}

TEST_CASE("Features that look at time stamps are marked, and these alone") {
  std::string timing;
  for (const DriveFeature& feature : DriveFeatures()) {
    if (feature.is_timing) timing += std::string(feature.name) + " ";
  }
  CHECK(timing ==
        "interval_median_s interval_sd_s interval_near_33ms interval_near_67ms "
        "interval_bimodality interval_autocorrelation rows_per_s step_grid speed_roughness ");
}

TEST_CASE(
    "A summary of features has both sides by themselves, and what cannot be told apart is even") {
  std::vector<RepeatedTrial> trials;
  for (int i = 0; i < 8; ++i) {
    RepeatedTrial trial{.setting = std::to_string(i / 2), .real = Drive(60 + i)};
    trial.runs = {Drive(70 + i)};
    trials.push_back(std::move(trial));
  }
  gap::LikenessOptions options;
  options.bootstrap.resamples = 50;
  const Distinction found = Distinguish(trials, options, 1);
  CHECK(found.all.first == 8);
  CHECK(found.all.second == 8);
  CHECK(found.all.groups == 4);
  CHECK(found.without_timing.groups == 4);
  CHECK(found.all.features.size() == DriveFeatures().size());
  CHECK(found.without_timing.features.size() == DriveFeatures().size() - 9);
  for (const statistics::FeatureEvidence& one : found.without_timing.features) {
    CHECK_FALSE(DriveFeatures()[one.feature].is_timing);
  }
  for (size_t i = 0; i < DriveFeatures().size(); ++i) {
    if (DriveFeatures()[i].name != "drive_s") continue;
    CHECK(found.features[i].mean.real == Approx((59 + 3.5) * 0.05));
    CHECK(found.features[i].mean.sim == Approx((69 + 3.5) * 0.05));
    CHECK(found.features[i].sd.real == Approx(0.05 * std::sqrt(6.0)));  // of 0 to 7
    CHECK(found.features[i].sd.sim == Approx(0.05 * std::sqrt(6.0)));
  }
  CHECK(found.all.accuracy > 0.9);  // by how long they drive
}

}  // namespace
}  // namespace rift::sweep
