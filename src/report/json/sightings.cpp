#include "rift/report/json/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace rift::report {
namespace {

constexpr std::array<const char*, 6> kAxes{"x", "y", "z", "rx", "ry", "rz"};

/// Shortest text that reads back to the same bits; nothing for what is not known.
void Append(std::string& line, double value) {
  if (!line.empty()) line += ',';
  if (!std::isnan(value)) fmt::format_to(std::back_inserter(line), "{}", value);
}

/// Yaw about the map's z, then pitch, then roll, as trajectories have them.
std::array<double, 3> RollPitchYaw(const Eigen::Matrix3d& turn) {
  return {std::atan2(turn(2, 1), turn(2, 2)), std::asin(std::clamp(-turn(2, 0), -1.0, 1.0)),
          std::atan2(turn(1, 0), turn(0, 0))};
}

}  // namespace

std::string SightingsHeader() {
  std::string line =
      "t_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,target_x_m,target_y_m,frame,latency_s,mode,"
      "hamming,margin_grey,edge_px,reprojection_px,other_reprojection_px,tags_of_this_id";
  for (int i = 0; i < 6; ++i) {
    for (int k = i; k < 6; ++k) {
      const char* unit = k < 3 ? "m2" : i < 3 ? "m_rad" : "rad2";
      line += fmt::format(",cov_{}_{}_{}", kAxes[i], kAxes[k], unit);
    }
  }
  return line + "\n";
}

std::string SightingRow(double t_s, const vision::Sighting& s) {
  std::string line;
  Append(line, t_s);
  for (const double value : s.map_from_tag.translation()) Append(line, value);
  for (const double angle : RollPitchYaw(s.map_from_tag.linear())) Append(line, angle);
  for (const double value :
       {std::nan(""), std::nan(""), static_cast<double>(s.frame_index), s.latency_s,
        static_cast<double>(s.mode), static_cast<double>(s.hamming), s.decision_margin, s.edge_px,
        s.reprojection_px, s.other_reprojection_px, static_cast<double>(s.tags_of_this_id)}) {
    Append(line, value);
  }
  for (int i = 0; i < 6; ++i) {
    for (int k = i; k < 6; ++k) Append(line, s.covariance(i, k));
  }
  return line + "\n";
}

}  // namespace rift::report
