#include "log_rows.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include "csv.hpp"

namespace rift::trajectory {
namespace {

/// Names of the pose columns of a dialect, in the order of StampedPose.
constexpr std::array<std::string_view, 9> kRiftColumns{
    "t_s", "x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad", "target_x_m", "target_y_m"};
constexpr std::array<std::string_view, 9> kAuthorsColumns{
    "t", "x", "y", "z", "roll", "pitch", "yaw", "desired_x", "desired_y"};

constexpr std::array<double StampedPose::*, 9> kFields{
    &StampedPose::t_s,     &StampedPose::x_m,        &StampedPose::y_m,
    &StampedPose::z_m,     &StampedPose::roll_rad,   &StampedPose::pitch_rad,
    &StampedPose::yaw_rad, &StampedPose::target_x_m, &StampedPose::target_y_m};

/// Where the named columns of a header go: into the fields of a pose, further ones into channels.
class ColumnMap {
 public:
  ColumnMap(const std::vector<std::string>& header, const std::array<std::string_view, 9>& names,
            const std::string& name, int header_line)
      : names_(names), name_(name) {
    std::vector<bool> taken(header.size(), false);
    for (size_t i = 0; i < names.size(); ++i) {
      const auto found = std::find(header.begin(), header.end(), names[i]);
      if (found == header.end() && i < kRequired) {
        throw std::invalid_argument(
            fmt::format("{}:{}: column {} is missing", name, header_line, names[i]));
      }
      if (found == header.end()) continue;
      taken[found - header.begin()] = true;
      fields_.push_back({static_cast<size_t>(found - header.begin()), kFields[i]});
    }
    for (size_t column = 0; column < taken.size(); ++column) {
      if (!taken[column]) channels_.push_back(column);
    }
  }

  const std::vector<size_t>& Channels() const { return channels_; }

  StampedPose PoseOf(const csv::RowReader& row) const {
    StampedPose pose;
    for (const auto& [column, field] : fields_) pose.*field = row.Cells()[column];
    for (size_t i = 0; i < kRequired; ++i) {
      if (!std::isnan(pose.*kFields[i])) continue;
      throw std::invalid_argument(
          fmt::format("{}:{}: column {} is empty", name_, row.Line(), names_[i]));
    }
    return pose;
  }

 private:
  static constexpr size_t kRequired = 3;
  struct Source {
    size_t column;
    double StampedPose::*field;
  };

  const std::array<std::string_view, 9>& names_;
  const std::string& name_;
  std::vector<Source> fields_;
  std::vector<size_t> channels_;
};

void Reserve(LogRows& rows, size_t count) {
  rows.trajectory.poses.reserve(count);
  for (Channel& channel : rows.trajectory.channels) channel.values.reserve(count);
}

LogRows ReadColumns(csv::RowReader row, const std::array<std::string_view, 9>& names,
                    const std::string& name) {
  const ColumnMap columns(row.Columns(), names, name, row.Line());
  LogRows rows;
  for (const size_t column : columns.Channels()) {
    rows.trajectory.channels.push_back({row.Columns()[column], {}});
  }
  while (row.Next()) {
    if (rows.trajectory.poses.empty()) Reserve(rows, row.RowsToExpect());
    rows.Add(columns.PoseOf(row), name, row.Line());
    for (size_t i = 0; i < columns.Channels().size(); ++i) {
      rows.trajectory.channels[i].values.push_back(row.Cells()[columns.Channels()[i]]);
    }
  }
  return rows;
}

StampedPose TumPose(const csv::RowReader& row, const std::string& name) {
  const std::span<const double> cells = row.Cells();
  if (cells.size() != 8) {
    throw std::invalid_argument(
        fmt::format("{}:{}: {} columns, and tum has 8: t tx ty tz qx qy qz qw", name, row.Line(),
                    cells.size()));
  }
  Eigen::Quaterniond quaternion(cells[7], cells[4], cells[5], cells[6]);
  // Neither the squares of large numbers nor those of small ones may be lost.
  quaternion.coeffs().stableNormalize();
  if (!(quaternion.norm() > 0.0)) {
    throw std::invalid_argument(
        fmt::format("{}:{}: the quaternion has zero length", name, row.Line()));
  }
  const Eigen::Matrix3d r = quaternion.toRotationMatrix();
  StampedPose pose{.t_s = cells[0], .x_m = cells[1], .y_m = cells[2], .z_m = cells[3]};
  pose.roll_rad = std::atan2(r(2, 1), r(2, 2));
  pose.pitch_rad = std::asin(std::clamp(-r(2, 0), -1.0, 1.0));
  pose.yaw_rad = std::atan2(r(1, 0), r(0, 0));
  return pose;
}

LogRows ReadTum(csv::RowReader row, const std::string& name) {
  LogRows rows;
  while (row.Next()) {
    if (rows.trajectory.poses.empty()) Reserve(rows, row.RowsToExpect());
    rows.Add(TumPose(row, name), name, row.Line());
  }
  return rows;
}

}  // namespace

void LogRows::Add(const StampedPose& pose, const std::string& name, int line) {
  CheckMagnitudes(pose, name, line);
  largest_angles.Add(pose);
  std::vector<StampedPose>& poses = trajectory.poses;
  if (!poses.empty() && pose.t_s <= poses.back().t_s) time_rises = false;
  if (std::isnan(pose.yaw_rad) && !first_line_without_yaw) first_line_without_yaw = line;
  poses.push_back(pose);
}

LogRows ReadRows(std::string_view head, const TextPieces& pieces, const std::string& name,
                 Format format) {
  if (format == Format::kTum) {
    return ReadTum(csv::RowReader(head, pieces, name, false, ' '), name);
  }
  return ReadColumns(csv::RowReader(head, pieces, name, true, ','),
                     format == Format::kRift ? kRiftColumns : kAuthorsColumns, name);
}

}  // namespace rift::trajectory
