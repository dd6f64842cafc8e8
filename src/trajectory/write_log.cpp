#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "not_logged.hpp"
#include "rift/trajectory/csv.hpp"
#include "rift/trajectory/log.hpp"
#include "rift_columns.hpp"

namespace rift::trajectory {
namespace {

/// Shortest text that reads back to the same bits; nothing for a value that is not logged.
void AppendNumber(std::string& text, double value) {
  if (std::isnan(value)) return;
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof(buffer), value);
  text.append(buffer, end);
}

/// Blanks at its ends would not survive reading either, and a first line that is no text is
/// refused.
std::string HeaderCell(const std::string& name) {
  std::string text;
  for (const char c : name) {
    text += csv::IsNoText(c) ? fmt::format("\\x{:02x}", static_cast<unsigned char>(c))
                             : std::string(1, c);
  }
  return csv::Cell(text, ", \t\r\"");
}

/// Another log's column may have the name of a column of poses; it gets one of its own.
std::string ChannelColumn(std::string name, std::set<std::string>& taken) {
  if (std::find(kRiftColumns.begin(), kRiftColumns.end(), name) == kRiftColumns.end()) return name;
  do name += "_2";
  while (!taken.insert(name).second);
  return name;
}

void AppendRow(std::string& text, const StampedPose& pose, std::span<const double> channels) {
  AppendNumber(text, pose.t_s);
  const auto append = [&text](double value) {
    text += ',';
    AppendNumber(text, value);
  };
  for (const double value : {pose.x_m, pose.y_m, pose.z_m, pose.roll_rad, pose.pitch_rad,
                             pose.yaw_rad, pose.target_x_m, pose.target_y_m}) {
    append(value);
  }
  for (const double value : channels) append(value);
  text += '\n';
}

}  // namespace

Eigen::Quaterniond WorldFromBody(const StampedPose& pose) {
  return Eigen::AngleAxisd(ZeroIfNotLogged(pose.yaw_rad), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(ZeroIfNotLogged(pose.pitch_rad), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(ZeroIfNotLogged(pose.roll_rad), Eigen::Vector3d::UnitX());
}

std::string WriteRift(const Trajectory& trajectory) {
  std::set<std::string> names;
  std::string text;
  for (const std::string_view column : kRiftColumns) {
    names.emplace(column);
    text += (text.empty() ? "" : ",") + std::string(column);
  }
  for (const Channel& channel : trajectory.channels) names.insert(channel.name);
  for (const Channel& channel : trajectory.channels) {
    text += "," + HeaderCell(ChannelColumn(channel.name, names));
  }
  text += '\n';
  std::vector<double> values(trajectory.channels.size());
  for (size_t row = 0; row < trajectory.poses.size(); ++row) {
    for (size_t i = 0; i < values.size(); ++i) values[i] = trajectory.channels[i].values[row];
    AppendRow(text, trajectory.poses[row], values);
  }
  return text;
}

std::string RiftRow(const StampedPose& pose, std::span<const double> channels) {
  std::string text;
  AppendRow(text, pose, channels);
  return text;
}

std::string WriteTum(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory.poses) {
    const Eigen::Quaterniond world_from_body = WorldFromBody(pose);
    AppendNumber(text, pose.t_s);
    for (const double value : {pose.x_m, pose.y_m, ZeroIfNotLogged(pose.z_m), world_from_body.x(),
                               world_from_body.y(), world_from_body.z(), world_from_body.w()}) {
      text += ' ';
      AppendNumber(text, value);
    }
    text += '\n';
  }
  return text;
}

}  // namespace rift::trajectory
