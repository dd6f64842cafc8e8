#include "rift/odometry/program_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/gap/comparison.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/odometry/readings_during.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::odometry {
namespace {

using geometry::Pose2;
using trajectory::Trajectory;

constexpr int kSpreadPoints = 101;

/// What a standing robot's camera logs before and after the run is no path.
gap::GapOptions AlongMoving() {
  gap::GapOptions options;
  options.trim_standstill = true;
  return options;
}

/// The largest distance of a path from where it began.
double Reach_m(const Trajectory& path) {
  double reach_m = 0.0;
  for (const trajectory::StampedPose& pose : path.poses) {
    reach_m = std::max(reach_m, (pose.Position() - path.poses.front().Position()).norm());
  }
  return reach_m;
}

/// Between the furthest turns to the left and to the right. A turn that is taken back counts, and
/// the noise of a yaw does not add up.
double Swept_rad(const Trajectory& path) {
  double at_rad = 0.0, least_rad = 0.0, most_rad = 0.0;
  std::optional<double> last_rad;
  for (const trajectory::StampedPose& pose : path.poses) {
    if (!std::isfinite(pose.yaw_rad)) continue;
    at_rad += geometry::WrapToPi(pose.yaw_rad - last_rad.value_or(pose.yaw_rad));
    last_rad = pose.yaw_rad;
    least_rad = std::min(least_rad, at_rad);
    most_rad = std::max(most_rad, at_rad);
  }
  return most_rad - least_rad;
}

/// A program that only turns on the spot has no way to be held against.
bool HasWay(const Trajectory& program) {
  constexpr double kNoWay_m = 0.01;
  return Reach_m(program) > kNoWay_m;
}

/// A program that only turns on the spot is judged by its turn.
bool DidMove(const Trajectory& camera, const Trajectory& program, double share) {
  return HasWay(program) ? Reach_m(camera) >= share * Reach_m(program)
                         : Swept_rad(camera) >= share * Swept_rad(program);
}

/// The robot in step with the camera: pose of the axle, and what the wheels have rolled by then.
struct Moment {
  double t_s;
  Pose2 world_from_robot;
  double left_m;
  double right_m;
};

std::vector<Moment> MomentsOf(const RunLog& run, const OdometryOptions& odometry,
                              double tag_ahead_m) {
  const Pose2 tag_from_robot{-tag_ahead_m, 0.0, 0.0};
  std::vector<Moment> moments;
  for (const trajectory::StampedPose& pose : run.camera.poses) {
    const auto counts = CountsAt(run.encoders, pose.t_s);
    if (!counts) continue;
    moments.push_back({pose.t_s, pose.Planar() * tag_from_robot,
                       LeftMetresPerCount(odometry) * counts->first,
                       RightMetresPerCount(odometry) * counts->second});
  }
  if (moments.size() >= 2) return moments;
  throw std::invalid_argument(fmt::format(
      "{}: the poses with a yaw and the encoder readings share {} moment(s): they must be of one "
      "run and on one clock",
      run.name, moments.size()));
}

/// What a wheel rolled, and how far it went over the ground in that direction.
struct Way {
  double rolled_m = 0.0;
  double ground_m = 0.0;

