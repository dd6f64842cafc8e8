#include "rift/hardware/robot_link.hpp"

#include <algorithm>
#include <utility>

namespace rift::hardware {
namespace {

constexpr size_t kLongestLine = 64;
constexpr double kHelloPeriod_s = 0.25;  // above the 0.2 s that the listener takes between answers
constexpr double kHelloTick_s = 0.005;

Bytes BytesOf(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

std::vector<Answer> AnswerDecoder::Take(Bytes bytes) {
  std::vector<Answer> answers;
  for (const std::uint8_t received : bytes) {
    buffer_.push_back(received);
    while (!buffer_.empty()) {
      if (buffer_[0] == Answer::kStart) {
        if (buffer_.size() < Answer::kSize) break;
        if (const auto answer = DecodeAnswer(Bytes(buffer_).first(Answer::kSize))) {
          answers.push_back(*answer);
          line_.clear();
          buffer_.erase(buffer_.begin(), buffer_.begin() + Answer::kSize);
          continue;
        }
      }
      const std::uint8_t byte = buffer_.front();
      buffer_.erase(buffer_.begin());
      TakeText(byte, answers);
    }
  }
  return answers;
}

void AnswerDecoder::TakeText(std::uint8_t byte, std::vector<Answer>& answers) {
  if (byte != '\n') {
    if (line_.size() == kLongestLine) line_.erase(0, 1);
    line_ += static_cast<char>(byte);
    return;
  }
  // A module's own text ends without a newline, so the robot's line follows on it.
  const size_t start = line_.rfind("rift1 ");
  if (start != std::string::npos) {
    if (const auto answer = ParseAnswerLine(std::string_view(line_).substr(start))) {
      answers.push_back(*answer);
    }
  }
  line_.clear();
}

RobotLink::RobotLink(ByteLine& line, const LineOptions& options, Protocol protocol,
                     PlainOptions plain)
    : line_(line),
      options_(options),
      protocol_(protocol),
      plain_(std::move(plain)),
      pacer_(options.baud, options.line_share) {}

void RobotLink::Put(const control::WheelPower& power, bool at_once) {
  is_due_ = is_due_ || at_once || !(power == power_);
  power_ = power;
}

void RobotLink::Tick(double now_s) {
  Listen(now_s);
  const bool is_due = is_due_ || !last_sent_ || now_s - last_sent_->at_s >= options_.heartbeat_s;
  if (!is_due || !pacer_.MayWrite(now_s)) return;
  if (line_.Unsent() > 0) {  // the system's own queue would make commands old
    if (!blocked_since_s_) blocked_since_s_ = now_s;
    return;
  }
  WriteCommand(now_s);
}

size_t RobotLink::CommandSize() const {
  return protocol_ == Protocol::kFramed ? CommandFrame::kSize
                                        : PlainLine({-1.0, -1.0}, plain_).size();
}

// A plain line is answered so rarely that it does not count.
size_t RobotLink::AnswerSize() const { return protocol_ == Protocol::kFramed ? Answer::kSize : 0; }

void RobotLink::WriteCommand(double now_s) {
  const Sent sent{next_sequence_++, now_s, MilliOf(power_)};
  bool taken = false;
  if (protocol_ == Protocol::kFramed) {
    const CommandBytes bytes = Encode(CommandFrame{sent.sequence, sent.power});
    taken = line_.Write(bytes);
    unanswered_.push_back(sent);
  } else {
    taken = line_.Write(BytesOf(PlainLine(power_, plain_)));
  }
  pacer_.Wrote(now_s, CommandSize(), AnswerSize());
  if (taken) {
    blocked_since_s_.reset();
  } else if (!blocked_since_s_) {
    blocked_since_s_ = now_s;
  }
  is_due_ = !taken;
  last_sent_ = sent;
  ++sent_count_;
}

void RobotLink::Listen(double now_s) {
  for (const Answer& answer : decoder_.Take(line_.Read())) {
    Heard heard{answer, now_s, std::nullopt};
    if (answer.sequence) {
      Match(heard);
      if (!heard.sent) continue;  // an answer to what was never asked: noise, or an earlier program
    }
    heard_.push_back(heard);
  }
}

void RobotLink::Match(Heard& heard) {
  // The newest of that number, which each 256th command has.
  const auto found = std::find_if(unanswered_.rbegin(), unanswered_.rend(), [&](const Sent& sent) {
    return sent.sequence == *heard.answer.sequence;
  });
  if (found == unanswered_.rend()) return;
  heard.sent = *found;
  unanswered_.erase(unanswered_.begin(), found.base());  // older ones are lost
  ++answered_count_;
}

std::vector<RobotLink::Heard> RobotLink::TakeHeard() { return std::exchange(heard_, {}); }

double RobotLink::Lag_s(double now_s) const {
  double lag_s = unanswered_.empty() ? 0.0 : now_s - unanswered_.front().at_s;
  if (blocked_since_s_) lag_s = std::max(lag_s, now_s - *blocked_since_s_);
  return lag_s;
}

Protocol FindProtocol(ByteLine& line, Clock& clock, const LineOptions& options,
                      const PlainOptions& plain) {
  if (options.protocol != Protocol::kAuto) return options.protocol;
  const std::string hello = PlainLine({}, plain);
  AnswerDecoder decoder;
  const double end_s = clock.Now_s() + options.hello_s;
  double next_hello_s = clock.Now_s();
  double now_s = next_hello_s;
  while (now_s < end_s) {
    if (now_s >= next_hello_s && line.Unsent() == 0) {
      line.Write(BytesOf(hello));
      next_hello_s = now_s + kHelloPeriod_s;
    }
    if (!decoder.Take(line.Read()).empty()) return Protocol::kFramed;
    clock.Wait(kHelloTick_s);
    now_s = clock.Now_s();
  }
  return Protocol::kPlain;
}

}  // namespace rift::hardware
