#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "rift/hardware/options.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/hardware/wire.hpp"

namespace rift::hardware {

/// Finds answers in what comes back, between the messages of radio modules (`OK+LOST`, `OK+CONN`).
class AnswerDecoder {
 public:
  std::vector<Answer> Take(Bytes bytes);

 private:
  void TakeText(std::uint8_t byte, std::vector<Answer>& answers);

  std::vector<std::uint8_t> buffer_;
  std::string line_;
};

/// When the line may carry the next command: at most `share` of its bytes are used, each way. Of
/// commands that holds at any time; of the longer answers on average, so that a command that was a
/// little late does not make all later ones late.
class LinkPacer {
 public:
  LinkPacer(int baud, double share) : byte_s_(ByteTime_s(baud) / share) {}

  bool MayWrite(double now_s) const { return now_s >= free_s_; }
  void Wrote(double now_s, size_t command_bytes, size_t answer_bytes) {
    answers_end_s_ = std::max(answers_end_s_, now_s) + Time_s(answer_bytes);
    free_s_ = std::max(now_s, answers_end_s_ - Time_s(answer_bytes)) + Time_s(command_bytes);
  }
  /// For which so many bytes keep the line.
  double Time_s(size_t bytes) const { return byte_s_ * static_cast<double>(bytes); }

 private:
  double byte_s_;  // 8N1: ten bits a byte
  double free_s_ = 0.0;
  double answers_end_s_ = 0.0;
};

/// Hands the newest command to the robot as often as the line allows, and hears its answers. There
/// is no queue: a command that waits is replaced by a newer one. Knows no clock of its own.
class RobotLink {
 public:
  struct Sent {
    std::uint8_t sequence = 0;
    double at_s = 0.0;
    MilliPower power;
  };
  struct Heard {
    Answer answer;
    double at_s = 0.0;
    std::optional<Sent> sent;  ///< the command answered; none for a plain line
  };

  /// `protocol` is plain or framed; FindProtocol tells which.
  RobotLink(ByteLine& line, const LineOptions& options, Protocol protocol, PlainOptions plain = {});

  /// The command from now on. `at_once`: also when it is the one in force already.
  void Put(const control::WheelPower& power, bool at_once);
  /// The same, but it goes out only with the next command that is due, a heartbeat at the latest.
  void PutForLater(const control::WheelPower& power) { power_ = power; }
  /// How long a command keeps the line from the next one.
  double Occupied_s() const { return pacer_.Time_s(std::max(CommandSize(), AnswerSize())); }
  /// Reads what has come, writes what is due. Throws LineGone.
  void Tick(double now_s);
  /// Reads alone. Throws LineGone.
  void Listen(double now_s);

  Protocol protocol() const { return protocol_; }
  /// What was heard since the last call.
  std::vector<Heard> TakeHeard();
  /// Age of the oldest command that waits for its answer, or for the line to take it.
  double Lag_s(double now_s) const;
  /// The last command written; none before the first.
  const std::optional<Sent>& last_sent() const { return last_sent_; }
  size_t sent_count() const { return sent_count_; }
  size_t answered_count() const { return answered_count_; }

 private:
  void Match(Heard& heard);
  void WriteCommand(double now_s);
  size_t CommandSize() const;
  size_t AnswerSize() const;

  ByteLine& line_;
  LineOptions options_;
  Protocol protocol_;
  PlainOptions plain_;
  LinkPacer pacer_;
  AnswerDecoder decoder_;
  control::WheelPower power_;
  bool is_due_ = true;
  std::uint8_t next_sequence_ = 1;
  std::optional<Sent> last_sent_;
  std::deque<Sent> unanswered_;
  std::optional<double> blocked_since_s_;
  std::vector<Heard> heard_;
  size_t sent_count_ = 0;
  size_t answered_count_ = 0;
};

/// Says hello, which to every listener is the plain command to stand still, and waits for an answer
/// as long as options.hello_s; without one the robot speaks plain. Throws LineGone.
Protocol FindProtocol(ByteLine& line, Clock& clock, const LineOptions& options,
                      const PlainOptions& plain = {});

}  // namespace rift::hardware
