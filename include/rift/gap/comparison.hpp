#pragma once

#include <Eigen/Core>
#include <vector>

#include "rift/gap/options.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/geometry/pose3.hpp"
#include "rift/statistics/not_computed.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

using statistics::kNotComputed;

/// The gap and everything that helps to read it, over x and y, or with `dimension` xyz over x, y
/// and z. Yaw errors are of the logged yaws in both; in space they are NaN once the path is turned
/// (align se3), since a yaw alone cannot be turned in space. Errors are distances between the two
/// paths at equal normalised arc length u unless a name says otherwise; NaN where it could not be
/// computed. What the options change:
///   skip_start       the gaps (all four) and the errors (mean to p95, yaw); nothing else
///   align            everything but the lengths and the standstill shares; real_from_sim and the
///                    two gaps computed with a motion of their own start from the aligned path
///   trim_standstill  everything but the standstill shares, which are of the whole log
/// So start offset, end error, lengths, Hausdorff, Frechet, DTW and equal time see the whole path
/// whatever skip_start is.
struct Comparison {
  double gap_m = kNotComputed;        ///< largest error over the samples (paper, section 3.1)
  double gap_u = kNotComputed;        ///< where along the path it stands, u in [0, 1]
  double exact_gap_m = kNotComputed;  ///< supremum over the polylines, never below gap_m
  double exact_gap_u = kNotComputed;

  double mean_error_m = kNotComputed;
  double rms_error_m = kNotComputed;
  double median_error_m = kNotComputed;
  double p95_error_m = kNotComputed;
  double max_yaw_error_rad = kNotComputed;  ///< where both yaws are known; NaN: nowhere
  double mean_yaw_error_rad = kNotComputed;

  double sim_length_m = kNotComputed;
  double real_length_m = kNotComputed;
  double length_ratio = kNotComputed;    ///< sim / real
  double start_offset_m = kNotComputed;  ///< between the first points
  double end_error_m = kNotComputed;     ///< between the last points

  double start_aligned_gap_m = kNotComputed;  ///< gap with the first points laid together
  double shape_gap_m = kNotComputed;          ///< gap left after the best rigid motion
  geometry::Pose2 real_from_sim;              ///< that motion; NaN in space: BestMotionInSpace()

  /// Of the arc length, logged while standing; 1 of a robot that never left its place.
  double sim_standstill_share = kNotComputed;
  double real_standstill_share = kNotComputed;

  /// Largest distance of a vertex to the closest point of the other path. A path of more than 500
  /// vertices is looked at in 500 evenly spaced points instead.
  double hausdorff_m = kNotComputed;
  /// Discrete Frechet distance (Eiter and Mannila 1994) of the points of both paths at each u at
  /// which one of them has such a vertex, and at 160 even ones where these are fewer. Never below
  /// hausdorff_m, nor above the exact gap of the whole paths.
  double frechet_m = kNotComputed;
  /// Mean distance of 160 evenly spaced points along the best time warping.
  double dtw_m = kNotComputed;
  double equal_time_m = kNotComputed;  ///< largest distance at equal time since the first row
};

/// Compares two paths of at least two poses and non-zero length. Throws std::invalid_argument when
/// a path does not move, its length is not finite, or in space a pose has no height.
Comparison Compare(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
                   const GapOptions& options);

/// The gap alone: what Compare gives as gap_m, in about a microsecond for 80 rows.
double Gap(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
           const GapOptions& options);

/// Error along the path, one entry a sample; yaw_error_rad is NaN where a yaw is not known.
struct ErrorProfile {
  std::vector<double> u;
  std::vector<double> error_m;
  std::vector<double> yaw_error_rad;
  std::vector<Eigen::Vector2d> sim_m;  ///< the points compared, after trimming and aligning
  std::vector<Eigen::Vector2d> real_m;
  std::vector<double> sim_z_m;  ///< their heights; empty in the plane
  std::vector<double> real_z_m;
};

ErrorProfile ProfileAlong(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
                          const GapOptions& options);

/// When a path passes the samples, in s since its first pose, after trimming; where it stands, the
/// end of the stop. Throws as Compare does.
std::vector<double> TimesAlong_s(const trajectory::Trajectory& path, const GapOptions& options);

/// Arc length of a path of at least one pose without the jitter of a standing robot: within
/// options.standstill_radius_m of both ends only how far it led counts; 0 where it never leaves.
double MovingLength_m(const trajectory::Trajectory& path, const GapOptions& options);

/// The rigid motion in space that brings `sim` closest to `real`, after which the shape gap is left
/// (dimension xyz).
geometry::Pose3 BestMotionInSpace(const trajectory::Trajectory& sim,
                                  const trajectory::Trajectory& real, const GapOptions& options);

}  // namespace rift::gap
