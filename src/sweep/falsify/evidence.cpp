#include "rift/sweep/falsify/evidence.hpp"

#include <cmath>
#include <span>
#include <stdexcept>

#include "rift/control/navigator.hpp"
#include "rift/gap/comparison.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/trial/trial.hpp"

namespace rift::sweep {
namespace {

constexpr int kErrorSamples = 8;

/// The targets in the order in which the log turns to them, behind its first pose.
std::vector<control::Waypoint> LoggedTask(const trajectory::Trajectory& log) {
  const trajectory::StampedPose& first = log.poses.front();
  std::vector<control::Waypoint> task{{"start", first.x_m, first.y_m, {}, true}};
  for (const trajectory::StampedPose& pose : log.poses) {
    if (!std::isfinite(pose.target_x_m) || !std::isfinite(pose.target_y_m)) continue;
    const Eigen::Vector2d target{pose.target_x_m, pose.target_y_m};
    if (task.size() > 1 && task.back().Position() == target) continue;
    task.push_back({"target", target.x(), target.y(), {}, true});
  }
  return task;
}

/// With the samples of an EvenPath.
gap::GapOptions ForPictures(gap::GapOptions options) {
  options.samples = kPathSteps + 1;
  options.skip_start = 0.0;
  return options;
}

}  // namespace

void TrialEvidence::ForgetPath() {
  path_m = {};
  path_times_s = {};
}

std::uint64_t Fingerprint(const trajectory::Trajectory& path) {
  if (path.poses.empty()) return 0;
  std::vector<double> values;
  for (const trajectory::StampedPose& pose : path.poses) {
    for (const double value :
         {pose.x_m, pose.y_m, pose.z_m, pose.roll_rad, pose.pitch_rad, pose.yaw_rad}) {
      values.push_back(value + 0.0);  // -0 is the same place as 0
    }
  }
  const std::uint64_t hash = statistics::Hash64(std::as_bytes(std::span(values)));
  return hash == 0 ? 1 : hash;
}

std::vector<Eigen::Vector2d> ErrorsAlong(const trajectory::Trajectory& candidate,
                                         const trajectory::Trajectory& reference,
                                         const gap::GapOptions& options) {
  gap::GapOptions coarse = options;
  coarse.samples = kErrorSamples + 1;
  coarse.skip_start = 0.0;
  const gap::ErrorProfile profile = gap::ProfileAlong(candidate, reference, coarse);
  std::vector<Eigen::Vector2d> errors_m;
  for (size_t i = 1; i < profile.u.size(); ++i) {
    errors_m.push_back(profile.real_m[i] - profile.sim_m[i]);
  }
  return errors_m;
}

std::vector<Eigen::Vector2f> EvenPath(const trajectory::Trajectory& candidate,
                                      const trajectory::Trajectory& reference,
                                      const gap::GapOptions& options) {
  const gap::ErrorProfile profile = gap::ProfileAlong(candidate, reference, ForPictures(options));
  std::vector<Eigen::Vector2f> points_m;
  for (const Eigen::Vector2d& point_m : profile.sim_m) {
    points_m.emplace_back(point_m.cast<float>());
  }
  return points_m;
}

std::vector<Eigen::Vector2f> EvenPath(const trajectory::Trajectory& path,
                                      const gap::GapOptions& options) {
  gap::GapOptions as_it_is = options;
  as_it_is.align = gap::GapOptions{}.align;
  try {
    return EvenPath(path, path, as_it_is);
  } catch (const std::invalid_argument&) {
    return {};
  }
}

std::vector<float> EvenTimes_s(const trajectory::Trajectory& path, const gap::GapOptions& options) {
  try {
    const std::vector<double> times_s = gap::TimesAlong_s(path, ForPictures(options));
    return {times_s.begin(), times_s.end()};
  } catch (const std::invalid_argument&) {
    return {};
  }
}

std::optional<trial::LimitCounts> RebuildLimits(const trajectory::Trajectory& log,
                                                const control::NavigatorOptions& options,
                                                double tag_offset_m) {
  if (log.poses.size() < 2 || !log.HasYaw()) return std::nullopt;
  const trajectory::Trajectory tag = trajectory::OffsetAlongHeading(log, -tag_offset_m);
  const std::vector<control::Waypoint> task = LoggedTask(tag);
  if (task.size() < 2) return std::nullopt;
  control::Navigator navigator(options, task);
  trial::Recorder recorder(task, 0.0);
  double last_s = 2.0 * tag.poses[0].t_s - tag.poses[1].t_s;
  for (const trajectory::StampedPose& pose : tag.poses) {
    const control::Decision decision =
        navigator.Step({pose.t_s, pose.t_s - last_s, pose.t_s, pose.Planar()});
    if (decision.finished) break;
    navigator.NoteSent(pose.t_s, decision.power);
    recorder.Decided(pose.t_s, decision, navigator.active());
    last_s = pose.t_s;
  }
  return recorder.result().limits;
}

}  // namespace rift::sweep
