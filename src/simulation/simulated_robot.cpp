#include "rift/simulation/simulated_robot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "rift/geometry/pose3.hpp"

namespace rift::simulation {
namespace {

/// Holds every member of an options struct to the range its Fields states, and calls the struct's
/// own Check() when there is one. Throws std::invalid_argument with the path of the member, its
/// value and the range: an experiment built in code is refused like one read from a file.
template <class Options>
void CheckRanges(const Options& options, const std::string& path = "");

template <class Number>
void CheckNumber(const std::string& key, Number value, double min, double max) {
  const double number = static_cast<double>(value);
  if (number >= min && number <= max) return;  // false for NaN too
  std::ostringstream message;
  message << key << " is " << value << ", but it must lie in [" << min << ", " << max << "]";
  throw std::invalid_argument(message.str());
}

struct RangeVisitor {
  const std::string& path;

  template <class Number, class Min, class Max>
  void operator()(const char* key, const Number& value, Min min, Max max, const char*) const {
    CheckNumber(path + key, value, static_cast<double>(min), static_cast<double>(max));
  }
  template <class Min, class Max>
  void operator()(const char* key, const std::optional<double>& value, Min min, Max max,
                  const char*) const {
    if (value) CheckNumber(path + key, *value, static_cast<double>(min), static_cast<double>(max));
  }
  template <class Member>
  void operator()(const char* key, const Member& member, const char*) const {
    if constexpr (std::is_class_v<Member>) Nested(path + key, member);
  }

  template <class Member>
  static void Nested(const std::string& key, const Member& member) {
    CheckRanges(member, key + ".");
  }
  static void Nested(const std::string&, const std::string&) {}
  template <class Item>
  static void Nested(const std::string& key, const std::vector<Item>& items) {
    for (size_t i = 0; i < items.size(); ++i) Nested(key + "[" + std::to_string(i) + "]", items[i]);
  }
  template <class Item>
  static void Nested(const std::string& key, const std::map<std::string, Item>& items) {
    for (const auto& [name, item] : items) Nested(key + "." + name, item);
  }
};

template <class Options>
void CheckRanges(const Options& options, const std::string& path) {
  Options::Fields(options, RangeVisitor{path});
  if constexpr (requires { options.Check(); }) options.Check();
}

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
  const auto [roll_rad, pitch_rad, yaw_rad] = geometry::RollPitchYaw(state.world_from_robot);
  return {
      t_s,    state.position_m.x(), state.position_m.y(), state.position_m.z(), roll_rad, pitch_rad,
      yaw_rad};
}

enum Stream : std::uint64_t { kMotorStream = 30, kGroundStream = 31 };
constexpr double kGrain_m = 0.005;

/// With the mismatch that this run draws.
MotorOptions OfRun(MotorOptions options, std::uint64_t seed) {
  options.mismatch +=
      options.mismatch_spread * statistics::CounterRandom(seed, kMotorStream).Normal(0, 0);
  return options;
}

}  // namespace

SimulatedRobot::SimulatedRobot(const SimulationOptions& options, const geometry::Pose2& start,
                               std::uint64_t seed, std::shared_ptr<const HeightImage> image)
    : options_(Checked(options, start)),
      world_(options.body, Terrain(options.terrain, std::move(image)), start, options.step_s),
      motors_{Motor(OfRun(options.MotorOfSession(), seed), Side::kLeft),
              Motor(OfRun(options.MotorOfSession(), seed), Side::kRight)},
      link_(options.link, seed),
      mocap_(options.MocapOfSession(), seed),
      ground_(seed, kGroundStream),
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
  sensed.fall = world_.Fall();
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
  const control::WheelPower at_end = link_.Held();
  const auto power = [&](double control::WheelPower::*wheel) {
    if (options_.sampling == Sampling::kStepped) return StepPower::Constant(at_start.*wheel);
    return StepPower{at_start.*wheel, mean.*wheel, at_end.*wheel};
  };
  const auto& rate_rad_s = world_.State().wheel_rate_rad_s;
  const std::array<Grip, 2> grip = world_.WheelGrip();
  const StepPower left = power(&control::WheelPower::left);
  const StepPower right = power(&control::WheelPower::right);
  world_.Step({motors_[0].Drive(left, rate_rad_s[0], Drag_nm(grip[0]), options_.step_s),
               motors_[1].Drive(right, rate_rad_s[1], Drag_nm(grip[1]), options_.step_s)},
              {Uneven(0, grip[0]), Uneven(1, grip[1])});
  const TruePose before = truth_;
  truth_ = PoseOf(world_.State(), t_s);
  mocap_.Observe(before, truth_);
}

/// Rolling resistance under the weight at rest, as a torque on the wheel.
double SimulatedRobot::Drag_nm(const Grip& grip) const {
  return grip.rolling_resistance * options_.body.WeightOnWheel_n() * options_.body.wheel_radius_m;
}

/// Along the way that the rim has turned: normal values a grain apart, straight lines between, so
/// that nothing depends on the step or on the speed.
double SimulatedRobot::Uneven(int side, const Grip& grip) const {
  if (grip.unevenness == 0.0) return 0.0;
  const double way_m = world_.State().wheel_angle_rad[side] * options_.body.WheelRadius_m(side);
  const double grain = std::floor(way_m / kGrain_m), share = way_m / kGrain_m - grain;
  const auto at = [&](double k) {
    const auto event = static_cast<std::uint64_t>(static_cast<std::int64_t>(k));
    return ground_.Normal(event, 2 * static_cast<std::uint64_t>(side));
  };
  return grip.unevenness * ((1.0 - share) * at(grain) + share * at(grain + 1.0));
}

}  // namespace rift::simulation
