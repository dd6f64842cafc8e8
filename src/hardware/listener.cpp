#include "rift/hardware/listener.hpp"

#include <utility>

namespace rift::hardware {
namespace {

constexpr size_t kLongestLine = 11;  // "-0.85 -0.90"
constexpr std::uint8_t kWindow = 127;

}  // namespace

std::vector<std::uint8_t> Listener::Poll(std::uint32_t now_ms, Bytes bytes, const Senses& senses) {
  now_ms_ = now_ms;
  if (fed_ && Silent()) StopByItself();
  for (const std::uint8_t byte : bytes) {
    buffer_.push_back(byte);
    Scan();
  }
  return AnswerTo(senses);
}

void Listener::Scan() {
  while (!buffer_.empty()) {
    if (buffer_[0] == CommandFrame::kStart) {
      if (buffer_.size() < CommandFrame::kSize) return;
      if (const auto frame = DecodeCommand(Bytes(buffer_).first(CommandFrame::kSize))) {
        buffer_.erase(buffer_.begin(), buffer_.begin() + CommandFrame::kSize);
        TakeFrame(*frame);
        continue;
      }
      Reject();
    }
    const std::uint8_t byte = buffer_.front();
    buffer_.erase(buffer_.begin());
    TakeText(byte);
  }
}

void Listener::TakeFrame(const CommandFrame& frame) {
  line_.clear();
  skipping_ = false;
  const bool is_zero = frame.power.IsZero();
  const std::uint8_t ahead = static_cast<std::uint8_t>(frame.sequence - sequence_);
  if (!is_zero && !(ready_ && ahead >= 1 && ahead <= kWindow)) return Reject();
  sequence_ = frame.sequence;
  ready_ = true;
  framed_ = true;
  Apply(frame.power, Pending::kFrame);
}

void Listener::TakeText(std::uint8_t byte) {
  if (byte == '\n') {
    if (!skipping_) TakeLine();
    line_.clear();
    skipping_ = false;
    return;
  }
  if (skipping_) return;
  line_ += static_cast<char>(byte);
  // An HM-10 that loses its partner says so on its serial line, without a newline.
  if (line_.ends_with("OK+LOST")) {
    line_.clear();
    StopByItself();
  } else if (line_.size() > kLongestLine) {
    line_.clear();
    skipping_ = true;
    Reject();
  }
}

void Listener::TakeLine() {
  if (line_.empty()) return;
  const std::optional<MilliPower> power = ParsePlainLine(line_);
  if (!power || (framed_ && fed_ && !power->IsZero())) return Reject();
  if (!fed_) framed_ = false;
  Apply(*power, Pending::kLine);
}

void Listener::Apply(const MilliPower& power, Pending answer) {
  motors_ = power;
  fed_ms_ = now_ms_;
  fed_ = true;
  pending_ = answer;
}

void Listener::StopByItself() {
  motors_ = {};
  fed_ = false;
  ready_ = false;
  ++stops_;
}

std::vector<std::uint8_t> Listener::AnswerTo(const Senses& senses) {
  const Pending pending = std::exchange(pending_, Pending::kNone);
  const Answer answer{sequence_, stops_, senses.left, senses.right, senses.battery_mv, rejected_};
  if (pending == Pending::kFrame) {
    const AnswerBytes bytes = Encode(answer);
    return {bytes.begin(), bytes.end()};
  }
  if (pending == Pending::kLine && (!has_answered_ || now_ms_ - answered_ms_ >= kPlainAnswer_ms)) {
    has_answered_ = true;
    answered_ms_ = now_ms_;
    const std::string line = AnswerLine(answer);
    return {line.begin(), line.end()};
  }
  return {};
}

}  // namespace rift::hardware
