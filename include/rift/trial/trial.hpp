#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rift/control/controller.hpp"
#include "rift/trajectory/trajectory.hpp"
#include "rift/trial/options.hpp"
#include "rift/trial/robot.hpp"

namespace rift::trial {

enum class Outcome { kReached, kTimedOut, kFell, kLeftArena, kLost, kFault };

constexpr std::array<std::string_view, 6> EnumNames(Outcome) {
  return {"reached", "timed_out", "fell", "left_arena", "lost", "fault"};
}

/// How far the robot got with one waypoint.
struct WaypointVisit {
  std::string name;
  std::optional<double> reached_s;  ///< robot clock; none: never
  std::optional<double> closest_m;  ///< least distance while it was driven to; none: never tried
};

/// A power as sent, on the robot clock.
struct SentCommand {
  double t_s = 0.0;
  control::WheelPower power;
};

/// How many decisions each limit changed, and what the loops asked for at most: whether a limit
/// such as v_max mattered in this trial.
struct LimitCounts : control::ForEachLimit<size_t> {
  size_t decisions = 0;  ///< those that drove, thus neither settling, stopped nor stale
  double largest_raw_v = 0.0;
  double largest_raw_w = 0.0;  ///< of either sign
};

struct TrialResult {
  Outcome outcome = Outcome::kFault;
  std::string reason;       ///< one line for people
  double start_s = 0.0;     ///< robot clock at the first look
  double driving_s = -1.0;  ///< robot clock at the first non-zero power; -1: never drove
  double end_s = 0.0;
  std::vector<WaypointVisit> visits;  ///< one for each waypoint after the start
  /// One row for each new believable pose, stamped with its capture time on the robot clock, with
  /// the target and the channels power_left, power_right, v, w: what was in force when the pose
  /// came in, thus the decision made on it where there was one.
  trajectory::Trajectory trajectory;
  std::vector<SentCommand> commands;  ///< every power sent, in order
  LimitCounts limits;
  size_t poses_refused = 0;    ///< not finite, or a jump
  size_t refused_moves = 0;    ///< of them beyond control.pose_gate.max_speed_mps
  size_t refused_turns = 0;    ///< of them beyond control.pose_gate.max_yaw_rate_rad_s
  size_t stale_decisions = 0;  ///< zero power was sent since the pose was too old
  /// Mean age of the pose, since its capture, over the decisions; -1: none was made.
  double pose_age_s = -1.0;
  /// Mean age of the believed poses as they came in, since their capture; -1: none did.
  double arrival_age_s = -1.0;
  size_t poses_believed = 0;  ///< that came in, logged or left out by trial.log_period_s

  double Duration_s() const { return end_s - start_s; }
};

/// Told each row and each command of a trial as it is recorded. It is called between the decisions
/// of a driving robot: it must neither wait nor throw.
class Observer {
 public:
  Observer() = default;
  virtual ~Observer() = default;
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

  /// `channels`: one value for each of TrialResult::trajectory.channels, in their order.
  virtual void Row(const trajectory::StampedPose& pose, std::span<const double> channels) = 0;
  virtual void Sent(const SentCommand& command) = 0;
};

/// The channels of TrialResult::trajectory, without values.
std::vector<trajectory::Channel> RecordedChannels();

/// The one loop for simulator and hardware: sense, decide, command, record, advance, until the
/// last waypoint is reached, the program is over, or the trial fails. Deterministic in what the
/// robot reports.
///
/// Robot::Stop() is called on every way out, exceptions of the robot included, and no power but
/// zero is ever sent without a believable pose younger than pose_stale_s.
/// Throws std::invalid_argument on bad options or a bad task, before the robot moves.
TrialResult RunTrial(Robot& robot, const control::Task& task,
                     const control::NavigatorOptions& navigator_options,
                     const TrialOptions& options, Observer* observer = nullptr);

/// Turns the steps of a trial into the evidence of its result.
class Recorder {
 public:
  Recorder(const std::vector<control::Waypoint>& waypoints, double log_period_s,
           Observer* observer = nullptr);

  /// Once for each believable new pose, after the decision made on it (none while settling).
  void Pose(const PoseMeasurement& measured, const Eigen::Vector2d& target_m,
            const control::Decision& decision);
  void Sent(double now_s, const control::WheelPower& power);
  /// Once for each decision; `active_after` is the waypoint the navigator drives to from now on.
  void Decided(double now_s, const control::Decision& decision, size_t active_after);
  /// By which limit of the pose gate, where it was one.
  void Refused(bool is_move, bool is_turn);
  /// Once for each believable pose.
  void CameIn(double pose_age_s);
  void Stale() { ++result_.stale_decisions; }
  /// Once for each decision: how old its pose was.
  void DecidedOn(double pose_age_s);

  TrialResult& result() { return result_; }

 private:
  double log_period_s_;
  Observer* observer_;
  size_t active_ = 1;
  size_t ages_ = 0;
  TrialResult result_;
};

}  // namespace rift::trial
