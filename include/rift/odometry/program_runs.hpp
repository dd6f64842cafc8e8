#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rift/odometry/calibration.hpp"
#include "rift/odometry/odometry.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/trajectory/trajectory.hpp"

/// How far runs of one program stray from it and from each other (paper, sections 5.2 and 6.2,
/// figure 14).
namespace rift::odometry {

struct RunOptions {
  int slip_bins = 20;
  double moved_share = 0.1;
  double tag_ahead_m = 0.0;  ///< the camera's point is so far ahead of the axle: its tag

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("slip_bins", self.slip_bins, 1, 1000,
          "parts of a run over which the slip of a wheel is taken");
    field("moved_share", self.moved_share, 0.0, 1.0,
          "a run that got less far from its start than this share of its program did not move");
  }
};

/// Slip ratio of both wheels over one part of a run: 1 - (way over the ground) / (way rolled), 0
/// for a wheel that rolls, 1 for one that spins, below 0 for one that is dragged. NaN where the
/// wheel did not turn.
struct Slip {
  double u = 0.0;  ///< middle of the part, as a share of what both wheels rolled
  double left = 0.0;
  double right = 0.0;
};

/// One run. Numbers are NaN where there is nothing to measure them by: without a program, without
/// encoders, or when the robot did not move.
struct RunMeasures {
  bool did_move = true;
  double length_m = 0.0;  ///< of the camera's path, without the jitter of a standing robot
  /// Mean, and largest, distance between camera and program at equal normalised arc length.
  double deviation_m = trajectory::StampedPose::kNotLogged;
  double largest_deviation_m = trajectory::StampedPose::kNotLogged;
  double end_error_m = trajectory::StampedPose::kNotLogged;  ///< from the program's end
  /// Distance between odometry and camera: at the end, over the length of what both logged; the
  /// largest at equal time.
  double drift_per_m = trajectory::StampedPose::kNotLogged;
  double odometry_gap_m = trajectory::StampedPose::kNotLogged;
  /// Turn of the odometry beyond that of the camera.
  double yaw_drift_rad = trajectory::StampedPose::kNotLogged;
  double slip_left = trajectory::StampedPose::kNotLogged;  ///< over the whole run
  double slip_right = trajectory::StampedPose::kNotLogged;
  std::vector<Slip> slip;
};

/// The way of the axle in a trial, which begins with the robot's tag, and not its axle, at the
/// start of the program.
trajectory::Trajectory OfAxle(trajectory::Trajectory program, double tag_ahead_m);

/// Throws std::invalid_argument for a run of which no row has a yaw where encoders or a tag ahead
/// of the axle are given, or fewer than two rows share their time with the encoders.
RunMeasures MeasureRun(const RunLog& run, const std::optional<trajectory::Trajectory>& program,
                       const OdometryOptions& odometry, const RunOptions& options);

/// How the spread of a cell is defined, in one line to stand beside the number.
std::string SpreadText();

/// Repeats of one program under the same conditions.
struct CellMeasures {
  std::size_t runs = 0;
  std::size_t moved = 0;                                     ///< the others count in nothing below
  double deviation_m = trajectory::StampedPose::kNotLogged;  ///< mean over the runs
  statistics::Interval deviation_interval_m;                 ///< of that mean, Student's t, 95 %
  double spread_m = trajectory::StampedPose::kNotLogged;
  double drift_per_m = trajectory::StampedPose::kNotLogged;
  double odometry_gap_m = trajectory::StampedPose::kNotLogged;
  double slip_left = trajectory::StampedPose::kNotLogged;
  double slip_right = trajectory::StampedPose::kNotLogged;
  std::vector<Slip> slip;  ///< mean over the runs

  bool DidMove() const { return 2 * moved > runs; }
};

/// `paths`: the camera's, one for each of `runs`.
CellMeasures MeasureCell(std::span<const RunMeasures> runs,
                         std::span<const trajectory::Trajectory> paths);

/// What camera, encoders and program of some runs say of each other.
struct OdometryResult {
  struct Run {
    std::string name;
    RunMeasures measures;
  };

  std::vector<Run> runs;
  std::optional<CellMeasures> cell;  ///< with two runs or more, all of one program
  std::optional<Umbmark> umbmark;
  std::optional<OdometryCalibration> calibration;
  double confidence = 0.95;  ///< of its intervals
};

/// A run, the path of the program that it drove, and the robot that drove it.
struct ProgramRun {
  RunLog log;
  std::optional<trajectory::Trajectory> program;
  OdometryOptions wheels{};
  double tag_ahead_m = 0.0;  ///< takes the place of RunOptions::tag_ahead_m
};

/// The same wheels, with the tag in the same place.
bool AreOfOneRobot(std::span<const ProgramRun> runs);

/// Everything but the calibration, each run by its own wheels and tag. `same_program`: the runs are
/// repeats of one. UMBmark is of runs of one robot.
OdometryResult MeasureRuns(std::span<const ProgramRun> runs, bool same_program,
                           const RunOptions& options);

/// Mean over 101 evenly spaced u of sqrt(sx^2 + sy^2), sx and sy being the standard deviations
/// (n-1) of x and y over the paths at that u. NaN for fewer than two.
double Spread_m(std::span<const trajectory::Trajectory> paths);

}  // namespace rift::odometry
