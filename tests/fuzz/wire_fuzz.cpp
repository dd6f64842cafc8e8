// Bytes on the serial line, in both directions: to the robot's listener, and to the host's link.
#include <algorithm>
#include <vector>

#include "fuzz.hpp"
#include "rift/hardware/listener.hpp"
#include "rift/hardware/robot_link.hpp"
#include "rift/hardware/wire.hpp"

namespace rift::hardware {
namespace {

using fuzz::Require;

/// The bytes come in pieces of up to `kPiece`, each with a time.
constexpr std::size_t kPiece = 16;

template <class Take>
void InPieces(Bytes bytes, const Take& take) {
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t piece = std::min<std::size_t>(1 + bytes[at] % kPiece, bytes.size() - at);
    take(bytes.subspan(at, piece));
    at += piece;
  }
}

void CheckOneCommand(Bytes bytes) {
  if (const auto frame = DecodeCommand(bytes)) {
    Require(std::ranges::equal(Encode(*frame), bytes), "a command has one form");
  }
  if (const auto answer = DecodeAnswer(bytes)) {
    Require(std::ranges::equal(Encode(*answer), bytes), "an answer has one form");
  }
  const std::string_view line = fuzz::TextOf(bytes.data(), bytes.size());
  ParseAnswerLine(line);
  const auto power = ParsePlainLine(line);
  if (!power || power->left == 0 || power->right == 0) return;  // 0.00 and -0.00
  Require(PlainLine({1e-3 * power->left, 1e-3 * power->right}) == std::string(line) + "\n",
          "a plain line has one form");
}

/// What the listener says, the host understands.
void CheckListener(Bytes bytes) {
  Listener listener;
  AnswerDecoder host;
  std::uint32_t now_ms = 0xffff'ff00;  // it wraps around soon
  InPieces(bytes, [&](Bytes piece) {
    now_ms += piece[0];
    const std::vector<std::uint8_t> said = listener.Poll(now_ms, piece, {-7, 7, 4800});
    Require(std::abs(listener.Motors().left) <= 1000 && std::abs(listener.Motors().right) <= 1000,
            "powers are in [-1, 1]");
    Require(host.Take(said).size() == (said.empty() ? 0U : 1U), "an answer is understood");
  });
}

/// A line on which the robot says what it is told to.
class Scripted : public ByteLine {
 public:
  bool Write(Bytes bytes) override { return bytes.size() % 2 == 1; }
  std::vector<std::uint8_t> Read() override { return std::exchange(next, {}); }
  size_t Unsent() override { return 0; }
  std::vector<std::uint8_t> next;
};

void CheckLink(Bytes bytes, Protocol protocol) {
  Scripted line;
  RobotLink link(line, {}, protocol);
  double now_s = 0.0;
  InPieces(bytes, [&](Bytes piece) {
    now_s += 1e-3 * piece[0];
    line.next.assign(piece.begin(), piece.end());
    link.Put({piece[0] / 255.0, -1.0}, piece.size() > 8);
    link.Tick(now_s);
    Require(link.Lag_s(now_s) >= 0.0, "nothing is answered before it was sent");
    for (const RobotLink::Heard& heard : link.TakeHeard()) {
      Require(!heard.sent || heard.sent->sequence == heard.answer.sequence,
              "an answer belongs to its command");
    }
  });
  Require(link.answered_count() <= link.sent_count(), "no command is answered twice");
}

}  // namespace
}  // namespace rift::hardware

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rift::hardware;
  const Bytes bytes(data, size);
  CheckOneCommand(bytes);
  CheckListener(bytes);
  CheckLink(bytes, Protocol::kFramed);
  CheckLink(bytes, Protocol::kPlain);
  return 0;
}
