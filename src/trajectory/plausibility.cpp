#include "plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "rift/geometry/pose2.hpp"

namespace rift::trajectory {
namespace {

using geometry::kPi;

constexpr double kFarthest_m = 1e6;
constexpr double kLatest_s = 1e12;     // also tells the nanoseconds of a Unix clock
constexpr double kLargestAngle = 1e6;  // degrees or radians, unwrapped ones too

/// No robot rolls over, and a yaw that was not unwrapped stays within a turn, Webots' quarter
/// turn included.
constexpr double kTurn_rad = 2.0 * kPi;
/// An unwrapped yaw may be large, but not 159 turns; three turns in degrees are more.
constexpr double kLargestYaw_rad = 1000.0;

void CheckValue(double value, double limit, std::string_view column, const std::string& where,
                std::string_view question = "is the log in metres and seconds?") {
  if (!(std::abs(value) > limit)) return;
  throw std::invalid_argument(
      fmt::format("{}: {} is {:g}, beyond +-{:g}: {}", where, column, value, limit, question));
}

/// Largest absolute values that are logged; zero without any.
struct LargestAngles {
  explicit LargestAngles(const Trajectory& trajectory) {
    for (const StampedPose& pose : trajectory.poses) {
      Raise(roll_rad, pose.roll_rad);
      Raise(pitch_rad, pose.pitch_rad);
      Raise(yaw_rad, pose.yaw_rad);
    }
  }

  static void Raise(double& largest, double angle) {
    if (std::abs(angle) > largest) largest = std::abs(angle);
  }

  double roll_rad = 0.0, pitch_rad = 0.0, yaw_rad = 0.0;
};

/// Largest step of the yaw between two rows.
double LargestYawStep(const Trajectory& trajectory) {
  double largest = 0.0;
  for (size_t i = 1; i < trajectory.poses.size(); ++i) {
    const double step = std::abs(trajectory.poses[i].yaw_rad - trajectory.poses[i - 1].yaw_rad);
    if (step > largest) largest = step;
  }
  return largest;
}

/// By how much the direction of travel turns over the log; the chords are long enough for the
/// jitter of a standing robot not to count.
double PathTurn_rad(const Trajectory& trajectory) {
  constexpr double kChord_m = 0.05;
  Eigen::Vector2d anchor_m = trajectory.poses.front().Position();
  double first_rad = StampedPose::kNotLogged, left_rad = 0.0, right_rad = 0.0;
  for (const StampedPose& pose : trajectory.poses) {
    const Eigen::Vector2d chord_m = pose.Position() - anchor_m;
    if (chord_m.norm() < kChord_m) continue;
    const double heading_rad = std::atan2(chord_m.y(), chord_m.x());
    if (std::isnan(first_rad)) first_rad = heading_rad;
    left_rad = std::max(left_rad, geometry::WrapToPi(heading_rad - first_rad));
    right_rad = std::min(right_rad, geometry::WrapToPi(heading_rad - first_rad));
    anchor_m = pose.Position();
  }
  return left_rad - right_rad;
}

/// A yaw beyond a turn must have been unwrapped, and then it cannot step by more than half a turn.
bool YawLooksLikeDegrees(const Trajectory& trajectory, double largest) {
  return largest > kLargestYaw_rad || (largest > kTurn_rad && LargestYawStep(trajectory) > kPi);
}

void NoteDegrees(Log& log, const LargestAngles& angles) {
  const auto note = [&](std::string_view angle, double largest) {
    log.notes.push_back(
        fmt::format("a {} of {:.1f} rad looks like degrees: is it a tracker log?", angle, largest));
  };
  if (angles.roll_rad > kTurn_rad) return note("roll", angles.roll_rad);
  if (angles.pitch_rad > kTurn_rad) return note("pitch", angles.pitch_rad);
  if (YawLooksLikeDegrees(log.trajectory, angles.yaw_rad)) note("yaw", angles.yaw_rad);
}

/// A yaw within +-pi degrees spans 0.11 rad, so a path that turns by more was not logged in
/// degrees. The threshold is above that and below the 0.25 rad by which the paper's path turns.
void NoteRadians(Log& log, const LargestAngles& angles) {
  constexpr size_t kFewestRows = 20;
  constexpr double kTurning_rad = 0.15;
  const Trajectory& trajectory = log.trajectory;
  const double largest = std::max({angles.roll_rad, angles.pitch_rad, angles.yaw_rad});
  if (largest == 0.0 || largest > kPi || trajectory.poses.size() <= kFewestRows) return;
  if (PathTurn_rad(trajectory) < kTurning_rad) return;
  log.notes.push_back(
      fmt::format("the path turns and no angle exceeds {:.2f} degrees, which looks like radians: "
                  "is it a webots log?",
                  largest));
}

}  // namespace

void CheckMagnitudes(const StampedPose& pose, const std::string& name, int line) {
  const double farthest_m = std::max(std::abs(pose.x_m), std::abs(pose.y_m));
  const bool near = farthest_m <= kFarthest_m && !(std::abs(pose.z_m) > kFarthest_m);
  const bool turns = std::abs(pose.roll_rad) > kLargestAngle ||
                     std::abs(pose.pitch_rad) > kLargestAngle ||
                     std::abs(pose.yaw_rad) > kLargestAngle;
  if (near && !turns && std::abs(pose.t_s) <= kLatest_s) return;
  constexpr std::string_view kAngle = "is it an angle?";
  const std::string where = fmt::format("{}:{}", name, line);
  CheckValue(pose.t_s, kLatest_s, "t", where);
  CheckValue(pose.x_m, kFarthest_m, "x", where);
  CheckValue(pose.y_m, kFarthest_m, "y", where);
  CheckValue(pose.z_m, kFarthest_m, "z", where);
  CheckValue(pose.roll_rad, kLargestAngle, "roll", where, kAngle);
  CheckValue(pose.pitch_rad, kLargestAngle, "pitch", where, kAngle);
  CheckValue(pose.yaw_rad, kLargestAngle, "yaw", where, kAngle);
}

void NoteDoubtfulAngles(Log& log) {
  if (log.trajectory.poses.empty()) return;
  const LargestAngles largest(log.trajectory);
  if (log.format == Format::kRift || log.format == Format::kWebots) NoteDegrees(log, largest);
  if (log.format == Format::kTracker) NoteRadians(log, largest);
}

}  // namespace rift::trajectory
