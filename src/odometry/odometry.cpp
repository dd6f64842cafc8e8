#include "rift/odometry/odometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"
#include "rift/trajectory/csv.hpp"

namespace rift::odometry {

double MetresPerCount(const OdometryOptions& options) {
  return 2.0 * geometry::kPi * options.drive.wheel_radius_m / options.counts_per_wheel_turn;
}

double LeftMetresPerCount(const OdometryOptions& options) {
  return 2.0 / (1.0 + options.right_over_left) * MetresPerCount(options);
}

double RightMetresPerCount(const OdometryOptions& options) {
  return options.right_over_left * LeftMetresPerCount(options);
}

double YawPerCount_rad(const OdometryOptions& options) {
  return MetresPerCount(options) / options.drive.track_m;
}

Odometry::Odometry(const OdometryOptions& options, const geometry::Pose2& world_from_start)
    : left_m_per_count_(LeftMetresPerCount(options)),
      right_m_per_count_(RightMetresPerCount(options)),
      track_m_(control::DiffDrive(options.drive).options().track_m),
      world_from_robot_(world_from_start) {
  for (const auto& [name, value] :
       {std::pair("counts_per_wheel_turn", options.counts_per_wheel_turn),
        std::pair("right_over_left", options.right_over_left)}) {
    if (std::isfinite(value) && value > 0.0) continue;
    throw std::invalid_argument(
        fmt::format("{} is {}, and it must be finite and above zero", name, value));
  }
}

const geometry::Pose2& Odometry::Update(const control::EncoderCounts& counts) {
  if (last_) {
    const double left_m = left_m_per_count_ * static_cast<double>(counts.left - last_->left);
    const double right_m = right_m_per_count_ * static_cast<double>(counts.right - last_->right);
    world_from_robot_ = world_from_robot_ *
                        control::ArcMotion(0.5 * (left_m + right_m), (right_m - left_m) / track_m_);
  }
  last_ = counts;
  return world_from_robot_;
}

std::optional<std::pair<double, double>> CountsAt(const std::vector<EncoderReading>& readings,
                                                  double t_s) {
  const auto after =
      std::lower_bound(readings.begin(), readings.end(), t_s,
                       [](const EncoderReading& reading, double t) { return reading.t_s < t; });
  if (after == readings.end() || (after == readings.begin() && after->t_s > t_s)) {
    return std::nullopt;
  }
  if (after == readings.begin()) {
    return std::pair(static_cast<double>(after->counts.left),
                     static_cast<double>(after->counts.right));
  }
  const EncoderReading& before = *(after - 1);
  const double share = (t_s - before.t_s) / (after->t_s - before.t_s);
  const auto between = [share](std::int64_t low, std::int64_t high) {
    return static_cast<double>(low) + share * static_cast<double>(high - low);
  };
  return std::pair(between(before.counts.left, after->counts.left),
                   between(before.counts.right, after->counts.right));
}

trajectory::Trajectory OdometryPath(const std::vector<EncoderReading>& readings,
                                    const OdometryOptions& options,
                                    const geometry::Pose2& world_from_start) {
  trajectory::Trajectory path;
  Odometry odometry(options, world_from_start);
  for (const EncoderReading& reading : readings) {
    const geometry::Pose2& at = odometry.Update(reading.counts);
    path.poses.push_back({.t_s = reading.t_s, .x_m = at.x_m, .y_m = at.y_m, .yaw_rad = at.yaw_rad});
  }
  return path;
}

std::string EncodersHeader() { return "t_s,left,right,battery_v\n"; }

std::string EncodersRow(const EncoderReading& reading) {
  const std::string battery =
      std::isfinite(reading.battery_v) ? fmt::format("{}", reading.battery_v) : "";
  return fmt::format("{},{},{},{}\n", reading.t_s, reading.counts.left, reading.counts.right,
                     battery);
}

std::string EncodersCsv(const std::vector<EncoderReading>& readings) {
  std::string text = EncodersHeader();
  for (const EncoderReading& reading : readings) text += EncodersRow(reading);
  return text;
}

std::vector<EncoderReading> ReadEncoders(std::string_view text, const std::string& name) {
  trajectory::csv::RowReader rows(trajectory::csv::WithoutTornRow(text), name, true, ',');
  const std::vector<std::string>& columns = rows.Columns();
  const auto column = [&](const char* wanted, bool is_needed) {
    const auto at = std::find(columns.begin(), columns.end(), wanted);
    if (at == columns.end() && is_needed) {
      throw std::invalid_argument(fmt::format(
          "{}: has no column '{}': the columns of encoders.csv are t_s, left, right and "
          "battery_v",
          name, wanted));
    }
    return static_cast<std::size_t>(at - columns.begin());
  };
  const std::size_t t = column("t_s", true), left = column("left", true),
                    right = column("right", true), battery = column("battery_v", false);
  std::vector<EncoderReading> readings;
  while (rows.Next()) {
    const std::span<const double> cells = rows.Cells();
    if (std::isnan(cells[t]) || std::isnan(cells[left]) || std::isnan(cells[right])) {
      throw std::invalid_argument(
          fmt::format("{}:{}: t_s, left and right must be there", name, rows.Line()));
    }
    if (!readings.empty() && cells[t] <= readings.back().t_s) {
      throw std::invalid_argument(
          fmt::format("{}:{}: t_s is {}, and the row before has {}: times "
                      "must rise",
                      name, rows.Line(), cells[t], readings.back().t_s));
    }
    constexpr double kMost = 9e15;  // what a double counts without gaps
    if (std::abs(cells[left]) > kMost || std::abs(cells[right]) > kMost) {
      throw std::invalid_argument(
          fmt::format("{}:{}: a count beyond {:g}", name, rows.Line(), kMost));
    }
    readings.push_back({cells[t],
                        {std::llround(cells[left]), std::llround(cells[right])},
                        battery < columns.size() ? cells[battery] : EncoderReading{}.battery_v});
  }
  if (readings.size() < 2) {
    throw std::invalid_argument(
        fmt::format("{}: has {} reading(s), and two are needed", name, readings.size()));
  }
  return readings;
}

}  // namespace rift::odometry
