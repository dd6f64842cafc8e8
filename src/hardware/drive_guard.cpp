#include "rift/hardware/drive_guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"

namespace rift::hardware {
namespace {

constexpr double kFuture_s = 0.02;  // a clock may be read a little before the frame is stamped

bool IsFinite(const trial::PoseMeasurement& pose) {
  return std::isfinite(pose.captured_s) && pose.world_from_robot.IsFinite();
}

}  // namespace

void DriveGuard::Arm(double now_s) {
  if (!pose_ || now_s - pose_->captured_s > options_.pose_stale_s) {
    throw std::runtime_error(pose_ ? fmt::format("cannot arm: the robot was last seen {:.2f} s ago",
                                                 now_s - pose_->captured_s)
                                   : "cannot arm: the robot has not been seen yet");
  }
  state_ = DriveState::kArmed;
  stop_.reset();
  power_ = {};
  commanded_s_ = now_s;
  ticked_s_ = now_s;
  robot_stops_.reset();
}

void DriveGuard::Stop(StopReason reason, std::string text, double now_s) {
  power_ = {};
  if (state_ == DriveState::kStopped) return;
  state_ = DriveState::kStopped;
  stop_ = DriveStop{reason, std::move(text), now_s};
}

// Before anything else is looked at: after a standstill everything is old.
void DriveGuard::NoteTime(double now_s) {
  const double since_s = ticked_s_ ? now_s - *ticked_s_ : 0.0;
  ticked_s_ = now_s;
  if (state_ == DriveState::kArmed && (since_s > options_.host_stall_s || since_s < 0.0)) {
    Stop(StopReason::kHostStalled, fmt::format("rift itself stood still for {:.2f} s", since_s),
         now_s);
  }
}

void DriveGuard::SeePose(const PoseNews& news, double now_s) {
  NoteTime(now_s);
  if (news.fault) Stop(StopReason::kCameraGone, *news.fault, now_s);
  if (news.looked_s) looked_s_ = news.looked_s;
  if (!news.newest) return;
  const trial::PoseMeasurement& pose = news.newest->measured;
  if (!IsFinite(pose) || pose.captured_s > now_s + kFuture_s) {
    return Stop(StopReason::kPoseNotFinite,
                "the camera gave a pose that is not finite or lies in the future", now_s);
  }
  if (pose_ && state_ == DriveState::kArmed && pose.captured_s < pose_->captured_s) {
    return Stop(StopReason::kTimeBackwards,
                fmt::format("a picture was taken {:.3f} s before the one that came before it",
                            pose_->captured_s - pose.captured_s),
                now_s);
  }
  if (pose_ && pose.captured_s <= pose_->captured_s) return;
  if (pose_ && state_ == DriveState::kArmed) CheckJump(*pose_, pose, now_s);
  pose_ = pose;
}

void DriveGuard::CheckJump(const trial::PoseMeasurement& before, const trial::PoseMeasurement& pose,
                           double now_s) {
  const double elapsed_s = pose.captured_s - before.captured_s;
  const double moved_m =
      (pose.world_from_robot.Position() - before.world_from_robot.Position()).norm();
  const double turned_deg = geometry::DegFromRad(std::abs(
      geometry::WrapToPi(pose.world_from_robot.yaw_rad - before.world_from_robot.yaw_rad)));
  if (moved_m <= options_.jump_m + options_.max_speed_mps * elapsed_s &&
      turned_deg <= options_.jump_deg) {
    return;
  }
  Stop(StopReason::kPoseJump,
       fmt::format("the pose jumped by {:.3f} m and {:.0f} deg within {:.3f} s", moved_m,
                   turned_deg, elapsed_s),
       now_s);
}

void DriveGuard::Command(const control::WheelPower& power, double now_s) {
  const double largest = std::max(std::abs(power.left), std::abs(power.right));
  NoteTime(now_s);
  commanded_s_ = now_s;
  if (!std::isfinite(power.left) || !std::isfinite(power.right) || largest > options_.max_power) {
    return Stop(StopReason::kPowerRefused,
                fmt::format("the controller asked for the powers {} and {}, and the limit is {}",
                            power.left, power.right, options_.max_power),
                now_s);
  }
  const bool moves = largest > 0.0;
  if (moves && state_ == DriveState::kDisarmed) {
    return Stop(StopReason::kNotArmed, "a power was commanded before the drive was armed", now_s);
  }
  if (moves && !RequireFreshPose(now_s)) return;
  power_ = power;
}

bool DriveGuard::RequireFreshPose(double now_s) {
  if (pose_ && now_s - pose_->captured_s <= options_.pose_stale_s) return true;
  const bool sees_pictures = looked_s_ && now_s - *looked_s_ <= options_.pose_stale_s;
  const std::string age =
      pose_ ? fmt::format("for {:.3f} s", now_s - pose_->captured_s) : std::string("yet");
  if (sees_pictures) {
    Stop(StopReason::kTagLost, fmt::format("the tag was not seen {}", age), now_s);
  } else {
    Stop(StopReason::kPoseStale, fmt::format("no picture {}", age), now_s);
  }
  return false;
}

void DriveGuard::HearRobot(std::uint8_t stops, double battery_v, double now_s) {
  if (state_ == DriveState::kArmed && robot_stops_ && *robot_stops_ != stops) {
    Stop(StopReason::kRobotStopped,
         "the robot stopped by itself: it heard no command for too long, or was restarted", now_s);
  }
  robot_stops_ = stops;
  if (state_ == DriveState::kArmed && battery_v < options_.battery_min_v) {
    Stop(StopReason::kBatteryLow,
         fmt::format("the battery is at {:.2f} V, below {:.2f} V", battery_v,
                     options_.battery_min_v),
         now_s);
  }
}

void DriveGuard::Tick(double now_s, double link_lag_s) {
  NoteTime(now_s);
  if (state_ != DriveState::kArmed) return;
  if (link_lag_s > options_.link_lag_s) {
    return Stop(StopReason::kLinkLagging,
                fmt::format("the robot has not answered for {:.2f} s", link_lag_s), now_s);
  }
  if (power_ == control::WheelPower{}) return;
  if (!RequireFreshPose(now_s)) return;
  if (now_s - commanded_s_ > options_.control_stale_s) {
    Stop(StopReason::kControlStale,
         fmt::format("no control step for {:.3f} s", now_s - commanded_s_), now_s);
  }
}

control::WheelPower DriveGuard::Allowed() const {
  return state_ == DriveState::kArmed && !dry_run_ ? power_ : control::WheelPower{};
}

}  // namespace rift::hardware
