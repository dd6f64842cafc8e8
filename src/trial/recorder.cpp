#include "rift/trial/recorder.hpp"

#include <algorithm>
#include <cmath>

namespace rift::trial {
namespace {

void Count(LimitCounts& counts, const control::Decision& decision) {
  const control::Limits& limits = decision.limits;
  ++counts.decisions;
  counts.v_min += limits.v_min;
  counts.v_max += limits.v_max;
  counts.cruise_cap += limits.cruise_cap;
  counts.through_cruise += limits.through_cruise;
  counts.w_min += limits.w_min;
  counts.w_max += limits.w_max;
  counts.normalised += limits.normalised;
  counts.slew += limits.slew;
  counts.largest_raw_v = std::max(counts.largest_raw_v, decision.raw_v);
  counts.largest_raw_w = std::max(counts.largest_raw_w, std::abs(decision.raw_w));
}

}  // namespace

Recorder::Recorder(const std::vector<control::Waypoint>& waypoints, double log_period_s)
    : log_period_s_(log_period_s) {
  for (size_t i = 1; i < waypoints.size(); ++i) {
    result_.visits.push_back({waypoints[i].name, std::nullopt, std::nullopt});
  }
  result_.trajectory.channels = {{"power_left", {}}, {"power_right", {}}, {"v", {}}, {"w", {}}};
}

void Recorder::Pose(const PoseMeasurement& measured, const control::Waypoint& target,
                    const control::Decision& decision) {
  std::vector<trajectory::StampedPose>& poses = result_.trajectory.poses;
  const double since_s = poses.empty() ? measured.captured_s : poses.back().t_s;
  if (!poses.empty() &&
      (measured.captured_s <= since_s || measured.captured_s - since_s < log_period_s_)) {
    return;
  }
  const geometry::Pose2& pose = measured.world_from_robot;
  poses.push_back({measured.captured_s, pose.x_m, pose.y_m, measured.z_m, measured.roll_rad,
                   measured.pitch_rad, pose.yaw_rad, target.x_m, target.y_m});
  std::vector<trajectory::Channel>& channels = result_.trajectory.channels;
  channels[kPowerLeft].values.push_back(decision.power.left);
  channels[kPowerRight].values.push_back(decision.power.right);
  channels[kV].values.push_back(decision.v);
  channels[kW].values.push_back(decision.w);
}

void Recorder::Sent(double now_s, const control::WheelPower& power) {
  if (result_.driving_s < 0.0 && !(power == control::WheelPower{})) result_.driving_s = now_s;
  result_.commands.push_back({now_s, power});
}

void Recorder::Decided(double now_s, const control::Decision& decision, size_t active_after) {
  for (; active_ < decision.waypoint; ++active_) {  // passed through, without a stop
    result_.visits[active_ - 1].reached_s = now_s;
  }
  WaypointVisit& visit = result_.visits[decision.waypoint - 1];
  visit.closest_m = std::min(visit.closest_m.value_or(decision.distance_m), decision.distance_m);
  if (decision.reached) {
    visit.reached_s = now_s;
    active_ = active_after;
    return;
  }
  Count(result_.limits, decision);
}

}  // namespace rift::trial
