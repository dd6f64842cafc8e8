#include "rift/hardware/ping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "rift/hardware/robot_link.hpp"
#include "rift/hardware/wire.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::hardware {
namespace {

constexpr double kTick_s = 0.0005;
constexpr double kLastAnswer_s = 0.5;  // how long the last commands may take to be answered

void FillTimes(PingResult& result, const std::vector<double>& round_trips_s) {
  if (round_trips_s.empty()) return;
  double changes_s = 0.0;
  for (size_t i = 1; i < round_trips_s.size(); ++i) {
    changes_s += std::abs(round_trips_s[i] - round_trips_s[i - 1]);
  }
  result.jitter_s = changes_s / std::max(1.0, static_cast<double>(round_trips_s.size() - 1));
  result.p50_s = statistics::Quantile(round_trips_s, 0.50);
  result.p95_s = statistics::Quantile(round_trips_s, 0.95);
  result.p99_s = statistics::Quantile(round_trips_s, 0.99);
  result.max_s = *std::max_element(round_trips_s.begin(), round_trips_s.end());
}

size_t LongestBurst(const std::vector<bool>& is_answered) {
  size_t longest = 0, current = 0;
  for (const bool answered : is_answered) {
    current = answered ? 0 : current + 1;
    longest = std::max(longest, current);
  }
  return longest;
}

}  // namespace

PingResult Ping(ByteLine& line, Clock& clock, const LineOptions& line_options, Protocol protocol,
                const PingOptions& options) {
  PingResult result{.protocol = protocol};
  if (protocol != Protocol::kFramed) return result;
  RobotLink link(line, line_options, protocol);
  std::map<double, size_t> index_of;  // by the time of sending
  std::vector<bool> is_answered;
  std::vector<double> round_trips_s;
  const double start_s = clock.Now_s();
  const double silent_s = start_s + options.duration_s;
  double now_s = start_s;
  while (now_s < silent_s + kLastAnswer_s) {
    if (now_s < silent_s) {
      link.Put({}, true);
      link.Tick(now_s);
    } else {
      link.Listen(now_s);
    }
    if (link.sent_count() > is_answered.size()) {
      index_of[link.last_sent()->at_s] = is_answered.size();
      is_answered.push_back(false);
    }
    for (const RobotLink::Heard& heard : link.TakeHeard()) {
      if (!heard.sent) continue;
      is_answered[index_of.at(heard.sent->at_s)] = true;
      round_trips_s.push_back(heard.at_s - heard.sent->at_s);
      result.battery_v = 1e-3 * heard.answer.battery_mv;
    }
    if (now_s >= silent_s && !is_answered.empty() && is_answered.back()) break;
    clock.Wait(kTick_s);
    now_s = clock.Now_s();
  }
  result.sent = is_answered.size();
  result.answered = round_trips_s.size();
  if (result.sent > 0) {
    result.loss = 1.0 - static_cast<double>(result.answered) / static_cast<double>(result.sent);
  }
  result.longest_burst = LongestBurst(is_answered);
  FillTimes(result, round_trips_s);
  return result;
}

double RadioDelay_s(const PingResult& result, const LineOptions& options) {
  if (!result.IsMeasured()) return -1.0;
  constexpr double kBytes = CommandFrame::kSize + Answer::kSize;
  return std::max(0.0, result.OneWay_s() - 0.5 * kBytes * ByteTime_s(options.baud));
}

std::vector<std::string> BrokenBudget(const PingResult& result, const PingOptions& options) {
  std::vector<std::string> broken;
  if (result.protocol != Protocol::kFramed) return broken;  // nothing was measured
  if (!result.IsMeasured()) {
    return {
        fmt::format("none of {} commands was answered: is the robot on, paired, and running "
                    "rift's listener at this baud rate?",
                    result.sent)};
  }
  if (result.p99_s > options.max_p99_s) {
    broken.push_back(fmt::format(
        "99 % of the round trips take up to {:.3f} s, and the budget is {:.3f} s: bring the robot "
        "nearer, ask for a shorter BLE connection interval, or raise the baud rate",
        result.p99_s, options.max_p99_s));
  }
  if (result.loss > options.max_loss) {
    broken.push_back(
        fmt::format("{:.1f} % of the commands are lost, and the budget is {:.1f} %: lower "
                    "hardware.line.line_share, or keep other radios away",
                    100.0 * result.loss, 100.0 * options.max_loss));
  }
  if (result.longest_burst > static_cast<size_t>(options.max_burst)) {
    broken.push_back(
        fmt::format("{} commands in a row were lost, and the budget is {}: the robot would stop by "
                    "itself; look for what interrupts the radio",
                    result.longest_burst, options.max_burst));
  }
  return broken;
}

}  // namespace rift::hardware
