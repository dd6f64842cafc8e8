#pragma once

#include <optional>

#include "rift/control/diff_drive.hpp"

namespace rift::control {

struct OdometryOptions {
  DiffDriveOptions drive;
  double counts_per_wheel_turn = 358.3;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("drive", self.drive, "wheels and track");
    field("counts_per_wheel_turn", self.counts_per_wheel_turn, 1.0, 1e7,
          "encoder counts of one wheel turn (Pololu 0J86/6.4: 12 x 29.86 at 30:1)");
  }
};

/// What a wheel rolls in a count.
double MetresPerCount(const OdometryOptions& options);
/// What the robot turns by when the right wheel is a count ahead of the left one.
double YawPerCount_rad(const OdometryOptions& options);

/// Where the wheels say the robot went. Between two readings both wheels are taken to turn
/// steadily, so the robot follows one exact arc.
class Odometry {
 public:
  /// Throws std::invalid_argument unless all options are finite and above zero.
  explicit Odometry(const OdometryOptions& options, const geometry::Pose2& world_from_start = {});

  /// The pose after a reading; the first reading only sets the zero of both counters.
  const geometry::Pose2& Update(const EncoderCounts& counts);
  const geometry::Pose2& world_from_robot() const { return world_from_robot_; }

 private:
  double track_m_;
  double metres_per_count_;
  geometry::Pose2 world_from_robot_;
  std::optional<EncoderCounts> last_;
};

}  // namespace rift::control