  void Add(double rolled, double ground) {
    rolled_m += std::abs(rolled);
    ground_m += std::copysign(1.0, rolled) * ground;
  }
  double Slip() const {
    constexpr double kStill_m = 1e-3;
    return rolled_m > kStill_m ? 1.0 - ground_m / rolled_m : gap::kNotComputed;
  }
};

/// Slip from moment to moment: the wheels' ways over the ground are those of an arc between poses.
void MeasureSlip(const std::vector<Moment>& moments, double track_m, int bins,
                 RunMeasures& measures) {
  std::vector<double> rolled_m{0.0};
  for (std::size_t i = 1; i < moments.size(); ++i) {
    rolled_m.push_back(rolled_m.back() + std::abs(moments[i].left_m - moments[i - 1].left_m) +
                       std::abs(moments[i].right_m - moments[i - 1].right_m));
  }
  std::vector<Way> left(static_cast<std::size_t>(bins)), right = left;
  Way all_left, all_right;
  for (std::size_t i = 1; i < moments.size(); ++i) {
    const Pose2 motion =
        geometry::Inverse(moments[i - 1].world_from_robot) * moments[i].world_from_robot;
    const double half_rad = 0.5 * motion.yaw_rad;
    const double ahead_m = motion.x_m * std::cos(half_rad) + motion.y_m * std::sin(half_rad);
    const double middle = 0.5 * (rolled_m[i - 1] + rolled_m[i]) / std::max(1e-12, rolled_m.back());
    const auto bin =
        static_cast<std::size_t>(std::clamp(static_cast<int>(middle * bins), 0, bins - 1));
    const auto add = [&](Way& part, Way& all, double rolled, double ground) {
      part.Add(rolled, ground);
      all.Add(rolled, ground);
    };
    add(left[bin], all_left, moments[i].left_m - moments[i - 1].left_m,
        ahead_m - half_rad * track_m);
    add(right[bin], all_right, moments[i].right_m - moments[i - 1].right_m,
        ahead_m + half_rad * track_m);
  }
  measures.slip_left = all_left.Slip();
  measures.slip_right = all_right.Slip();
  for (std::size_t i = 0; i < left.size(); ++i) {
    measures.slip.push_back(
        {(static_cast<double>(i) + 0.5) / bins, left[i].Slip(), right[i].Slip()});
  }
}

Trajectory AsPath(const std::vector<Moment>& moments) {
  Trajectory path;
  for (const Moment& moment : moments) {
    const Pose2& at = moment.world_from_robot;
    path.poses.push_back({.t_s = moment.t_s, .x_m = at.x_m, .y_m = at.y_m, .yaw_rad = at.yaw_rad});
  }
  return path;
}

void MeasureOdometry(const RunLog& run, const OdometryOptions& odometry, const RunOptions& options,
                     bool has_way, RunMeasures& measures) {
  const std::vector<Moment> moments =
      MomentsOf({run.name, WithYaw(run), run.encoders}, odometry, options.tag_ahead_m);
  const Pose2 start = OdometryStart(run) * Pose2{-options.tag_ahead_m, 0.0, 0.0};
  const Trajectory path = OdometryPath(ReadingsDuring(WithYaw(run), run.encoders), odometry, start);
  measures.odometry_gap_m = 0.0;
  std::size_t at = 0;
  Pose2 odometry_end = start;
  for (const Moment& moment : moments) {
    while (at + 1 < path.poses.size() && path.poses[at + 1].t_s <= moment.t_s) ++at;
    Pose2 here = path.poses[at].Planar();
    if (at + 1 < path.poses.size()) {
      const double share = std::clamp(
          (moment.t_s - path.poses[at].t_s) / (path.poses[at + 1].t_s - path.poses[at].t_s), 0.0,
          1.0);
      const Pose2 step = geometry::Inverse(here) * path.poses[at + 1].Planar();
      here = here * Pose2{share * step.x_m, share * step.y_m, share * step.yaw_rad};
    }
    odometry_end = here;
    measures.odometry_gap_m = std::max(
        measures.odometry_gap_m, (here.Position() - moment.world_from_robot.Position()).norm());
  }
  const Pose2& camera_end = moments.back().world_from_robot;
  const double length_m = gap::MovingLength_m(AsPath(moments), AlongMoving());
  if (has_way && length_m > 0.0) {
    measures.drift_per_m = (odometry_end.Position() - camera_end.Position()).norm() / length_m;
  }
  measures.yaw_drift_rad = geometry::WrapToPi(odometry_end.yaw_rad - camera_end.yaw_rad);
  MeasureSlip(moments, odometry.drive.track_m, options.slip_bins, measures);
}

void MeasureDeviation(const Trajectory& axle, const Trajectory& ideal, RunMeasures& measures) {
  const gap::Comparison compared = gap::Compare(axle, ideal, AlongMoving());
  measures.deviation_m = compared.mean_error_m;
  measures.largest_deviation_m = compared.gap_m;
}

template <class Number>
double MeanOver(std::span<const RunMeasures> runs, Number RunMeasures::*number) {
  std::vector<double> values;
  for (const RunMeasures& run : runs) {
    if (run.did_move) values.push_back(run.*number);
  }
  return statistics::MeanOfKnown(values);
}

}  // namespace

Trajectory OfAxle(Trajectory program, double tag_ahead_m) {
  const Eigen::Vector2d back_m = -tag_ahead_m * program.poses.front().Planar().Forward();
  for (trajectory::StampedPose& pose : program.poses) {
    pose.x_m += back_m.x();
    pose.y_m += back_m.y();
  }
  return program;
}

RunMeasures MeasureRun(const RunLog& run, const std::optional<Trajectory>& program,
                       const OdometryOptions& odometry, const RunOptions& options) {
  RunMeasures measures;
  if (program && !DidMove(run.camera, *program, options.moved_share)) {
    measures.did_move = false;
    return measures;
  }
  Trajectory axle = run.camera;
  if (options.tag_ahead_m != 0.0) {
    axle = trajectory::OffsetAlongHeading(WithYaw(run), -options.tag_ahead_m);
  }
  measures.length_m = gap::MovingLength_m(axle, AlongMoving());
  const bool has_way = !program || HasWay(*program);
  if (program) {
    const Trajectory ideal = OfAxle(*program, options.tag_ahead_m);
    measures.end_error_m = (axle.poses.back().Position() - ideal.poses.back().Position()).norm();
    if (has_way) MeasureDeviation(axle, ideal, measures);
  }
  if (!run.encoders.empty()) MeasureOdometry(run, odometry, options, has_way, measures);
  return measures;
}

