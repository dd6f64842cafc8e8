#include "rift/sweep/calibrate/drive_features.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "drive_measures.hpp"
#include "rift/gap/likeness.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/sweep/calibrate/repeated_trial.hpp"

namespace rift::sweep {
namespace {

using gap::kNotComputed;

constexpr double kFrame_s = 1.0 / 30.0;  // of the authors' camera

/// Share of the intervals within 5 ms of so many frames.
double IntervalShare(const DriveMeasures& drive, int frames) {
  return ShareOf(drive.intervals_s, [=](double interval_s) {
    return std::abs(interval_s - frames * kFrame_s) < 0.005;
  });
}

/// At cruising speed, how well the way from row to row fits whole frames.
double StepGrid(const DriveMeasures& drive) {
  std::vector<double> fits;
  for (size_t i = std::max<size_t>(1, drive.first); i + 2 < drive.log.poses.size(); ++i) {
    const double way_m = drive.steps_m[i - 1] + drive.steps_m[i] + drive.steps_m[i + 1];
    const double local_mps =
        way_m / (drive.intervals_s[i - 1] + drive.intervals_s[i] + drive.intervals_s[i + 1]);
    if (!(local_mps > 0.7 * drive.cruise_mps)) continue;
    fits.push_back(std::cos(2.0 * std::numbers::pi * drive.steps_m[i] / (local_mps * kFrame_s)));
  }
  return statistics::Mean(fits);
}

double SpeedRoughness(const DriveMeasures& drive) {
  std::vector<double> bends;
  for (size_t i = drive.first + 1; i + 2 < drive.log.poses.size(); ++i) {
    bends.push_back(drive.RowSpeed_mps(i + 1) - 2.0 * drive.RowSpeed_mps(i) +
                    drive.RowSpeed_mps(i - 1));
  }
  return RobustScatter(std::move(bends)) / drive.cruise_mps;
}

/// Calls visit(row) for the rows within `span_s` of each waypoint passed on the way, and takes the
/// mean of what `end` makes of each.
double MeanAfterStops(const DriveMeasures& drive, double span_s, auto&& of_rows) {
  std::vector<double> values;
  for (const size_t passed : drive.passed) {
    std::vector<size_t> rows;
    const double from_s = drive.log.poses[passed].t_s;
    for (size_t i = passed; i + 1 < drive.log.poses.size(); ++i) {
      if (drive.log.poses[i].t_s - from_s <= span_s) rows.push_back(i);
    }
    if (rows.size() >= 3) values.push_back(of_rows(rows));
  }
  return statistics::Mean(values);
}

double SpeedAfterStop(const DriveMeasures& drive) {
  return MeanAfterStops(drive, 0.6, [&](const std::vector<size_t>& rows) {
    double lowest_mps = drive.RowSpeed_mps(rows.front());
    for (const size_t i : rows) lowest_mps = std::min(lowest_mps, drive.RowSpeed_mps(i));
    return lowest_mps / drive.cruise_mps;
  });
}

double TimeSlow(const DriveMeasures& drive) {
  return MeanAfterStops(drive, 0.8, [&](const std::vector<size_t>& rows) {
    double slow_s = 0.0;
    for (const size_t i : rows) {
      if (drive.RowSpeed_mps(i) < 0.6 * drive.cruise_mps) slow_s += drive.intervals_s[i];
    }
    return slow_s;
  });
}

double StartTurn(const DriveMeasures& drive) {
  if (drive.yaw_rad.empty() || drive.first < 1) return kNotComputed;
  const std::vector<double> at_rest(drive.yaw_rad.begin(),
                                    drive.yaw_rad.begin() + static_cast<long>(drive.first));
  for (size_t i = drive.first; i < drive.log.poses.size(); ++i) {
    if ((drive.log.poses[i].Position() - drive.rest_m).norm() < 0.05) continue;
    return drive.yaw_rad[i] - statistics::Median(at_rest);
  }
  return kNotComputed;
}

/// What the turn of the last interval does not foretell of the next.
double YawResidual(const DriveMeasures& drive) {
  if (drive.yaw_rad.empty()) return kNotComputed;
  std::vector<double> residuals;
  for (size_t i = drive.first + 1; i + 1 < drive.yaw_rad.size(); ++i) {
    const double last_rad = drive.yaw_rad[i] - drive.yaw_rad[i - 1];
    residuals.push_back(drive.yaw_rad[i + 1] - drive.yaw_rad[i] -
                        last_rad * drive.intervals_s[i] / drive.intervals_s[i - 1]);
  }
  return RobustScatter(std::move(residuals));
}

/// Turns that swing to the other side by more than noise does.
double Reversals(const DriveMeasures& drive) {
  constexpr double kSwing_rad_s = 0.2;
  const std::vector<double>& rates = drive.yaw_rates_rad_s;
  if (rates.size() < 8) return kNotComputed;
  int reversals = 0;
  double side = 0.0;
  for (size_t i = 1; i + 1 < rates.size(); ++i) {
    const double rate = (rates[i - 1] + rates[i] + rates[i + 1]) / 3.0;
    if (std::abs(rate) < kSwing_rad_s) continue;
    reversals += side * rate < 0.0;
    side = rate;
  }
  return reversals / (static_cast<double>(rates.size()) * DriveMeasures::kGrid_s);
}

/// Third differences across the motion, as the standard deviation of white noise that has them.
double LateralJitter(const DriveMeasures& drive) {
  std::vector<double> bends_m;
  for (size_t i = drive.first; i + 3 < drive.log.poses.size(); ++i) {
    const auto at = [&](size_t k) { return drive.log.poses[i + k].Position(); };
    const Eigen::Vector2d ahead = (at(3) - at(0)).normalized();
    const Eigen::Vector2d bend = at(3) - 3.0 * at(2) + 3.0 * at(1) - at(0);
    bends_m.push_back(ahead.x() * bend.y() - ahead.y() * bend.x());
  }
  return RobustScatter(std::move(bends_m)) / std::sqrt(20.0);
}

double SpreadAtRest(const DriveMeasures& drive, auto&& value) {
  // The first rows jump, the last ones may move already.
  constexpr size_t kLeftOut = 2;
  std::vector<double> values;
  for (size_t i = kLeftOut; i + kLeftOut < drive.first; ++i) values.push_back(value(i));
  const double middle = statistics::Median(values);
  for (double& one : values) one = std::abs(one - middle);
  return statistics::kSigmaOfMedianDeviation * statistics::Median(values);
}

/// Mean over the targets of how close a row came.
double Miss(const DriveMeasures& drive) {
  const auto& poses = drive.log.poses;
  std::vector<double> misses_m;
  std::vector<size_t> ends = drive.passed;
  ends.push_back(poses.size());
  size_t from = 0;
  for (const size_t end : ends) {
    const Eigen::Vector2d target(poses[from].target_x_m, poses[from].target_y_m);
    double closest_m = (poses[from].Position() - target).norm();
    // The row of the passage belongs to the next target already.
    for (size_t i = from; i < std::min(end + 8, poses.size()); ++i) {
      closest_m = std::min(closest_m, (poses[i].Position() - target).norm());
    }
    misses_m.push_back(closest_m);
    from = end;
  }
  return statistics::Mean(misses_m);
}

double EndDistance(const DriveMeasures& drive) {
  const trajectory::StampedPose& end = drive.log.poses.back();
  return (end.Position() - Eigen::Vector2d(end.target_x_m, end.target_y_m)).norm();
}

struct Entry {
  DriveFeature feature;
  double (*value)(const DriveMeasures&, const gap::LikenessOptions&);
};

using D = const DriveMeasures&;
using O = const gap::LikenessOptions&;

const Entry kEntries[] = {
    {{"interval_median_s", true, "median time from row to row"},
     [](D d, O) { return statistics::Median(d.intervals_s); }},
    {{"interval_sd_s", true, "its standard deviation"},
     [](D d, O) { return statistics::StandardDeviation(d.intervals_s); }},
    {{"interval_near_33ms", true, "share of these within 5 ms of one frame of a 30 fps camera"},
     [](D d, O) { return IntervalShare(d, 1); }},
    {{"interval_near_67ms", true, "share within 5 ms of two frames"},
     [](D d, O) { return IntervalShare(d, 2); }},
    {{"interval_bimodality", true, "Sarle's coefficient: 0.33 normal, 0.56 even, 1 two values"},
     [](D d, O) { return Bimodality(d.intervals_s); }},
    {{"interval_autocorrelation", true, "of one interval with the next"},
     [](D d, O) { return Autocorrelation(d.intervals_s, 1); }},
    {{"rows_per_s", true, "rows over the time of the log"},
     [](D d, O) { return static_cast<double>(d.intervals_s.size()) / d.log.Duration_s(); }},
    {{"step_grid", true,
      "mean cosine of the way from row to row in frames of 1/30 s at cruising speed: 1 on a grid, "
      "0 without one"},
     [](D d, O) { return StepGrid(d); }},
    {{"speed_roughness", true,
      "robust scatter of the second difference of the speed from row to row, over cruise"},
     [](D d, O) { return SpeedRoughness(d); }},
    {{"first_motion_s", false, "time of the first row of motion after that of the log"},
     [](D d, O) {
       return d.IsMoving() ? d.log.poses[d.first].t_s - d.log.poses[0].t_s : kNotComputed;
     }},
    {{"drive_s", false, "from there to the end"},
     [](D d, O) {
       return d.IsMoving() ? d.log.poses.back().t_s - d.log.poses[d.first].t_s : kNotComputed;
     }},
    {{"start_turn_rad", false, "turn to the left until 50 mm from the start"},
     [](D d, O) { return StartTurn(d); }},
    {{"cruise_mps", false, "median speed while moving"}, [](D d, O) { return d.cruise_mps; }},
    {{"speed_variation", false, "standard deviation of the speed over a few rows, over cruise"},
     [](D d, O) { return statistics::StandardDeviation(d.speeds_mps) / d.cruise_mps; }},
    {{"speed_after_stop", false, "lowest speed within 0.6 s after a waypoint, over cruise"},
     [](D d, O) { return SpeedAfterStop(d); }},
    {{"slow_after_stop_s", false, "time below 0.6 of cruise within 0.8 s after a waypoint"},
     [](D d, O) { return TimeSlow(d); }},
    {{"standing_share", false, "share of the drive slower than what counts as moving"},
     [](D d, O o) {
       return ShareOf(d.speeds_mps, [&](double speed) { return speed < o.moving_mps; });
     }},
    {{"yaw_rate_sd_rad_s", false, "standard deviation of the yaw rate over 50 ms"},
     [](D d, O) { return statistics::StandardDeviation(d.yaw_rates_rad_s); }},
    {{"yaw_rate_correlation_100ms", false, "autocorrelation of the yaw rate 100 ms apart"},
     [](D d, O) { return Autocorrelation(d.yaw_rates_rad_s, 2); }},
    {{"yaw_rate_correlation_200ms", false, "200 ms apart"},
     [](D d, O) { return Autocorrelation(d.yaw_rates_rad_s, 4); }},
    {{"yaw_rate_correlation_400ms", false, "400 ms apart"},
     [](D d, O) { return Autocorrelation(d.yaw_rates_rad_s, 8); }},
    {{"yaw_rate_correlation_800ms", false, "800 ms apart"},
     [](D d, O) { return Autocorrelation(d.yaw_rates_rad_s, 16); }},
    {{"yaw_residual_rad", false,
      "robust scatter of the turn that the last row's yaw rate does not foretell"},
     [](D d, O) { return YawResidual(d); }},
    {{"reversals_per_s", false, "changes of side of a yaw rate above 0.2 rad/s"},
     [](D d, O) { return Reversals(d); }},
    {{"heading_sd_rad", false, "standard deviation of the yaw while driving"},
     [](D d, O) {
       if (d.yaw_rad.empty() || !d.IsMoving()) return kNotComputed;
       const auto from = d.yaw_rad.begin() + static_cast<long>(d.first);
       return statistics::StandardDeviation(std::vector<double>(from, d.yaw_rad.end()));
     }},
    {{"weave_m", false, "RMS distance from the best straight line, evenly by length"},
     [](D d, O o) { return gap::TraitsOf(d.log, o).weave_m; }},
    {{"lateral_rms_m", false, "RMS distance from the line from start to end, evenly by row"},
     [](D d, O) { return statistics::RootMeanSquare(d.lateral_m); }},
    {{"side_m", false, "mean distance left of that line"},
     [](D d, O) { return statistics::Mean(d.lateral_m); }},
    {{"lateral_jitter_m", false, "noise of a row across the motion, from third differences"},
     [](D d, O) { return LateralJitter(d); }},
    {{"length_ratio", false, "length by strides of 20 mm over the distance from start to end"},
     [](D d, O) {
       return LengthByStrides_m(d.log) / (d.log.poses.back().Position() - d.rest_m).norm();
     }},
    {{"miss_m", false, "least distance of a row to a waypoint, mean over the waypoints"},
     [](D d, O) { return Miss(d); }},
    {{"end_m", false, "distance of the last row to the last waypoint"},
     [](D d, O) { return EndDistance(d); }},
    {{"rest_jitter_m", false, "noise along x and y before the first motion"},
     [](D d, O) {
       return std::hypot(SpreadAtRest(d, [&](size_t i) { return d.log.poses[i].x_m; }),
                         SpreadAtRest(d, [&](size_t i) { return d.log.poses[i].y_m; }));
     }},
    {{"rest_jitter_rad", false, "noise of the yaw there"},
     [](D d, O) {
       if (d.yaw_rad.empty()) return kNotComputed;
       return SpreadAtRest(d, [&](size_t i) { return d.yaw_rad[i]; });
     }},
};

}  // namespace

std::span<const DriveFeature> DriveFeatures() {
  static const std::vector<DriveFeature> features = [] {
    std::vector<DriveFeature> all;
    for (const Entry& entry : kEntries) all.push_back(entry.feature);
    return all;
  }();
  return features;
}

std::vector<double> FeaturesOf(const trajectory::Trajectory& log,
                               const gap::LikenessOptions& options) {
  constexpr size_t kFewestRows = 8;
  std::vector<double> values(std::size(kEntries), kNotComputed);
  if (log.poses.size() < kFewestRows) return values;
  const DriveMeasures drive(log, options);
  for (size_t i = 0; i < values.size(); ++i) {
    const double value = kEntries[i].value(drive, options);
    values[i] = std::isfinite(value) ? value : kNotComputed;
  }
  return values;
}

}  // namespace rift::sweep
