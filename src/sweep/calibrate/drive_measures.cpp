#include "drive_measures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rift/gap/comparison.hpp"
#include "rift/gap/likeness.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::sweep {
namespace {

using trajectory::StampedPose;
using trajectory::Trajectory;

constexpr double kMoved_m = 0.01;
// A tracker's first poses jump.
constexpr size_t kRowsAtRest = 5;

Eigen::Vector2d RestOf(const Trajectory& log) {
  std::vector<double> x_m, y_m;
  for (size_t i = 0; i < std::min(kRowsAtRest, log.poses.size()); ++i) {
    x_m.push_back(log.poses[i].x_m);
    y_m.push_back(log.poses[i].y_m);
  }
  return {statistics::Median(x_m), statistics::Median(y_m)};
}

/// The row after the last one at rest before the robot is well on its way.
size_t FirstMoving(const Trajectory& log, const Eigen::Vector2d& rest_m) {
  const auto moved_m = [&](size_t i) { return (log.poses[i].Position() - rest_m).norm(); };
  size_t i = 0;
  while (i < log.poses.size() && moved_m(i) < 3.0 * kMoved_m) ++i;
  if (i == log.poses.size()) return i;
  while (i > 0 && moved_m(i - 1) >= kMoved_m) --i;
  return i;
}

std::vector<double> UnwrappedYaw(const Trajectory& log) {
  std::vector<double> yaw_rad;
  if (!log.HasYaw()) return yaw_rad;
  for (const StampedPose& pose : log.poses) {
    const double last = yaw_rad.empty() ? pose.yaw_rad : yaw_rad.back();
    yaw_rad.push_back(last + geometry::WrapToPi(pose.yaw_rad - last));
  }
  return yaw_rad;
}

std::vector<double> EvenYawRates(const DriveMeasures& drive) {
  std::vector<double> rates;
  if (drive.yaw_rad.empty() || !drive.IsMoving()) return rates;
  const std::vector<StampedPose>& poses = drive.log.poses;
  size_t row = drive.first;
  double last_rad = drive.yaw_rad[row];
  double t_s = poses[row].t_s + DriveMeasures::kGrid_s;
  while (t_s <= poses.back().t_s) {
    while (row + 2 < poses.size() && poses[row + 1].t_s < t_s) ++row;
    const double share = (t_s - poses[row].t_s) / drive.intervals_s[row];
    const double yaw_rad =
        drive.yaw_rad[row] + share * (drive.yaw_rad[row + 1] - drive.yaw_rad[row]);
    rates.push_back((yaw_rad - last_rad) / DriveMeasures::kGrid_s);
    last_rad = yaw_rad;
    t_s += DriveMeasures::kGrid_s;
  }
  return rates;
}

std::vector<double> LateralOf(const DriveMeasures& drive) {
  std::vector<double> lateral_m;
  const Eigen::Vector2d chord = drive.log.poses.back().Position() - drive.rest_m;
  const Eigen::Vector2d left = Eigen::Vector2d(-chord.y(), chord.x()).normalized();
  for (size_t i = drive.first; i < drive.log.poses.size(); ++i) {
    lateral_m.push_back(left.dot(drive.log.poses[i].Position() - drive.rest_m));
  }
  return lateral_m;
}

std::vector<size_t> PassedRows(const Trajectory& log) {
  std::vector<size_t> rows;
  for (size_t i = 1; i < log.poses.size(); ++i) {
    const StampedPose &a = log.poses[i - 1], &b = log.poses[i];
    const double moved_m = std::hypot(b.target_x_m - a.target_x_m, b.target_y_m - a.target_y_m);
    if (moved_m > 1e-6) rows.push_back(i);
  }
  return rows;
}

}  // namespace

DriveMeasures::DriveMeasures(const Trajectory& drive, const gap::LikenessOptions& options)
    : log(drive),
      rest_m(RestOf(drive)),
      first(FirstMoving(drive, rest_m)),
      cruise_mps(gap::TraitsOf(drive, options).speed_mps),
      yaw_rad(UnwrappedYaw(drive)),
      lateral_m(LateralOf(*this)),
      passed(PassedRows(drive)) {
  for (size_t i = 0; i + 1 < log.poses.size(); ++i) {
    intervals_s.push_back(log.poses[i + 1].t_s - log.poses[i].t_s);
    steps_m.push_back((log.poses[i + 1].Position() - log.poses[i].Position()).norm());
  }
  const auto stride = static_cast<size_t>(options.speed_stride);
  for (size_t i = first; i + stride < log.poses.size(); ++i) {
    const StampedPose &a = log.poses[i], &b = log.poses[i + stride];
    speeds_mps.push_back((b.Position() - a.Position()).norm() / (b.t_s - a.t_s));
  }
  yaw_rates_rad_s = EvenYawRates(*this);
}

double ShareOf(const std::vector<double>& values, const std::function<bool(double)>& is_meant) {
  if (values.empty()) return gap::kNotComputed;
  const auto count = std::count_if(values.begin(), values.end(), is_meant);
  return static_cast<double>(count) / static_cast<double>(values.size());
}

double RobustScatter(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return statistics::kSigmaOfMedianDeviation * statistics::Median(std::move(values));
}

double Autocorrelation(const std::vector<double>& values, size_t lag) {
  if (values.size() < lag + 8) return gap::kNotComputed;
  const double mean = statistics::Mean(values);
  double product = 0.0, squares = 0.0;
  for (size_t i = 0; i < values.size(); ++i) {
    squares += (values[i] - mean) * (values[i] - mean);
    if (i >= lag) product += (values[i] - mean) * (values[i - lag] - mean);
  }
  return squares > 0.0 ? product / squares : gap::kNotComputed;
}

double Bimodality(const std::vector<double>& values) {
  const double mean = statistics::Mean(values);
  double m2 = 0.0, m3 = 0.0, m4 = 0.0;
  for (const double value : values) {
    const double d = value - mean;
    m2 += d * d, m3 += d * d * d, m4 += d * d * d * d;
  }
  const double n = static_cast<double>(values.size());
  m2 /= n, m3 /= n, m4 /= n;
  return m4 > 0.0 ? (m3 * m3 / (m2 * m2 * m2) + 1.0) / (m4 / (m2 * m2)) : gap::kNotComputed;
}

}  // namespace rift::sweep
