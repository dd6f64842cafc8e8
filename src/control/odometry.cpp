#include "rift/control/odometry.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"

namespace rift::control {

double MetresPerCount(const OdometryOptions& options) {
  return 2.0 * geometry::kPi * options.drive.wheel_radius_m / options.counts_per_wheel_turn;
}

double YawPerCount_rad(const OdometryOptions& options) {
  return MetresPerCount(options) / options.drive.track_m;
}

Odometry::Odometry(const OdometryOptions& options, const geometry::Pose2& world_from_start)
    : track_m_(DiffDrive(options.drive).options().track_m),
      metres_per_count_(MetresPerCount(options)),
      world_from_robot_(world_from_start) {
  if (!std::isfinite(options.counts_per_wheel_turn) || options.counts_per_wheel_turn <= 0.0) {
    throw std::invalid_argument(
        fmt::format("counts_per_wheel_turn is {}, and it must be finite and above zero",
                    options.counts_per_wheel_turn));
  }
}

const geometry::Pose2& Odometry::Update(const EncoderCounts& counts) {
  if (last_) {
    const double left_m = metres_per_count_ * static_cast<double>(counts.left - last_->left);
    const double right_m = metres_per_count_ * static_cast<double>(counts.right - last_->right);
    world_from_robot_ =
        world_from_robot_ * ArcMotion(0.5 * (left_m + right_m), (right_m - left_m) / track_m_);
  }
  last_ = counts;
  return world_from_robot_;
}

}  // namespace rift::control
