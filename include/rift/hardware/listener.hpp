#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rift/hardware/wire.hpp"

namespace rift::hardware {

/// What src/firmware/rift_listener.py does on the robot, byte for byte; a test runs both on the
/// same streams. The twin speaks through it.
///
/// Plain lines are obeyed as the authors' listener does. Frames are obeyed when they are newer than
/// the last one (1 to 127 ahead) and a zero came first after the robot stopped by itself; a zero is
/// always obeyed. While frames come, plain lines other than zero are noise. Without a command for
/// kWatchdog_ms the motors stop.
class Listener {
 public:
  static constexpr std::uint32_t kWatchdog_ms = 300;
  static constexpr std::uint32_t kPlainAnswer_ms = 200;
  static constexpr int kReceiveBuffer = 512;  ///< bytes; RECEIVE_BUFFER of src/firmware/main.py

  /// Measured by the robot at the time of a poll.
  struct Senses {
    std::int32_t left = 0;
    std::int32_t right = 0;
    std::uint16_t battery_mv = 0;
  };

  /// One turn of the robot's loop with all bytes that came in since the last; returns what the
  /// robot sends. `now_ms` may wrap around.
  std::vector<std::uint8_t> Poll(std::uint32_t now_ms, Bytes bytes, const Senses& senses);

  const MilliPower& Motors() const { return motors_; }
  std::uint8_t Stops() const { return stops_; }
  std::uint8_t Rejected() const { return rejected_; }

 private:
  enum class Pending { kNone, kFrame, kLine };

  void Scan();
  void TakeFrame(const CommandFrame& frame);
  void TakeText(std::uint8_t byte);
  void TakeLine();
  void Apply(const MilliPower& power, Pending answer);
  void StopByItself();
  void Reject() { ++rejected_; }
  bool Silent() const { return now_ms_ - fed_ms_ >= kWatchdog_ms; }
  std::vector<std::uint8_t> AnswerTo(const Senses& senses);

  std::vector<std::uint8_t> buffer_;
  std::string line_;
  bool skipping_ = false;
  std::uint32_t now_ms_ = 0;
  std::uint32_t fed_ms_ = 0;
  bool fed_ = false;     ///< a command was obeyed and the robot has not stopped by itself since
  bool framed_ = false;  ///< the last command obeyed was a frame
  bool ready_ = false;   ///< a zero frame came since the robot stopped by itself
  std::uint8_t sequence_ = 0;
  Pending pending_ = Pending::kNone;
  bool has_answered_ = false;  ///< a plain line
  std::uint32_t answered_ms_ = 0;
  MilliPower motors_;
  std::uint8_t stops_ = 0;
  std::uint8_t rejected_ = 0;
};

}  // namespace rift::hardware
