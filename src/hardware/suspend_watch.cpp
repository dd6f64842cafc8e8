#include "suspend_watch.hpp"

#include <fmt/format.h>

#include <ctime>
#include <utility>

namespace rift::hardware {
namespace {

double Read_s(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double Suspended_s() {
  constexpr double kApart_s = 0.01;  // farther, something came between the two clocks
  while (true) {
    const double before_s = Read_s(CLOCK_MONOTONIC);
    const double all_s = Read_s(CLOCK_BOOTTIME);
    if (Read_s(CLOCK_MONOTONIC) - before_s < kApart_s) return all_s - before_s;
  }
}

Stopper SuspendStopper(double most_s, std::function<double()> suspended_s) {
  double before_s = suspended_s();
  return [most_s, before_s, suspended_s = std::move(suspended_s)]() mutable
         -> std::optional<std::pair<StopReason, std::string>> {
    const double now_s = suspended_s();
    const double by_s = now_s - std::exchange(before_s, now_s);
    if (by_s <= most_s) return std::nullopt;
    return std::pair(StopReason::kHostStalled,
                     fmt::format("the machine was suspended for {:.1f} s", by_s));
  };
}

}  // namespace rift::hardware
