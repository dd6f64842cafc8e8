#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "rift/hardware/options.hpp"
#include "rift/trial/robot.hpp"

/// The bytes between host and robot. Two languages, which the robot's listener (src/firmware) tells
/// apart by themselves: `plain`, the authors' text, and `framed`.
///
///   command, 11 bytes: A5 seq left right ~left ~right crc     powers: int16 LE in 1/1000
///   answer,  15 bytes: 5A seq stops left right battery rejected crc
///                      counts: int32 LE, battery: uint16 LE in mV, stops and rejected modulo 256
///
/// crc is CRC-8 (x^8 + x^2 + x + 1, start 0) over all bytes before it: up to three wrong bits in a
/// frame are always seen. With the complements, fewer than 1 in 50,000 of the patterns of four
/// wrong bits change a power unseen, and random bytes pass as a command once in about 2^58 (start,
/// complements, crc, range).
namespace rift::hardware {

/// What a byte takes on the serial line, in seconds: ten bits (8N1: start, eight, stop).
constexpr double ByteTime_s(int baud) { return 10.0 / baud; }

using Bytes = std::span<const std::uint8_t>;

/// A command as text, by default the authors' line, "%.2f %.2f\n", left and right, rounded towards
/// zero power. Throws
/// std::invalid_argument unless both powers are in [-1, 1], and for a format that PlainOptions
/// would refuse.
std::string PlainLine(const control::WheelPower& power, const PlainOptions& options = {});

/// A power as the motors take it, in 1/1000 of full power.
struct MilliPower {
  int left = 0;
  int right = 0;

  bool IsZero() const { return left == 0 && right == 0; }
  friend bool operator==(const MilliPower&, const MilliPower&) = default;
};
/// Rounds to 1/1000. Throws std::invalid_argument unless both powers are in [-1, 1].
MilliPower MilliOf(const control::WheelPower& power);

/// Exactly two numbers with exactly two decimals and one blank between, both in [-1, 1], without
/// the newline; none for anything else, since a lost byte turns 0.85 into 85, 0.8 or 0.850.90.
std::optional<MilliPower> ParsePlainLine(std::string_view line);

std::uint8_t Crc8(Bytes bytes);

struct CommandFrame {
  static constexpr std::uint8_t kStart = 0xA5;  // no character of a plain line
  static constexpr size_t kSize = 11;

  std::uint8_t sequence = 0;
  MilliPower power;
};
using CommandBytes = std::array<std::uint8_t, CommandFrame::kSize>;
CommandBytes Encode(const CommandFrame& frame);
/// None unless there are exactly kSize bytes and every check holds.
std::optional<CommandFrame> DecodeCommand(Bytes bytes);

/// What the robot says back, to a frame or to a plain line.
struct Answer {
  static constexpr std::uint8_t kStart = 0x5A;
  static constexpr size_t kSize = 15;

  std::optional<std::uint8_t> sequence;  ///< of the command obeyed; none in answer to a plain line
  std::uint8_t stops = 0;  ///< how often the robot has stopped by itself since it was switched on
  std::int32_t left = 0;   ///< encoder counts since then, forward positive
  std::int32_t right = 0;
  std::uint16_t battery_mv = 0;
  std::uint8_t rejected = 0;  ///< frames and lines that it did not obey

  friend bool operator==(const Answer&, const Answer&) = default;
};
using AnswerBytes = std::array<std::uint8_t, Answer::kSize>;
/// The framed answer; its sequence must be there.
AnswerBytes Encode(const Answer& answer);
/// None unless there are exactly kSize bytes and the checksum holds.
std::optional<Answer> DecodeAnswer(Bytes bytes);

/// "rift1 LEFT RIGHT MILLIVOLTS*CRC\n": how the listener answers a plain line, which tells the host
/// that frames are understood as well. The authors' listener says nothing.
std::string AnswerLine(const Answer& answer);
/// The same without its newline; none for anything else.
std::optional<Answer> ParseAnswerLine(std::string_view line);

}  // namespace rift::hardware
