#include "rift/simulation/simulated_robot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "check_ranges.hpp"

namespace rift::simulation {
namespace {

constexpr double kLongest_s = 1e6;
constexpr double kRounding = 1e-9;

SimulationOptions Checked(const SimulationOptions& options, const geometry::Pose2& start) {
  CheckRanges(options);
  if (!start.IsFinite()) {
    throw std::invalid_argument(fmt::format("the start pose is ({}, {}, {}), but it must be finite",
                                            start.x_m, start.y_m, start.yaw_rad));
  }
  return options;
}

double Power(const char* side, double power) {
  if (!(std::abs(power) <= 1.0 + kRounding)) {
    throw std::invalid_argument(
        fmt::format("the {} power is {}, but it must lie in [-1, 1]", side, power));
  }
  return std::clamp(power, -1.0, 1.0);
}

TruePose PoseOf(const WorldState& state, double t_s) {
  const Eigen::Matrix3d& r = state.world_from_robot;
  return {t_s,
          state.position_m.x(),
          state.position_m.y(),
          state.position_m.z(),
          std::atan2(r(2, 1), r(2, 2)),
          -std::asin(std::clamp(r(2, 0), -1.0, 1.0)),
          std::atan2(r(1, 0), r(0, 0))};
}

}  // namespace

SimulatedRobot::SimulatedRobot(const SimulationOptions& options, const geometry::Pose2& start,
                               std::uint64_t seed, std::shared_ptr<const HeightImage> image)
    : options_(Checked(options, start)),
      world_(options.body, Terrain(options.terrain, std::move(image)), start, options.step_s),
      motors_{Motor(options.motor, Side::kLeft), Motor(options.motor, Side::kRight)},
      link_(options.link, seed),
      mocap_(options.mocap, seed),
      counts_per_rev_(options.encoder.counts_per_rev.value_or(
          DataOf(options.motor.gearing).encoder_counts_per_rev)),
      step_ns_(std::llround(options.step_s * 1e9)),
      truth_(PoseOf(world_.State(), 0.0)) {
  mocap_.Observe(truth_, truth_);
}

trial::Sensed SimulatedRobot::Sense() {
  trial::Sensed sensed;
  sensed.now_s = Now_s();
  sensed.pose = mocap_.Newest(sensed.now_s);
  if (options_.encoder.reported) {
    const auto& angle_rad = world_.State().wheel_angle_rad;
    sensed.encoders = control::EncoderCounts{CountsAt(angle_rad[0], counts_per_rev_),
                                             CountsAt(angle_rad[1], counts_per_rev_)};
  }
  sensed.fault = world_.Fault();
  return sensed;
}

void SimulatedRobot::Command(const control::WheelPower& power) {
  link_.Send(Now_s(), {Power("left", power.left), Power("right", power.right)});
}

void SimulatedRobot::Stop() noexcept { link_.SendUrgently(Now_s(), {}); }

void SimulatedRobot::Advance(double dt_s) {
  if (!(dt_s >= 0.0 && dt_s <= kLongest_s)) {
    throw std::invalid_argument(
        fmt::format("the robot cannot advance by {} s, only by 0 to {} s", dt_s, kLongest_s));
  }
  now_ns_ += std::llround(dt_s * 1e9);
  while ((steps_ + 1) * step_ns_ <= now_ns_) Step();
}

void SimulatedRobot::Step() {
  link_.Advance(truth_.t_s);  // what was commanded since, and takes effect at once
  const control::WheelPower at_start = link_.Held();
  ++steps_;
  const double t_s = 1e-9 * static_cast<double>(steps_ * step_ns_);
  const control::WheelPower mean = link_.Advance(t_s);
  const control::WheelPower power = options_.sampling == Sampling::kRamped ? mean : at_start;
  const auto& rate_rad_s = world_.State().wheel_rate_rad_s;
  const std::array<Grip, 2> grip = world_.WheelGrip();
  world_.Step({motors_[0].Drive(power.left, rate_rad_s[0], Drag_nm(grip[0]), options_.step_s),
               motors_[1].Drive(power.right, rate_rad_s[1], Drag_nm(grip[1]), options_.step_s)});
  const TruePose before = truth_;
  truth_ = PoseOf(world_.State(), t_s);
  mocap_.Observe(before, truth_);
}

/// Rolling resistance under the weight at rest, as a torque on the wheel.
double SimulatedRobot::Drag_nm(const Grip& grip) const {
  return grip.rolling_resistance * options_.body.WeightOnWheel_n() * options_.body.wheel_radius_m;
}

}  // namespace rift::simulation
