#include "rift/report/json/json.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>

#include "rift/geometry/pose3.hpp"

namespace rift::report {
namespace {

constexpr std::array<const char*, 6> kAxes{"x", "y", "z", "rx", "ry", "rz"};

/// Shortest text that reads back to the same bits; nothing for what is not known.
void Append(std::string& line, double value) {
  if (!line.empty()) line += ',';
  if (!std::isnan(value)) fmt::format_to(std::back_inserter(line), "{}", value);
}

}  // namespace

std::string SightingsHeader() {
  std::string line =
      "t_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,target_x_m,target_y_m,frame,latency_s,mode,"
      "hamming,margin_grey,edge_px,reprojection_px,other_reprojection_px,tags_of_this_id,"
      "track_state,tag_id,on_floor";
  for (int i = 0; i < 6; ++i) {
    for (int k = i; k < 6; ++k) {
      const char* unit = k < 3 ? "m2" : i < 3 ? "m_rad" : "rad2";
      line += fmt::format(",cov_{}_{}_{}", kAxes[i], kAxes[k], unit);
    }
  }
  return line + "\n";
}

std::string SightingRow(double t_s, const vision::Sighting& s) {
  const bool has_pose = s.state != vision::TrackState::kLost;
  const bool is_seen = has_pose && s.state != vision::TrackState::kPredicted;
  const auto if_seen = [&](double value) { return is_seen ? value : std::nan(""); };
  const auto if_posed = [&](double value) { return has_pose ? value : std::nan(""); };
  std::string line;
  Append(line, t_s);
  for (const double value : s.map_from_tag.translation()) Append(line, if_posed(value));
  for (const double angle : geometry::RollPitchYaw(s.map_from_tag.linear()))
    Append(line, if_posed(angle));
  for (const double value :
       {std::nan(""), std::nan(""), static_cast<double>(s.frame_index), s.latency_s,
        if_seen(static_cast<double>(s.mode)), if_seen(s.hamming), if_seen(s.decision_margin),
        if_seen(s.edge_px), if_seen(s.reprojection_px), if_seen(s.other_reprojection_px),
        if_seen(s.tags_of_this_id), static_cast<double>(s.state), static_cast<double>(s.tag_id),
        if_seen(s.is_on_floor ? 1.0 : 0.0)}) {
    Append(line, value);
  }
  for (int i = 0; i < 6; ++i) {
    for (int k = i; k < 6; ++k) Append(line, if_posed(s.covariance(i, k)));
  }
  return line + "\n";
}

}  // namespace rift::report
