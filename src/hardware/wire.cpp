#include "rift/hardware/wire.hpp"

#include <fmt/format.h>

#include <cassert>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace rift::hardware {
namespace {

constexpr int kFull = 1000;

void RequirePower(const char* side, double power) {
  if (std::abs(power) <= 1.0) return;  // false for NaN
  throw std::invalid_argument(
      fmt::format("the {} power is {}, but it must lie in [-1, 1]", side, power));
}

void RequirePowers(const control::WheelPower& power) {
  RequirePower("left", power.left);
  RequirePower("right", power.right);
}

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// "-0.85": sign, one digit, point, two digits; takes it off the front of `text`.
std::optional<int> TakeMilli(std::string_view& text) {
  const bool negative = text.starts_with('-');
  std::string_view rest = text.substr(negative ? 1 : 0);
  if (rest.size() < 4 || !IsDigit(rest[0]) || rest[1] != '.' || !IsDigit(rest[2]) ||
      !IsDigit(rest[3])) {
    return std::nullopt;
  }
  const int milli = (rest[0] - '0') * 1000 + (rest[2] - '0') * 100 + (rest[3] - '0') * 10;
  if (milli > kFull) return std::nullopt;
  text = rest.substr(4);
  return negative ? -milli : milli;
}

template <size_t kSize>
class Writer {
 public:
  explicit Writer(std::array<std::uint8_t, kSize>& bytes) : bytes_(bytes) {}
  void Put(std::uint32_t value, int width) {
    for (int i = 0; i < width; ++i) {
      bytes_[used_++] = static_cast<std::uint8_t>(value >> (8 * i));
    }
  }
  void Seal() { bytes_[kSize - 1] = Crc8(Bytes(bytes_).first(kSize - 1)); }

 private:
  std::array<std::uint8_t, kSize>& bytes_;
  size_t used_ = 0;
};

std::uint32_t Get(Bytes bytes, size_t at, int width) {
  std::uint32_t value = 0;
  for (int i = 0; i < width; ++i) value |= std::uint32_t{bytes[at + i]} << (8 * i);
  return value;
}

bool IsSealed(Bytes bytes, std::uint8_t start, size_t size) {
  return bytes.size() == size && bytes[0] == start && Crc8(bytes.first(size - 1)) == bytes.back();
}

bool IsPower(int milli) { return milli >= -kFull && milli <= kFull; }

/// A whole number up to `end`, which it takes off the front of `text` with it.
template <class Integer>
bool TakeInteger(std::string_view& text, char end, Integer& value) {
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop == text.data() + text.size() || *stop != end) return false;
  text.remove_prefix(static_cast<size_t>(stop - text.data()) + 1);
  return true;
}

std::uint8_t Crc8Of(std::string_view text) {
  return Crc8(Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

constexpr std::string_view kHello = "rift1 ";

}  // namespace

MilliPower MilliOf(const control::WheelPower& power) {
  RequirePowers(power);
  return {static_cast<int>(std::lround(power.left * kFull)),
          static_cast<int>(std::lround(power.right * kFull))};
}

std::optional<MilliPower> ParsePlainLine(std::string_view line) {
  const std::optional<int> left = TakeMilli(line);
  if (!left || !line.starts_with(' ')) return std::nullopt;
  line.remove_prefix(1);
  const std::optional<int> right = TakeMilli(line);
  if (!right || !line.empty()) return std::nullopt;
  return MilliPower{*left, *right};
}

std::uint8_t Crc8(Bytes bytes) {
  std::uint8_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint8_t>(crc & 0x80 ? (crc << 1) ^ 0x07 : crc << 1);
    }
  }
  return crc;
}

CommandBytes Encode(const CommandFrame& frame) {
  assert(IsPower(frame.power.left) && IsPower(frame.power.right));
  CommandBytes bytes;
  Writer writer(bytes);
  writer.Put(CommandFrame::kStart, 1);
  writer.Put(frame.sequence, 1);
  writer.Put(static_cast<std::uint32_t>(frame.power.left), 2);
  writer.Put(static_cast<std::uint32_t>(frame.power.right), 2);
  writer.Put(~static_cast<std::uint32_t>(frame.power.left), 2);
  writer.Put(~static_cast<std::uint32_t>(frame.power.right), 2);
  writer.Seal();
  return bytes;
}

std::optional<CommandFrame> DecodeCommand(Bytes bytes) {
  if (!IsSealed(bytes, CommandFrame::kStart, CommandFrame::kSize)) return std::nullopt;
  if ((Get(bytes, 2, 4) ^ Get(bytes, 6, 4)) != 0xFFFF'FFFF) return std::nullopt;
  const MilliPower power{static_cast<std::int16_t>(Get(bytes, 2, 2)),
                         static_cast<std::int16_t>(Get(bytes, 4, 2))};
  if (!IsPower(power.left) || !IsPower(power.right)) return std::nullopt;
  return CommandFrame{bytes[1], power};
}

AnswerBytes Encode(const Answer& answer) {
  AnswerBytes bytes;
  Writer writer(bytes);
  writer.Put(Answer::kStart, 1);
  writer.Put(answer.sequence.value(), 1);
  writer.Put(answer.stops, 1);
  writer.Put(static_cast<std::uint32_t>(answer.left), 4);
  writer.Put(static_cast<std::uint32_t>(answer.right), 4);
  writer.Put(answer.battery_mv, 2);
  writer.Put(answer.rejected, 1);
  writer.Seal();
  return bytes;
}

std::optional<Answer> DecodeAnswer(Bytes bytes) {
  if (!IsSealed(bytes, Answer::kStart, Answer::kSize)) return std::nullopt;
  return Answer{bytes[1],
                bytes[2],
                static_cast<std::int32_t>(Get(bytes, 3, 4)),
                static_cast<std::int32_t>(Get(bytes, 7, 4)),
                static_cast<std::uint16_t>(Get(bytes, 11, 2)),
                bytes[13]};
}

std::string AnswerLine(const Answer& answer) {
  const std::string text =
      fmt::format("{}{} {} {}", kHello, answer.left, answer.right, answer.battery_mv);
  return fmt::format("{}*{:02x}\n", text, Crc8Of(text));
}

std::optional<Answer> ParseAnswerLine(std::string_view line) {
  if (!line.starts_with(kHello)) return std::nullopt;
  const std::string_view sealed = line.substr(0, line.find('*'));
  std::string_view rest = line.substr(kHello.size());
  Answer answer;
  if (!TakeInteger(rest, ' ', answer.left) || !TakeInteger(rest, ' ', answer.right) ||
      !TakeInteger(rest, '*', answer.battery_mv) || rest != fmt::format("{:02x}", Crc8Of(sealed))) {
    return std::nullopt;
  }
  return answer;
}

}  // namespace rift::hardware
