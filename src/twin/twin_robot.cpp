#include "twin_robot.hpp"

#include <algorithm>
#include <cmath>

#include "rift/statistics/random.hpp"

namespace rift::twin {
namespace {

constexpr double kBitsPerByte = 10.0;  // 8N1: start, eight bits, stop

constexpr double kRounding_s = 1e-9;

/// The listener sets the motors directly: the radio lies before it, in the byte channels.
simulation::SimulationOptions WithoutRadio(simulation::SimulationOptions options) {
  options.link = {
      .delay_s = 0.0, .baud = 0.0, .poll_s = 0.0, .uart_bytes = 0, .two_decimals = false};
  options.encoder.reported = true;
  return options;
}

/// Streams that a simulated run does not use.
enum Stream : std::uint64_t { kToRobotStream = 100, kToHostStream = 101 };

}  // namespace

void ByteChannel::Put(double at_s, std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  const double byte_s = options_.baud > 0.0 ? kBitsPerByte / options_.baud : 0.0;
  const bool is_lost = Happens(options_.line_loss);
  free_s_ = std::max(at_s + options_.delay_s, free_s_);
  for (const std::uint8_t value : bytes) {
    free_s_ += byte_s;
    if (is_lost || Happens(options_.byte_loss)) continue;
    on_the_way_.push_back({free_s_, value});
  }
}

std::vector<std::uint8_t> ByteChannel::Take(double now_s) {
  std::vector<std::uint8_t> arrived;
  while (!on_the_way_.empty() && on_the_way_.front().arrives_s <= now_s) {
    arrived.push_back(on_the_way_.front().value);
    on_the_way_.pop_front();
  }
  return arrived;
}

TwinRobot::TwinRobot(const simulation::SimulationOptions& options, double battery_v,
                     const geometry::Pose2& start, std::uint64_t seed,
                     std::shared_ptr<const simulation::HeightImage> image)
    : robot_(WithoutRadio(options), start, seed, std::move(image)),
      to_robot_(options.link, statistics::SeedOfStream(seed, kToRobotStream)),
      to_host_(options.link, statistics::SeedOfStream(seed, kToHostStream)),
      battery_mv_(static_cast<std::uint16_t>(std::lround(1e3 * battery_v))) {}

hardware::Listener::Senses TwinRobot::Senses() {
  const control::EncoderCounts counts = robot_.Sense().encoders.value_or(control::EncoderCounts{});
  return {static_cast<std::int32_t>(counts.left), static_cast<std::int32_t>(counts.right),
          battery_mv_};
}

control::WheelPower TwinRobot::Motors() const {
  return {1e-3 * listener_.Motors().left, 1e-3 * listener_.Motors().right};
}

void TwinRobot::Advance(double to_s, const Observer& observer) {
  while (Now_s() + kTurn_s <= to_s + kRounding_s) {
    const std::vector<std::uint8_t> heard = to_robot_.Take(Now_s());
    const auto now_ms = static_cast<std::uint32_t>(turns_);  // a turn is a millisecond
    to_host_.Put(Now_s(), listener_.Poll(now_ms, heard, Senses()));
    if (const control::WheelPower power = Motors(); !(power == commanded_)) {
      robot_.Command(power);
      commanded_ = power;
    }
    robot_.Advance(kTurn_s);
    ++turns_;
    const simulation::TruePose pose = robot_.Truth();
    if (pose.t_s > observed_s_) {
      observed_s_ = pose.t_s;
      observer(pose, commanded_);
    }
  }
}

}  // namespace rift::twin
