#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "rift/hardware/listener.hpp"
#include "rift/simulation/link.hpp"
#include "rift/simulation/simulated_robot.hpp"

namespace rift::twin {

/// One way of a serial radio: delay, baud rate and losses of the simulated link, for any bytes.
/// What was put in at once is lost as a whole by line_loss. Times in s, never running backwards.
class ByteChannel {
 public:
  ByteChannel(const simulation::LinkOptions& options, std::uint64_t seed)
      : options_(options), random_(seed) {}

  void Put(double at_s, std::span<const std::uint8_t> bytes);
  /// What has arrived by then and was not taken before.
  std::vector<std::uint8_t> Take(double now_s);
  std::size_t OnTheWay() const { return on_the_way_.size(); }

 private:
  struct Byte {
    double arrives_s;
    std::uint8_t value;
  };

  bool Happens(double share) { return std::uniform_real_distribution<>(0.0, 1.0)(random_) < share; }

  simulation::LinkOptions options_;
  std::mt19937_64 random_;
  std::deque<Byte> on_the_way_;
  double free_s_ = 0.0;
};

/// The simulated robot with rift's listener between its radio and its motors: bytes in, bytes out.
/// Knows no clock; the same bytes at the same times move it the same way.
class TwinRobot {
 public:
  /// Called for every physics step with the pose at its end and the power at the motors.
  using Observer = std::function<void(const simulation::TruePose&, const control::WheelPower&)>;

  /// At rest at `start`; see SimulatedRobot.
  TwinRobot(const simulation::SimulationOptions& options, double battery_v,
            const geometry::Pose2& start, std::uint64_t seed,
            std::shared_ptr<const simulation::HeightImage> image = nullptr);

  /// The host wrote these bytes at `at_s`.
  void Receive(double at_s, std::span<const std::uint8_t> bytes) { to_robot_.Put(at_s, bytes); }
  /// Whether the radio has room for more, as its flow control would tell the host: 4 KiB are on the
  /// way at most, and then what was put in last.
  bool CanReceive() const { return to_robot_.OnTheWay() < 4096; }
  /// Runs up to `to_s`.
  void Advance(double to_s, const Observer& observer);
  /// What has reached the host by then.
  std::vector<std::uint8_t> Transmit(double now_s) { return to_host_.Take(now_s); }

  control::WheelPower Motors() const;
  double Now_s() const { return kTurn_s * static_cast<double>(turns_); }
  simulation::TruePose Truth() const { return robot_.Truth(); }
  const hardware::Listener& Listener() const { return listener_; }

 private:
  static constexpr double kTurn_s = 0.001;  ///< of the listener's loop

  hardware::Listener::Senses Senses();

  simulation::SimulatedRobot robot_;
  hardware::Listener listener_;
  ByteChannel to_robot_;
  ByteChannel to_host_;
  std::uint16_t battery_mv_;
  std::int64_t turns_ = 0;
  control::WheelPower commanded_;
  double observed_s_ = 0.0;
};

}  // namespace rift::twin
