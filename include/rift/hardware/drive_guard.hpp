#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "rift/hardware/options.hpp"
#include "rift/hardware/pose_source.hpp"

namespace rift::hardware {

enum class DriveState { kDisarmed, kArmed, kStopped };
constexpr std::array<std::string_view, 3> EnumNames(DriveState) {
  return {"disarmed", "armed", "stopped"};
}

enum class StopReason {
  kFinished,
  kOperator,
  kSignal,
  kException,
  kPoseStale,
  kPictureRepeats,
  kTagLost,
  kPoseNotFinite,
  kPoseJump,
  kTimeBackwards,
  kPoseStands,
  kWheelsStand,
  kPoseDisorder,
  kPoseDisagrees,
  kPoseLags,
  kCameraGone,
  kPortGone,
  kLinkLagging,
  kControlStale,
  kHostStalled,
  kPowerRefused,
  kNotArmed,
  kRobotStopped,
  kRobotDisobeys,
  kBatteryLow,
  kLogFailed,
};
constexpr std::array<std::string_view, 26> EnumNames(StopReason) {
  return {"finished",        "operator",     "signal",          "exception",      "pose_stale",
          "picture_repeats", "tag_lost",     "pose_not_finite", "pose_jump",      "time_backwards",
          "pose_stands",     "wheels_stand", "pose_disorder",   "pose_disagrees", "pose_lags",
          "camera_gone",     "port_gone",    "link_lagging",    "control_stale",  "host_stalled",
          "power_refused",   "not_armed",    "robot_stopped",   "robot_disobeys", "battery_low",
          "log_failed"};
}

struct DriveStop {
  StopReason reason = StopReason::kFinished;
  std::string text;  ///< one line for people
  double at_s = 0.0;
};

/// Allows no power without a recent pose, by its time stamp, and a recent control step. The first
/// thing that goes wrong stops the drive for good; only Arm() starts it again. Commands are allowed
/// as they are or not at all. Knows no clock and no line.
class DriveGuard {
 public:
  /// `dry_run`: everything is checked as ever, and Allowed() is zero whatever is commanded.
  explicit DriveGuard(const GuardOptions& options, bool dry_run = false)
      : options_(options), dry_run_(dry_run) {}

  /// Throws std::runtime_error unless there is a fresh pose; clears an earlier stop.
  void Arm(double now_s);
  /// The first one counts.
  void Stop(StopReason reason, std::string text, double now_s);

  void SeePose(const PoseNews& news, double now_s);
  /// A control step and what it wants.
  void Command(const control::WheelPower& power, double now_s);
  /// Whether this process stood still since the last call of any of these.
  void NoteTime(double now_s);
  void HearRobot(std::uint8_t stops, double battery_v, double now_s);
  /// To be called often: what has grown too old, or whether this process stood still.
  void Tick(double now_s, double link_lag_s);

  /// What may be sent now: the last command while all is well, else zero; zero in a dry run.
  control::WheelPower Allowed() const;
  DriveState state() const { return state_; }
  const std::optional<DriveStop>& stop() const { return stop_; }

 private:
  void CheckJump(const trial::PoseMeasurement& before, const trial::PoseMeasurement& pose,
                 double now_s);
  bool RequireFreshPose(double now_s);

  GuardOptions options_;
  bool dry_run_;
  DriveState state_ = DriveState::kDisarmed;
  std::optional<DriveStop> stop_;
  std::optional<trial::PoseMeasurement> pose_;
  std::optional<double> looked_s_;
  control::WheelPower power_;
  double commanded_s_ = 0.0;
  std::optional<double> ticked_s_;
  std::optional<std::uint8_t> robot_stops_;
};

}  // namespace rift::hardware
