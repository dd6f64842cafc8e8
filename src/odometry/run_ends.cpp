#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"
#include "rift/odometry/calibration.hpp"
#include "rift/odometry/readings_during.hpp"

namespace rift::odometry {
namespace {

using geometry::Pose2;
using trajectory::StampedPose;
using trajectory::Trajectory;

/// On the straight line between the rows around that moment.
Pose2 PoseAt(const Trajectory& seen, double t_s) {
  const auto after =
      std::lower_bound(seen.poses.begin(), seen.poses.end(), t_s,
                       [](const StampedPose& pose, double moment) { return pose.t_s < moment; });
  if (after == seen.poses.end()) return seen.poses.back().Planar();
  if (after == seen.poses.begin() || after->t_s == t_s) return after->Planar();
  const StampedPose &from = *(after - 1), &to = *after;
  const double share = (t_s - from.t_s) / (to.t_s - from.t_s);
  return {from.x_m + share * (to.x_m - from.x_m), from.y_m + share * (to.y_m - from.y_m),
          geometry::WrapToPi(from.yaw_rad + share * geometry::WrapToPi(to.yaw_rad - from.yaw_rad))};
}

/// Whether it is seen away from there at that moment, in two rows after one another: in one alone
/// it may be the tracker that jumps.
bool HasLeft(const Trajectory& seen, const Pose2& stood, double t_s) {
  const auto is_away = [&](const Pose2& pose) {
    return (pose.Position() - stood.Position()).norm() > trajectory::kStandingRadius_m ||
           std::abs(geometry::WrapToPi(pose.yaw_rad - stood.yaw_rad)) >
               trajectory::kStandingTurn_rad;
  };
  if (t_s <= seen.poses.front().t_s || !is_away(PoseAt(seen, t_s))) return false;
  const auto end = seen.poses.end();
  const auto after =
      std::upper_bound(seen.poses.begin(), end, t_s,
                       [](double moment, const StampedPose& pose) { return moment < pose.t_s; });
  if (after == end) return true;
  const bool is_before = is_away((after - 1)->Planar());
  return is_away(after->Planar()) &&
         (is_before || after + 1 == end || is_away((after + 1)->Planar()));
}

}  // namespace

Trajectory WithYaw(const RunLog& run) {
  Trajectory seen;
  std::copy_if(run.camera.poses.begin(), run.camera.poses.end(), std::back_inserter(seen.poses),
               [](const StampedPose& pose) { return std::isfinite(pose.yaw_rad); });
  if (!seen.poses.empty()) return seen;
  throw std::invalid_argument(fmt::format(
      "{}: no row has a yaw, and odometry goes from the heading of the robot: log yaw_rad",
      run.name));
}

Pose2 OdometryStart(const RunLog& run) {
  const Trajectory seen = WithYaw(run);
  const Pose2 stood = trajectory::StandingPose(seen);
  const std::vector<EncoderReading> during = ReadingsDuring(seen, run.encoders);
  if (during.empty() || !HasLeft(seen, stood, during.front().t_s)) return stood;
  return PoseAt(seen, during.front().t_s);
}

Pose2 OdometryEnd(const RunLog& run) {
  const Trajectory seen = WithYaw(run);
  const std::vector<EncoderReading> during = ReadingsDuring(seen, run.encoders);
  return during.empty() ? seen.poses.back().Planar() : PoseAt(seen, during.back().t_s);
}

std::optional<Umbmark> UmbmarkOf(std::span<const RunLog> runs, const OdometryOptions& options,
                                 double tag_ahead_m) {
  const Pose2 tag_from_axle{-tag_ahead_m, 0.0, 0.0};
  Umbmark found;
  for (const RunLog& run : runs) {
    const trajectory::Trajectory path =
        OdometryPath(ReadingsDuring(WithYaw(run), run.encoders), options, {});
    double turned_rad = 0.0;
    for (std::size_t i = 1; i < path.poses.size(); ++i) {
      turned_rad += geometry::WrapToPi(path.poses[i].yaw_rad - path.poses[i - 1].yaw_rad);
    }
    if (std::abs(turned_rad) < geometry::kPi) continue;
    const Pose2 start_from_end =
        geometry::Inverse(OdometryStart(run) * tag_from_axle) * (OdometryEnd(run) * tag_from_axle);
    const Eigen::Vector2d error_m = path.poses.back().Position() - start_from_end.Position();
    (turned_rad > 0.0 ? found.ccw_m : found.cw_m) += error_m;
    ++(turned_rad > 0.0 ? found.ccw_runs : found.cw_runs);
  }
  if (found.ccw_runs == 0 || found.cw_runs == 0) return std::nullopt;
  found.ccw_m /= static_cast<double>(found.ccw_runs);
  found.cw_m /= static_cast<double>(found.cw_runs);
  found.largest_m = std::max(found.ccw_m.norm(), found.cw_m.norm());
  return found;
}

}  // namespace rift::odometry
