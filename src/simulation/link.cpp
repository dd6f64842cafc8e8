#include "rift/simulation/link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace rift::simulation {
namespace {

constexpr double kNever_s = std::numeric_limits<double>::infinity();
constexpr double kBitsPerByte = 10.0;  // 8N1: start, eight bits, stop
constexpr std::uint64_t kLineLossDraw = 1'000'000;

enum Stream : std::uint64_t { kPhaseStream = 10, kLossStream = 11, kConnectionStream = 12 };

double ConnectedAt_s(const LinkOptions& options, std::uint64_t seed) {
  const statistics::CounterRandom drawn(seed, kConnectionStream);
  if (drawn.Uniform(0, 0) >= options.late_share) return 0.0;
  return -options.late_s * std::log(drawn.Uniform(0, 1));
}

std::string LineOf(const control::WheelPower& power, bool two_decimals) {
  return two_decimals ? fmt::format("{:.2f} {:.2f}\n", power.left, power.right)
                      : fmt::format("{} {}\n", power.left, power.right);
}

/// The number at the start of `text` after blanks, which it takes off; none when there is none.
std::optional<double> TakeNumber(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return number;
}

}  // namespace

void LinkOptions::Check() const {
  constexpr double kShortestPoll_s = 1e-4;  // a listener cannot be faster, and each poll costs time
  if (poll_s > 0.0 && poll_s < kShortestPoll_s) {
    throw std::invalid_argument(
        fmt::format("poll_s is {}, but it must be 0 or at least {}", poll_s, kShortestPoll_s));
  }
}

Link::Link(const LinkOptions& options, std::uint64_t seed)
    : options_(options),
      noise_(seed, kLossStream),
      phase_s_(options.poll_s * options.poll_phase.value_or(
                                    statistics::CounterRandom(seed, kPhaseStream).Uniform(0, 0))) {
  next_poll_s_ = phase_s_;
  connected_s_ = ConnectedAt_s(options_, seed);
}

void Link::Send(double at_s, const control::WheelPower& power) {
  Enqueue(at_s, LineOf(power, options_.two_decimals));
}

void Link::SendUrgently(double at_s, const control::WheelPower& power) {
  in_flight_.clear();
  line_free_s_ = 0.0;
  // A newline first ends whatever half line the robot has already received.
  Enqueue(at_s, fmt::format("\n{}", LineOf(power, options_.two_decimals)));
}

void Link::Enqueue(double at_s, const std::string& line) {
  const std::uint64_t number = lines_sent_++;
  const double byte_s = options_.baud > 0.0 ? kBitsPerByte / options_.baud : 0.0;
  double free_s = std::max(at_s + options_.delay_s, line_free_s_);
  const bool lost =
      at_s < connected_s_ || noise_.Uniform(number, kLineLossDraw) < options_.line_loss;
  for (size_t i = 0; i < line.size() && !lost; ++i) {
    free_s += byte_s;
    if (noise_.Uniform(number, i) < options_.byte_loss) continue;
    in_flight_.push_back({free_s, line[i]});
  }
  line_free_s_ = free_s;
}

control::WheelPower Link::Advance(double to_s) {
  const double from_s = now_s_;
  integral_ = {};
  double next_s = NextListening_s();
  while (next_s <= to_s) {
    Hold(next_s);
    Listen(next_s);
    next_s = NextListening_s();
  }
  Hold(to_s);
  const double duration_s = to_s - from_s;
  if (duration_s <= 0.0) return held_;
  return {integral_.left / duration_s, integral_.right / duration_s};
}

double Link::NextListening_s() const {
  if (options_.poll_s > 0.0) return next_poll_s_;
  return in_flight_.empty() ? kNever_s : std::max(now_s_, in_flight_.front().arrives_s);
}

void Link::Listen(double now_s) {
  if (options_.poll_s > 0.0) {
    next_poll_s_ = phase_s_ + static_cast<double>(++polls_) * options_.poll_s;
  }
  const int room = options_.uart_bytes > 0 && options_.poll_s > 0.0
                       ? options_.uart_bytes
                       : std::numeric_limits<int>::max();
  std::string newest_line;
  for (int kept = 0; !in_flight_.empty() && in_flight_.front().arrives_s <= now_s; ++kept) {
    const char value = in_flight_.front().value;
    in_flight_.pop_front();
    if (kept >= room) continue;  // overrun: the buffer keeps the oldest bytes
    if (value != '\n') {
      partial_line_ += value;
      continue;
    }
    newest_line = std::exchange(partial_line_, {});
  }
  if (!newest_line.empty()) Understand(newest_line, now_s);
}

void Link::Understand(const std::string& line, double now_s) {
  std::string_view rest = line;
  const std::optional<double> left = TakeNumber(rest), right = TakeNumber(rest);
  if (!left || !right) return;
  held_ = {std::clamp(*left, -1.0, 1.0), std::clamp(*right, -1.0, 1.0)};
  understood_s_ = now_s;
}

double Link::SilentAfter_s() const {
  return options_.watchdog_s > 0.0 ? understood_s_ + options_.watchdog_s : kNever_s;
}

void Link::Hold(double until_s) {
  const double heard_s = std::clamp(SilentAfter_s(), now_s_, until_s) - now_s_;
  integral_.left += held_.left * heard_s;
  integral_.right += held_.right * heard_s;
  if (until_s >= SilentAfter_s()) held_ = {};
  now_s_ = until_s;
}

}  // namespace rift::simulation
