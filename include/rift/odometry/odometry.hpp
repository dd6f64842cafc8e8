#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rift/control/diff_drive.hpp"
#include "rift/trajectory/trajectory.hpp"

/// What the wheel encoders say of a robot's path (paper, section 4.4).
namespace rift::odometry {

struct OdometryOptions {
  control::DiffDriveOptions drive;
  double right_over_left = 1.0;
  double counts_per_wheel_turn = 358.3;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("drive", self.drive, "wheels and track");
    field("right_over_left", self.right_over_left, 0.5, 2.0,
          "radius of the right wheel over that of the left one, wheel_radius_m being their mean "
          "(UMBmark's E_d; rift gap --calibrate-odometry finds it)");
    field("counts_per_wheel_turn", self.counts_per_wheel_turn, 1.0, 1e7,
          "encoder counts of one wheel turn (Pololu 0J86/6.4: 12 x 29.86 at 30:1)");
  }
};

/// What a wheel rolls in a count: the mean of both, the left one, the right one.
double MetresPerCount(const OdometryOptions& options);
double LeftMetresPerCount(const OdometryOptions& options);
double RightMetresPerCount(const OdometryOptions& options);
/// What the robot turns by when the right wheel is a count ahead of the left one.
double YawPerCount_rad(const OdometryOptions& options);

/// Where the wheels say the robot went. Between two readings both wheels are taken to turn
/// steadily, so the robot follows one exact arc.
class Odometry {
 public:
  /// Throws std::invalid_argument unless all options are finite and above zero.
  explicit Odometry(const OdometryOptions& options, const geometry::Pose2& world_from_start = {});

  /// The pose after a reading; the first reading only sets the zero of both counters.
  const geometry::Pose2& Update(const control::EncoderCounts& counts);
  const geometry::Pose2& world_from_robot() const { return world_from_robot_; }

 private:
  double left_m_per_count_;
  double right_m_per_count_;
  double track_m_;
  geometry::Pose2 world_from_robot_;
  std::optional<control::EncoderCounts> last_;
};

/// The wheels at one moment.
struct EncoderReading {
  double t_s = 0.0;  ///< on the clock of the poses
  control::EncoderCounts counts;
  double battery_v = trajectory::StampedPose::kNotLogged;
};

/// Counts, left and right, at `t_s` between two readings; none outside of them.
std::optional<std::pair<double, double>> CountsAt(const std::vector<EncoderReading>& readings,
                                                  double t_s);

/// Where the wheels say the robot was at each reading.
trajectory::Trajectory OdometryPath(const std::vector<EncoderReading>& readings,
                                    const OdometryOptions& options,
                                    const geometry::Pose2& world_from_start);

/// encoders.csv: its header, a row of it, all of it.
std::string EncodersHeader();
std::string EncodersRow(const EncoderReading& reading);
std::string EncodersCsv(const std::vector<EncoderReading>& readings);
/// Throws std::invalid_argument `name:line: what is wrong`: columns that are missing, times that do
/// not rise, fewer than two readings.
std::vector<EncoderReading> ReadEncoders(std::string_view text, const std::string& name);

}  // namespace rift::odometry
