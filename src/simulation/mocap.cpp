#include "rift/simulation/mocap.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "rift/geometry/pose2.hpp"
#include "rift/geometry/pose3.hpp"

namespace rift::simulation {
namespace {

enum Stream : std::uint64_t {
  kPhaseStream = 20,
  kFrameStream = 21,
  kPoseStream = 22,
  kRunStream = 23,
  kHostStream = 24
};
// Draws of a run and of a turn of the host; a normal value takes two.
enum RunDraw : std::uint64_t {
  kRunNoise = 0,
  kRunPeriod = 2,
  kRunLateShare = 4,
  kRunStandingMirrored = 5,
  kRunIsMirrored = 6
};
enum TurnDraw : std::uint64_t { kWander = 0, kTurnJitter = 2, kLate = 4 };
// Draws of one frame; a normal value takes two.
enum Draw : std::uint64_t {
  kAcross = 0,
  kAlong = 2,
  kYaw = 4,
  kStamp = 6,
  kHeight = 8,
  kRoll = 10,
  kPitch = 12,
  kDropout = 14,
  kArrival = 16,
  kMirrored = 18
};

constexpr double kClockTick_s = 1e-6;
constexpr double kNever_s = std::numeric_limits<double>::infinity();
constexpr double kStanding_mps = 0.01;

TruePose Interpolate(const TruePose& before, const TruePose& after, double t_s) {
  const double span_s = after.t_s - before.t_s;
  const double share = span_s > 0.0 ? std::clamp((t_s - before.t_s) / span_s, 0.0, 1.0) : 1.0;
  const auto between = [share](double a, double b) { return a + share * (b - a); };
  const auto turned = [share](double a, double b) {
    return geometry::WrapToPi(a + share * geometry::WrapToPi(b - a));
  };
  return {t_s,
          between(before.x_m, after.x_m),
          between(before.y_m, after.y_m),
          between(before.z_m, after.z_m),
          turned(before.roll_rad, after.roll_rad),
          turned(before.pitch_rad, after.pitch_rad),
          turned(before.yaw_rad, after.yaw_rad)};
}

double Speed_mps(const TruePose& before, const TruePose& after) {
  const double span_s = after.t_s - before.t_s;
  if (span_s <= 0.0) return 0.0;
  return std::hypot(after.x_m - before.x_m, after.y_m - before.y_m) / span_s;
}

Eigen::Isometry3d TagInWorld(const TruePose& pose, const MocapOptions& options) {
  const Eigen::AngleAxisd yaw(pose.yaw_rad, Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd pitch(pose.pitch_rad, Eigen::Vector3d::UnitY());
  const Eigen::AngleAxisd roll(pose.roll_rad, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d tag_in_robot(options.tag_ahead_m, 0.0, options.tag_above_m);
  Eigen::Isometry3d world_from_tag;
  world_from_tag.linear() = (yaw * pitch * roll).toRotationMatrix();
  world_from_tag.translation() =
      Eigen::Vector3d(pose.x_m, pose.y_m, pose.z_m) + yaw * (pitch * (roll * tag_in_robot));
  world_from_tag.makeAffine();
  return world_from_tag;
}

constexpr double kShortestPeriod_s = 0.005;

MocapOptions OfThisRun(MocapOptions options, std::uint64_t seed) {
  const statistics::CounterRandom drawn(seed, kRunStream);
  options.host_late_share *= 2.0 * drawn.Uniform(0, kRunLateShare);
  if (options.host_period_s) {
    options.host_period_s =
        std::max(kShortestPeriod_s, *options.host_period_s +
                                        options.host_period_spread_s * drawn.Normal(0, kRunPeriod));
  }
  if (drawn.Uniform(0, kRunIsMirrored) >= options.ambiguity.runs) options.ambiguity.share = 0.0;
  return options;
}

}  // namespace

Mocap::Mocap(const MocapOptions& options, std::uint64_t seed)
    : options_(OfThisRun(options, seed)),
      noise_(seed, kPoseStream),
      host_noise_(seed, kHostStream),
      standing_factor_(std::exp(options.noise_spread *
                                statistics::CounterRandom(seed, kRunStream).Normal(0, kRunNoise))),
      standing_mirrored_(
          statistics::CounterRandom(seed, kRunStream).Uniform(0, kRunStandingMirrored)),
      phase_s_(options.rate_hz > 0.0
                   ? statistics::CounterRandom(seed, kPhaseStream).Uniform(0, 0) / options.rate_hz
                   : 0.0),
      last_stamp_s_(-kNever_s) {
  host_done_s_ = options_.host_period_s.value_or(0.0) *
                 statistics::CounterRandom(seed, kPhaseStream).Uniform(1, 0);
}

double Mocap::FrameTime_s(std::uint64_t frame) const {
  // Half a frame at most, so that frames stay in order.
  const double limit_s = 0.49 / options_.rate_hz;
  const double jitter_s = options_.frame_jitter_s * noise_.Normal(frame, kFrameStream << 8);
  return phase_s_ + static_cast<double>(frame) / options_.rate_hz +
         std::clamp(jitter_s, -limit_s, limit_s);
}

void Mocap::Observe(const TruePose& before, const TruePose& after) {
  const double speed_mps = Speed_mps(before, after);
  if (options_.rate_hz == 0.0) {
    newest_ = Measure(after, speed_mps, next_frame_++);
    newest_->captured_s = after.t_s;
    return;
  }
  double t_s = FrameTime_s(next_frame_);
  while (t_s <= after.t_s) {
    TakeFrame(Interpolate(before, after, t_s), speed_mps, next_frame_);
    t_s = FrameTime_s(++next_frame_);
  }
  if (options_.host_period_s) RunHost(after.t_s);
}

void Mocap::TakeFrame(const TruePose& pose, double speed_mps, std::uint64_t frame) {
  if (noise_.Uniform(frame, kDropout) < options_.dropout) return;
  const double arrives_s = pose.t_s + Latency_s();
  trial::PoseMeasurement measurement = Measure(pose, speed_mps, frame);
  if (options_.host_period_s) {
    measurement.captured_s = pose.t_s;  // until the host stamps it
    const double late_s = options_.arrival_jitter_s * std::abs(noise_.Normal(frame, kArrival));
    const double before_s = in_camera_.empty() ? -kNever_s : in_camera_.back().at_s;
    in_camera_.push_back({std::max(arrives_s + late_s, before_s), measurement});
    return;
  }
  // A stamp lies after the last one and not after the arrival, whatever its jitter.
  measurement.captured_s =
      std::min(std::max(measurement.captured_s, last_stamp_s_ + kClockTick_s), arrives_s);
  last_stamp_s_ = measurement.captured_s;
  on_the_way_.push_back({arrives_s, measurement});
}

/// Frames that reach the driver while it holds a picture are dropped; a host that finds none waits
/// for the next.
void Mocap::RunHost(double until_s) {
  for (;;) {
    const double arrives_s = in_camera_.empty() ? kNever_s : in_camera_.front().at_s;
    if (std::min(arrives_s, host_done_s_) > until_s) return;
    if (arrives_s <= host_done_s_) {
      if (!with_driver_) with_driver_ = in_camera_.front().measurement;
      in_camera_.pop_front();
      if (host_done_s_ == kNever_s) BeginTurn(arrives_s);
    } else {
      EndTurn();
    }
  }
}

void Mocap::EndTurn() {
  const double now_s = std::exchange(host_done_s_, kNever_s);
  if (in_work_) {
    in_work_->captured_s = now_s;
    on_the_way_.push_back({now_s, *in_work_});
    in_work_.reset();
  }
  if (with_driver_) BeginTurn(now_s);
}

void Mocap::BeginTurn(double now_s) {
  in_work_ = std::exchange(with_driver_, std::nullopt);
  const std::uint64_t turn = host_turns_++;
  host_wandered_s_ += options_.host_wander_s * host_noise_.Normal(turn, kWander);
  const bool late = host_noise_.Uniform(turn, kLate) < options_.host_late_share;
  host_done_s_ =
      now_s + std::max(0.5 * *options_.host_period_s,
                       *options_.host_period_s + host_wandered_s_ +
                           options_.host_jitter_s * host_noise_.Normal(turn, kTurnJitter) +
                           (late ? options_.host_late_s : 0.0));
}

bool Mocap::IsMirrored(const Eigen::Isometry3d& world_from_tag, double speed_mps,
                       std::uint64_t frame) const {
  double share = MirroredShare(options_.ambiguity, world_from_tag);
  if (share <= 0.0) return false;
  // The mean of u^k over u in [0, 1] is 1 / (k + 1).
  if (speed_mps < kStanding_mps) share = std::pow(standing_mirrored_, 1.0 / share - 1.0);
  return noise_.Uniform(frame, kMirrored) < share;
}

trial::PoseMeasurement Mocap::Measure(const TruePose& pose, double speed_mps,
                                      std::uint64_t frame) const {
  Eigen::Isometry3d world_from_tag = TagInWorld(pose, options_);
  std::array<double, 3> angles_rad{pose.roll_rad, pose.pitch_rad, pose.yaw_rad};
  if (IsMirrored(world_from_tag, speed_mps, frame)) {
    world_from_tag = Mirrored(options_.ambiguity, world_from_tag);
    angles_rad = geometry::RollPitchYaw(world_from_tag.linear());
  }
  const auto [roll_rad, pitch_rad, yaw_rad] = angles_rad;
  const Eigen::Vector3d tag_in_world = world_from_tag.translation();
  const double factor = speed_mps < kStanding_mps ? standing_factor_ : 1.0;
  const double across_m =
      std::hypot(factor * options_.noise_across_m, options_.blur_across_s * speed_mps) *
      noise_.Normal(frame, kAcross);
  const double along_m = factor * options_.noise_along_m * noise_.Normal(frame, kAlong);
  const double yaw_noise_rad =
      std::hypot(factor * options_.noise_yaw_rad, options_.blur_yaw_rad_per_mps * speed_mps) *
      noise_.HeavyTailed(frame, kYaw, options_.yaw_tail_dof);
  const geometry::Pose2 tag{tag_in_world.x(), tag_in_world.y(), yaw_rad};
  trial::PoseMeasurement measurement;
  measurement.captured_s = pose.t_s + options_.stamp_jitter_s * noise_.Normal(frame, kStamp);
  measurement.world_from_robot = tag * geometry::Pose2{along_m, across_m, yaw_noise_rad};
  measurement.z_m = tag_in_world.z() + options_.noise_z_m * noise_.Normal(frame, kHeight);
  measurement.roll_rad = roll_rad + options_.noise_tilt_rad * noise_.Normal(frame, kRoll);
  measurement.pitch_rad = pitch_rad + options_.noise_tilt_rad * noise_.Normal(frame, kPitch);
  return measurement;
}

std::optional<trial::PoseMeasurement> Mocap::Newest(double now_s) {
  while (!on_the_way_.empty() && on_the_way_.front().at_s <= now_s) {
    newest_ = on_the_way_.front().measurement;
    on_the_way_.pop_front();
  }
  return newest_;
}

}  // namespace rift::simulation
