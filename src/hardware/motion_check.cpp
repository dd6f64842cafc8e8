#include "motion_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "rift/control/diff_drive.hpp"
#include "rift/geometry/pose2.hpp"

namespace rift::hardware {
namespace {

using geometry::Pose2;

constexpr double kWindow_s = 0.4;       // over which displacements are compared
constexpr double kStep_m = 0.003;       // less is jitter
constexpr double kBackStep_m = 0.0025;  // against the wheels; less is jitter
constexpr double kTogether_s = 0.01;    // pictures that come in one piece of the stream
constexpr double kBackward = 0.5;       // of what the wheels rolled: the pose ran back
constexpr double kDisorder_s = 0.7;     // in which kBackwardSteps of them are no accident
constexpr size_t kBackwardSteps = 3;
constexpr double kOldPicture_m = 0.015;  // back at once; 2,760 steps of 59 logs: 0.0046 at most
constexpr double kLagWindow_s = 2.0;
constexpr double kLagSpan_s = 0.15;
constexpr double kLagStep_s = 0.02;
constexpr double kLagEvery_s = 0.2;
constexpr double kMostLag_s = 1.2;
constexpr int kLagLooks = 2;

double Largest(const WheelTravel& from, const WheelTravel& to) {
  return std::max(std::abs(to.left_m - from.left_m), std::abs(to.right_m - from.right_m));
}

WheelTravel Between(const WheelTravel& a, const WheelTravel& b, double t_s) {
  const double share = (t_s - a.t_s) / (b.t_s - a.t_s);
  return {t_s, a.left_m + share * (b.left_m - a.left_m),
          a.right_m + share * (b.right_m - a.right_m)};
}

double Moved_m(const Pose2& a, const Pose2& b) { return (b.Position() - a.Position()).norm(); }

double Turned_deg(const Pose2& a, const Pose2& b) {
  return geometry::DegFromRad(std::abs(b.yaw_rad - a.yaw_rad));
}

bool ComeTogether(double before_s, double now_s) { return now_s - before_s < kTogether_s; }

Step Rolled(const WheelTravel& from, const WheelTravel& to) {
  const double left_m = to.left_m - from.left_m, right_m = to.right_m - from.right_m;
  return {0.5 * (left_m + right_m), 0.5 * (right_m - left_m)};
}

/// The same as the pose shows it.
Step Seen(const Pose2& from, const Pose2& to, double track_m) {
  const double yaw_rad = 0.5 * (from.yaw_rad + to.yaw_rad);
  const Eigen::Vector2d moved = to.Position() - from.Position();
  return {moved.dot(Pose2{0.0, 0.0, yaw_rad}.Forward()),
          0.5 * track_m * (to.yaw_rad - from.yaw_rad)};
}

}  // namespace

void MotionCheck::SetLatency(double latency_s) {
  latency_s_ = latency_s;
  is_latency_known_ = true;
  backlog_.LearnPeriod();
}

void MotionCheck::Restart() {
  if (!backlog_.KnowsPeriod()) backlog_.LearnPeriod();
  backlog_.Restart();
  wheels_.clear();
  waiting_.clear();
  samples_.clear();
  pose_anchor_.reset();
  wheel_anchor_.reset();
  backward_s_.clear();
  lags_ = 0;
  driven_blind_s_ = 0.0;
}

void MotionCheck::SeeWheels(const WheelTravel& wheels, bool is_measured) {
  if (is_measured != is_measured_) Restart();
  is_measured_ = is_measured;
  if (!wheels_.empty() && wheels.t_s <= wheels_.back().t_s) return;
  wheels_.push_back(wheels);
  while (wheels_.front().t_s < wheels.t_s - kKept_s) wheels_.pop_front();
}

void MotionCheck::SeeCommand(bool turns, double heard_s) {
  if (!turns) {
    turning_since_s_.reset();
  } else if (!turning_since_s_) {
    turning_since_s_ = heard_s;
  }
}

void MotionCheck::SeePose(const trial::PoseMeasurement& pose,
                          const std::optional<double>& repeats_since_s) {
  const bool is_blind = repeats_since_s && turning_since_s_;
  driven_blind_s_ =
      is_blind ? pose.captured_s - std::max(*repeats_since_s, *turning_since_s_) : 0.0;
  backlog_.SeePicture(pose.captured_s);
  Sample sample{pose.captured_s - latency_s_, pose.world_from_robot, {}, repeats_since_s};
  if (sample.repeats_since_s) *sample.repeats_since_s -= latency_s_;
  waiting_.push_back(sample);
  // A link that tells nothing of the wheels is watched for that itself.
  while (waiting_.front().t_s < waiting_.back().t_s - kKept_s) waiting_.pop_front();
}

std::optional<WheelTravel> MotionCheck::WheelsAt(double t_s) const {
  const auto after = std::lower_bound(wheels_.begin(), wheels_.end(), t_s,
                                      [](const WheelTravel& w, double t) { return w.t_s < t; });
  if (after == wheels_.end()) return std::nullopt;
  if (after == wheels_.begin()) return *after;  // before the first: they stood as at the first
  return Between(*(after - 1), *after, t_s);
}

std::optional<Disagreement> MotionCheck::Check() {
  if (auto found = CheckBlindDrive()) return found;
  while (!waiting_.empty()) {
    Sample now = waiting_.front();
    const std::optional<WheelTravel> wheels = WheelsAt(now.t_s);
    if (!wheels) return std::nullopt;
    now.wheels = *wheels;
    waiting_.pop_front();
    if (!samples_.empty()) {
      const double before_rad = samples_.back().pose.yaw_rad;
      now.pose.yaw_rad = before_rad + geometry::WrapToPi(now.pose.yaw_rad - before_rad);
    }
    std::optional<Disagreement> found = CheckSample(now);
    samples_.push_back(now);
    while (samples_.front().t_s < now.t_s - kKept_s) samples_.pop_front();
    if (found) return found;
  }
  return std::nullopt;
}

std::optional<Disagreement> MotionCheck::CheckSample(const Sample& now) {
  if (auto found = CheckRepeats(now)) return found;
  if (auto found = CheckPoseStands(now)) return found;
  if (auto found = CheckWheelsStand(now)) return found;
  if (samples_.empty()) return std::nullopt;
  if (auto found = CheckBacklog(samples_.back(), now)) return found;
  if (!is_measured_) return std::nullopt;
  if (auto found = CheckOrder(samples_.back(), now)) return found;
  if (auto found = CheckWindow(now)) return found;
  return CheckLag(now);
}

// Wheels may tell nothing, or always the same: what was sent is known for certain.
std::optional<Disagreement> MotionCheck::CheckBlindDrive() const {
  const double most_s = options_.repeats_s + options_.max_latency_s;
  if (driven_blind_s_ <= most_s) return std::nullopt;
  return Disagreement{
      StopReason::kPictureRepeats,
      fmt::format("the camera has shown the same picture for {:.3f} s, in which the robot was told "
                  "to drive: a frozen camera, or a robot that does not move",
                  driven_blind_s_)};
}

// Cameras at half their rate repeat a picture now and then, and may repeat all of a robot that
// stands.
std::optional<Disagreement> MotionCheck::CheckRepeats(const Sample& now) const {
  constexpr double kRolled_m = 0.005;
  if (!now.repeats_since_s || now.t_s - *now.repeats_since_s < options_.repeats_s)
    return std::nullopt;
  const std::optional<WheelTravel> before = WheelsAt(*now.repeats_since_s);
  const double rolled_m = before ? Largest(*before, now.wheels) : 0.0;
  if (rolled_m <= Loosened(kRolled_m)) return std::nullopt;
  return Disagreement{
      StopReason::kPictureRepeats,
      fmt::format("the camera has shown the same picture for {:.3f} s, in which the "
                  "wheels rolled {:.3f} m",
                  now.t_s - *now.repeats_since_s, rolled_m)};
}

/// Of the faster wheel, over the last moments.
double MotionCheck::Speed_mps(const Sample& now) const {
  constexpr double kOver_s = 0.1;
  const std::optional<WheelTravel> before = WheelsAt(now.t_s - kOver_s);
  return before ? Largest(*before, now.wheels) / kOver_s : 0.0;
}

std::optional<Disagreement> MotionCheck::CheckPoseStands(const Sample& now) {
  const bool has_moved =
      pose_anchor_ && (Moved_m(pose_anchor_->pose, now.pose) > options_.still_m ||
                       Turned_deg(pose_anchor_->pose, now.pose) > options_.still_deg);
  if (!pose_anchor_ || has_moved) pose_anchor_ = now;
  const double rolled_m = Largest(pose_anchor_->wheels, now.wheels);
  // A robot that has just stopped as well: times of poses and readings may be apart by this.
  const double speed_mps = std::max(Speed_mps(*pose_anchor_), Speed_mps(now));
  const double blind_s = options_.blind_s + (is_latency_known_ ? 0.0 : options_.max_latency_s);
  if (rolled_m <= Loosened(options_.blind_m + blind_s * speed_mps)) return std::nullopt;
  return Disagreement{
      StopReason::kPoseStands,
      fmt::format("the wheels turned by {:.3f} m and the pose stands: an old picture, wheels that "
                  "slip, or a robot that is held",
                  rolled_m)};
}

std::optional<Disagreement> MotionCheck::CheckWheelsStand(const Sample& now) {
  if (!wheel_anchor_ || Largest(wheel_anchor_->wheels, now.wheels) > kStep_m) wheel_anchor_ = now;
  // A pose that lags goes on for a while when the wheels have stopped.
  if (now.t_s - wheel_anchor_->t_s < options_.max_latency_s) {
    wheel_anchor_->pose = now.pose;
    return std::nullopt;
  }
  const double moved_m = Moved_m(wheel_anchor_->pose, now.pose);
  const double turned_deg = Turned_deg(wheel_anchor_->pose, now.pose);
  if (moved_m <= Loosened(options_.pushed_m) && turned_deg <= Loosened(options_.pushed_deg)) {
    return std::nullopt;
  }
  return Disagreement{
      StopReason::kWheelsStand,
      fmt::format("the pose moved by {:.3f} m and {:.0f} deg and the wheels stand: another tag, or "
                  "a robot that is pushed or carried",
                  moved_m, turned_deg)};
}

/// Forward, from picture to picture. Pictures that come together are stamped as if no time were
/// between them: of those, which way it rolls at all, and no way where it hardly does.
double MotionCheck::Forward_m(const Sample& before, const Sample& now) const {
  constexpr double kOver_s = 0.1, kLeast_mps = 0.05;
  const double rolled_m = Rolled(before.wheels, now.wheels).forward_m;
  if (std::abs(rolled_m) > kRolls_m || !ComeTogether(before.t_s, now.t_s)) return rolled_m;
  const std::optional<WheelTravel> earlier = WheelsAt(now.t_s - kOver_s);
  const double over_m = earlier ? Rolled(*earlier, now.wheels).forward_m : 0.0;
  if (std::abs(over_m) < kLeast_mps * kOver_s) return 0.0;
  return std::copysign(2.0 * kRolls_m, over_m);
}

std::optional<Disagreement> MotionCheck::CheckOrder(const Sample& before, const Sample& now) {
  const double rolled_m = Forward_m(before, now);
  const Step seen = Seen(before.pose, now.pose, track_m_);
  // Against the wheels, by more than a standing tag jitters.
  const double against_m = rolled_m > 0.0 ? -seen.forward_m : seen.forward_m;
  const bool rolls = std::abs(rolled_m) > kRolls_m;
  if (!rolls || against_m < std::max(kBackStep_m, kBackward * std::abs(rolled_m))) {
    return std::nullopt;
  }
  backward_s_.push_back(now.t_s);
  // As far back as the wheels went forward is no jitter: it counts twice.
  if (against_m > std::max(1.5 * kBackStep_m, std::abs(rolled_m))) {
    backward_s_.push_back(now.t_s);
  }
  while (backward_s_.front() < now.t_s - kDisorder_s) backward_s_.pop_front();
  // No robot runs back so far between pictures that come together.
  const double old_m =
      ComeTogether(before.t_s, now.t_s) ? 2.0 * kBackStep_m : kOldPicture_m + std::abs(rolled_m);
  if (against_m > old_m) {
    return Disagreement{StopReason::kPoseDisorder,
                        fmt::format("the pose ran {:.3f} m against the wheels from one picture to "
                                    "the next: the camera's pictures come out of order",
                                    against_m)};
  }
  if (backward_s_.size() < kBackwardSteps) return std::nullopt;
  return Disagreement{
      StopReason::kPoseDisorder,
      fmt::format("the pose ran against the wheels again and again within {:.1f} s: the camera's "
                  "pictures come out of order",
                  kDisorder_s)};
}

std::optional<Disagreement> MotionCheck::CheckBacklog(const Sample& before, const Sample& now) {
  const std::optional<std::string> found =
      backlog_.Check({now.t_s - before.t_s, Rolled(before.wheels, now.wheels),
                      Seen(before.pose, now.pose, track_m_)},
                     is_measured_, is_latency_known_);
  if (!found) return std::nullopt;
  return Disagreement{StopReason::kPoseLags, *found};
}

std::optional<Disagreement> MotionCheck::CheckWindow(const Sample& now) {
  const auto from = std::find_if(samples_.begin(), samples_.end(), [&](const Sample& sample) {
    return sample.t_s >= now.t_s - kWindow_s;
  });
  if (from == samples_.end()) return std::nullopt;
  // Along the window the robot follows the wheels' arcs.
  Pose2 by_wheels = from->pose;
  double path_m = 0.0;
  for (auto before = from; before != samples_.end(); ++before) {
    const auto next = before + 1;
    const Step rolled = Rolled(before->wheels, next == samples_.end() ? now.wheels : next->wheels);
    by_wheels = by_wheels * control::ArcMotion(rolled.forward_m, 2.0 * rolled.turn_m / track_m_);
    path_m += std::abs(rolled.forward_m);
  }
  const double apart_m = Moved_m(by_wheels, now.pose);
  if (apart_m <= options_.agree_m + options_.agree_share * path_m) return std::nullopt;
  return Disagreement{
      StopReason::kPoseDisagrees,
      fmt::format("pose and wheels part by {:.3f} m within {:.1f} s, in which the wheels rolled "
                  "{:.3f} m",
                  apart_m, kWindow_s, path_m)};
}

// The lag at which the wheels' steps explain the pose's best, where that is clear.
std::optional<double> MotionCheck::Lag_s() const {
  double none_m2 = std::numeric_limits<double>::quiet_NaN();
  double best_m2 = std::numeric_limits<double>::infinity(), best_s = 0.0;
  const auto steps = static_cast<int>(kMostLag_s / kLagStep_s + 1e-9);
  for (int step = 0; step <= steps; ++step) {
    const double lag_s = step * kLagStep_s;
    double sum_m2 = 0.0;
    int pairs = 0;
    size_t from = 0;
    for (size_t to = 0; to < samples_.size(); ++to) {
      if (samples_[to].t_s < samples_.back().t_s - kLagWindow_s) continue;
      while (samples_[to].t_s - samples_[from].t_s > kLagSpan_s) ++from;
      if (from == to) continue;
      const std::optional<WheelTravel> a = WheelsAt(samples_[from].t_s - lag_s);
      const std::optional<WheelTravel> b = WheelsAt(samples_[to].t_s - lag_s);
      if (!a || !b) continue;
      const Step rolled = Rolled(*a, *b);
      const Step seen = Seen(samples_[from].pose, samples_[to].pose, track_m_);
      sum_m2 +=
          std::pow(seen.forward_m - rolled.forward_m, 2) + std::pow(seen.turn_m - rolled.turn_m, 2);
      ++pairs;
    }
    if (pairs == 0) return std::nullopt;
    sum_m2 /= pairs;
    if (lag_s == 0.0) none_m2 = sum_m2;
    if (sum_m2 < best_m2) {
      best_m2 = sum_m2;
      best_s = lag_s;
    }
  }
  constexpr double kSeen_m = 0.004;  // less is noise
  constexpr double kClearly = 0.25;  // of the error without a lag
  const bool is_clear = none_m2 > kSeen_m * kSeen_m && best_m2 < kClearly * none_m2;
  return is_clear ? std::optional(best_s) : std::nullopt;
}

std::optional<Disagreement> MotionCheck::CheckLag(const Sample& now) {
  if (now.t_s - looked_for_lag_s_ < kLagEvery_s) return std::nullopt;
  looked_for_lag_s_ = now.t_s;
  const std::optional<double> lag_s = Lag_s();
  lags_ = lag_s && *lag_s > options_.max_latency_s ? lags_ + 1 : 0;
  if (lags_ < kLagLooks) return std::nullopt;
  return Disagreement{StopReason::kPoseLags,
                      fmt::format("the pose lags the wheels by {:.2f} s, and the limit is {:.2f} s",
                                  *lag_s, options_.max_latency_s)};
}

}  // namespace rift::hardware
