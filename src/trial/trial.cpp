#include "rift/trial/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bitset>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "rift/geometry/pose2.hpp"

namespace rift::trial {

namespace {

void Count(LimitCounts& counts, const control::Decision& decision) {
  ++counts.decisions;
  std::bitset<32> binds;  // every trial step passes here: nothing is allocated
  size_t at = 0;
  control::Limits::Fields(decision.limits, [&](const char*, bool bind) { binds.set(at++, bind); });
  at = 0;
  LimitCounts::Fields(counts, [&](const char*, size_t& count) { count += binds[at++]; });
  counts.largest_raw_v = std::max(counts.largest_raw_v, decision.raw_v);
  counts.largest_raw_w = std::max(counts.largest_raw_w, std::abs(decision.raw_w));
}

}  // namespace

std::vector<trajectory::Channel> RecordedChannels() {
  return {{"power_left", {}}, {"power_right", {}}, {"v", {}}, {"w", {}}};
}

Recorder::Recorder(const std::vector<control::Waypoint>& waypoints, double log_period_s,
                   Observer* observer)
    : log_period_s_(log_period_s), observer_(observer) {
  for (size_t i = 1; i < waypoints.size(); ++i) {
    result_.visits.push_back({waypoints[i].name, std::nullopt, std::nullopt});
  }
  result_.trajectory.channels = RecordedChannels();
}

void Recorder::Pose(const PoseMeasurement& measured, const Eigen::Vector2d& target_m,
                    const control::Decision& decision) {
  std::vector<trajectory::StampedPose>& poses = result_.trajectory.poses;
  const double since_s = poses.empty() ? measured.captured_s : poses.back().t_s;
  if (!poses.empty() &&
      (measured.captured_s <= since_s || measured.captured_s - since_s < log_period_s_)) {
    return;
  }
  const geometry::Pose2& pose = measured.world_from_robot;
  poses.push_back({measured.captured_s, pose.x_m, pose.y_m, measured.z_m, measured.roll_rad,
                   measured.pitch_rad, pose.yaw_rad, target_m.x(), target_m.y()});
  std::vector<trajectory::Channel>& channels = result_.trajectory.channels;
  const std::array<double, 4> values{decision.power.left, decision.power.right, decision.v,
                                     decision.w};
  for (size_t i = 0; i < values.size(); ++i) channels[i].values.push_back(values[i]);
  if (observer_ != nullptr) observer_->Row(poses.back(), values);
}

void Recorder::Sent(double now_s, const control::WheelPower& power) {
  if (result_.driving_s < 0.0 && !(power == control::WheelPower{})) result_.driving_s = now_s;
  result_.commands.push_back({now_s, power});
  if (observer_ != nullptr) observer_->Sent(result_.commands.back());
}

void Recorder::DecidedOn(double pose_age_s) {
  double& mean_s = result_.pose_age_s;
  ++ages_;
  mean_s = ages_ == 1 ? pose_age_s : mean_s + (pose_age_s - mean_s) / static_cast<double>(ages_);
}

void Recorder::Refused(bool is_move, bool is_turn) {
  ++result_.poses_refused;
  if (is_move) ++result_.refused_moves;
  if (is_turn) ++result_.refused_turns;
}

void Recorder::CameIn(double pose_age_s) {
  double& mean_s = result_.arrival_age_s;
  const auto poses = static_cast<double>(++result_.poses_believed);
  mean_s = poses == 1.0 ? pose_age_s : mean_s + (pose_age_s - mean_s) / poses;
}

void Recorder::Decided(double now_s, const control::Decision& decision, size_t active_after) {
  for (; active_ < decision.waypoint; ++active_) {  // passed through, without a stop
    result_.visits[active_ - 1].reached_s = now_s;
  }
  WaypointVisit& visit = result_.visits[decision.waypoint - 1];
  visit.closest_m = std::min(visit.closest_m.value_or(decision.distance_m), decision.distance_m);
  if (decision.reached) {
    visit.reached_s = now_s;
    active_ = active_after;
    return;
  }
  if (!decision.set_clock) Count(result_.limits, decision);
}

namespace {

// Turns of the loop may take less time than asked, down to one part in this; of long ones than
// this, which a new picture ends early on the real robot.
constexpr double kSlowestClock = 20.0;
constexpr double kLongestTurn_s = 0.1;

// Whatever happens in between, the robot stands at the end.
class StopGuard {
 public:
  explicit StopGuard(Robot& robot) : robot_(robot) {}
  ~StopGuard() { robot_.Stop(); }
  StopGuard(const StopGuard&) = delete;
  StopGuard& operator=(const StopGuard&) = delete;