std::string SpreadText() {
  return fmt::format(
      "spread: mean over {} evenly spaced u of sqrt(sx^2 + sy^2), sx and sy being the standard "
      "deviations (n-1) of x and y over the repeats at that u",
      kSpreadPoints);
}

double Spread_m(std::span<const Trajectory> paths) {
  if (paths.size() < 2) return gap::kNotComputed;
  gap::GapOptions options = AlongMoving();
  options.samples = kSpreadPoints;
  std::vector<gap::ErrorProfile> profiles;
  for (const Trajectory& path : paths) {
    profiles.push_back(gap::ProfileAlong(path, path, options));
  }
  std::vector<double> spreads_m;
  for (std::size_t k = 0; k < profiles.front().u.size(); ++k) {
    std::vector<double> x, y;
    for (const gap::ErrorProfile& profile : profiles) {
      x.push_back(profile.sim_m[k].x());
      y.push_back(profile.sim_m[k].y());
    }
    spreads_m.push_back(
        std::hypot(statistics::StandardDeviation(x), statistics::StandardDeviation(y)));
  }
  return statistics::Mean(spreads_m);
}

CellMeasures MeasureCell(std::span<const RunMeasures> runs, std::span<const Trajectory> paths) {
  CellMeasures cell{.runs = runs.size()};
  std::vector<Trajectory> moved;
  std::vector<double> deviations_m;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!runs[i].did_move) continue;
    moved.push_back(paths[i]);
    if (!std::isnan(runs[i].deviation_m)) deviations_m.push_back(runs[i].deviation_m);
  }
  cell.moved = moved.size();
  if (moved.empty()) return cell;
  cell.deviation_m = statistics::Mean(deviations_m);
  cell.deviation_interval_m = statistics::MeanInterval(deviations_m, 0.95);
  if (!deviations_m.empty()) cell.spread_m = Spread_m(moved);  // along a way
  cell.drift_per_m = MeanOver(runs, &RunMeasures::drift_per_m);
  cell.odometry_gap_m = MeanOver(runs, &RunMeasures::odometry_gap_m);
  cell.slip_left = MeanOver(runs, &RunMeasures::slip_left);
  cell.slip_right = MeanOver(runs, &RunMeasures::slip_right);
  for (const RunMeasures& run : runs) {
    if (cell.slip.size() < run.slip.size()) cell.slip = run.slip;
  }
  for (std::size_t k = 0; k < cell.slip.size(); ++k) {
    std::vector<double> left, right;
    for (const RunMeasures& run : runs) {
      if (!run.did_move || k >= run.slip.size()) continue;
      left.push_back(run.slip[k].left);
      right.push_back(run.slip[k].right);
    }
    cell.slip[k].left = statistics::MeanOfKnown(left);
    cell.slip[k].right = statistics::MeanOfKnown(right);
  }
  return cell;
}

bool AreOfOneRobot(std::span<const ProgramRun> runs) {
  return std::all_of(runs.begin(), runs.end(), [&](const ProgramRun& run) {
    const OdometryOptions &a = run.wheels, &b = runs.front().wheels;
    return LeftMetresPerCount(a) == LeftMetresPerCount(b) &&
           RightMetresPerCount(a) == RightMetresPerCount(b) && a.drive.track_m == b.drive.track_m &&
           run.tag_ahead_m == runs.front().tag_ahead_m;
  });
}

OdometryResult MeasureRuns(std::span<const ProgramRun> runs, bool same_program,
                           const RunOptions& options) {
  OdometryResult result;
  std::vector<RunMeasures> measures;
  std::vector<Trajectory> cameras;
  std::vector<RunLog> with_encoders;
  for (const ProgramRun& run : runs) {
    RunOptions of_run = options;
    of_run.tag_ahead_m = run.tag_ahead_m;
    measures.push_back(MeasureRun(run.log, run.program, run.wheels, of_run));
    result.runs.push_back({run.log.name, measures.back()});
    cameras.push_back(run.log.camera);
    if (!run.log.encoders.empty() && measures.back().did_move) with_encoders.push_back(run.log);
  }
  if (same_program && runs.size() > 1) result.cell = MeasureCell(measures, cameras);
  if (AreOfOneRobot(runs)) {
    result.umbmark = UmbmarkOf(with_encoders, runs.front().wheels, runs.front().tag_ahead_m);
  }
  return result;
}

}  // namespace rift::odometry