 private:
  Robot& robot_;
};

class Loop {
 public:
  Loop(Robot& robot, const control::Task& task, const control::NavigatorOptions& navigator,
       const TrialOptions& options, Observer* observer)
      : robot_(robot),
        options_(options),
        speeds_(task.program ? ""
                             : fmt::format("; control.v_min is {}, control.v_max {}",
                                           navigator.v_min, navigator.v_max)),
        end_(task.program ? "the program is over" : "the last waypoint was reached"),
        gate_(navigator.pose_gate),
        controller_(control::MakeController(task, navigator)),
        recorder_(controller_->waypoints(), options.log_period_s, observer) {}

  TrialResult Run();

 private:
  void Begin(const Sensed& sensed);
  bool ClockRuns(double now_s);
  bool TakePose(const Sensed& sensed);
  void NoteRefused(const PoseMeasurement& pose);
  bool IsOver(const Sensed& sensed);
  void Act(double now_s, bool is_new_pose);
  control::Decision Decide(double now_s, bool is_new_pose);
  void Send(double now_s, const control::WheelPower& power);
  bool End(Outcome outcome, std::string reason);
  double PoseAge_s(double now_s) const;

  Robot& robot_;
  const TrialOptions& options_;
  const std::string speeds_;  ///< the limits of the speed, for who looks for a longer time
  const char* const end_;     ///< a program is over wherever the robot is
  const control::PoseGateOptions gate_;
  std::unique_ptr<control::Controller> controller_;
  Recorder recorder_;
  std::optional<double> looked_at_s_;  ///< capture time of the newest pose seen, believed or not
  PoseMeasurement measured_;           ///< the newest pose believed
  std::optional<double> decided_s_;
  std::optional<double> tilted_since_s_;
  control::Decision decision_;
  double start_s_ = 0.0;
  double last_look_s_ = 0.0;
  double turns_ = 0.0;
};

TrialResult Loop::Run() {
  Sensed sensed = robot_.Sense();
  Begin(sensed);
  while (true) {
    const bool is_new_pose = TakePose(sensed);
    if (IsOver(sensed)) break;
    Act(sensed.now_s, is_new_pose);
    if (decision_.finished) {
      End(Outcome::kReached, end_);
      break;
    }
    robot_.Advance(options_.control_period_s);
    sensed = robot_.Sense();
  }
  recorder_.result().end_s = sensed.now_s;
  return std::move(recorder_.result());
}

void Loop::Begin(const Sensed& sensed) {
  start_s_ = last_look_s_ = sensed.now_s;
  recorder_.result().start_s = start_s_;
}

// A clock that jumps back or stands still would keep the timeout from ever coming.
bool Loop::ClockRuns(double now_s) {
  const bool forward = now_s >= last_look_s_;
  last_look_s_ = now_s;
  turns_ += 1.0;
  const double turn_s = std::min(options_.control_period_s, kLongestTurn_s);
  return forward && turns_ * turn_s <= kSlowestClock * options_.timeout_s + 1.0;
}

// True when a pose came in that had not been seen before and is believed. One from the future
// would never grow stale.
bool Loop::TakePose(const Sensed& sensed) {
  if (!sensed.pose || sensed.pose->captured_s == looked_at_s_) return false;
  looked_at_s_ = sensed.pose->captured_s;
  const bool believed = sensed.pose->captured_s <= sensed.now_s + options_.control_period_s &&
                        controller_->Observe({sensed.now_s, 0.0, sensed.pose->captured_s,
                                              sensed.pose->world_from_robot});
  if (!believed) {
    NoteRefused(*sensed.pose);
    return false;
  }
  measured_ = *sensed.pose;
  recorder_.CameIn(sensed.now_s - measured_.captured_s);
  const double tilt_rad = std::max(std::abs(measured_.roll_rad), std::abs(measured_.pitch_rad));
  if (!(tilt_rad > geometry::RadFromDeg(options_.fall_angle_deg))) {
    tilted_since_s_.reset();
  } else if (!tilted_since_s_) {
    tilted_since_s_ = measured_.captured_s;
  }
  return true;
}

/// By which limit of the gate; neither when the pose is not finite, or late.
void Loop::NoteRefused(const PoseMeasurement& pose) {
  const std::optional<control::TimedPose>& last = controller_->pose();
  if (!last || !pose.world_from_robot.IsFinite() || !(pose.captured_s >= last->captured_s)) {
    recorder_.Refused(false, false);
    return;
  }
  const double interval_s = std::max(pose.captured_s - last->captured_s, gate_.min_interval_s);
  const geometry::Pose2 &from = last->world_from_robot, &to = pose.world_from_robot;
  recorder_.Refused((to.Position() - from.Position()).norm() > gate_.max_speed_mps * interval_s,
                    std::abs(geometry::WrapToPi(to.yaw_rad - from.yaw_rad)) >
                        gate_.max_yaw_rate_rad_s * interval_s);
}

bool Loop::IsOver(const Sensed& sensed) {
  if (sensed.fault) return End(Outcome::kFault, *sensed.fault);
  if (sensed.fall) return End(Outcome::kFell, *sensed.fall);
  if (!ClockRuns(sensed.now_s)) {
    return End(Outcome::kFault, "the robot's clock stands still or runs backwards");
  }
  if (tilted_since_s_ && measured_.captured_s - *tilted_since_s_ >= options_.fall_confirm_s) {
    return End(Outcome::kFell, fmt::format("roll or pitch stayed beyond {} deg from {:.3f} s on",
                                           options_.fall_angle_deg, *tilted_since_s_));
  }
  const geometry::Pose2& pose = measured_.world_from_robot;
  if (controller_->pose() && !options_.arena.Contains(pose.x_m, pose.y_m)) {
    return End(Outcome::kLeftArena,
               fmt::format("the robot is at x {:.3f} m, y {:.3f} m, outside the arena", pose.x_m,
                           pose.y_m));
  }
  if (PoseAge_s(sensed.now_s) > options_.lost_after_s) {
    return End(Outcome::kLost,
               fmt::format("no believable pose for {:.2f} s", PoseAge_s(sensed.now_s)));
  }
  if (sensed.now_s - start_s_ >= options_.timeout_s) {
    const size_t active = controller_->active();
    const std::string& name = controller_->waypoints()[active].name;
    const std::string target =
        name.empty() ? fmt::format("waypoints[{}]", active) : fmt::format("waypoint '{}'", name);
    return End(Outcome::kTimedOut, fmt::format("{} was not reached within trial.timeout_s, {} s{}",
                                               target, options_.timeout_s, speeds_));
  }
  return false;
}

// A robot that has shown no pose yet is as old as the trial.
double Loop::PoseAge_s(double now_s) const {
  return now_s - (controller_->pose() ? controller_->pose()->captured_s : start_s_);
}

void Loop::Act(double now_s, bool is_new_pose) {
  const Eigen::Vector2d target_m = controller_->Target_m();
  decision_ = Decide(now_s, is_new_pose);
  Send(now_s, decision_.power);
  if (is_new_pose) recorder_.Pose(measured_, target_m, decision_);
}

control::Decision Loop::Decide(double now_s, bool is_new_pose) {
  if (!controller_->pose() || now_s - start_s_ < options_.settle_s) return {};
  if (PoseAge_s(now_s) > options_.pose_stale_s) {
    recorder_.Stale();
    return {};
  }
  if (options_.pace == Pace::kNewPose && !is_new_pose) return decision_;

  const double dt_s = decided_s_ ? now_s - *decided_s_ : options_.control_period_s;
  decided_s_ = now_s;
  const control::TimedPose& pose = *controller_->pose();
  const control::Decision decision =
      controller_->Step({now_s, dt_s, pose.captured_s, pose.world_from_robot});
  recorder_.DecidedOn(now_s - pose.captured_s);
  recorder_.Decided(now_s, decision, controller_->active());
  return decision;
}

void Loop::Send(double now_s, const control::WheelPower& power) {
  robot_.Command(power);
  controller_->NoteSent(now_s, power);
  recorder_.Sent(now_s, power);
}

bool Loop::End(Outcome outcome, std::string reason) {
  recorder_.result().outcome = outcome;
  recorder_.result().reason = std::move(reason);
  return true;
}

}  // namespace

TrialResult RunTrial(Robot& robot, const control::Task& task,
                     const control::NavigatorOptions& navigator_options,
                     const TrialOptions& options, Observer* observer) {
  const StopGuard stop_at_the_end(robot);
  options.Check();
  return Loop(robot, task, navigator_options, options, observer).Run();
}

}  // namespace rift::trial
