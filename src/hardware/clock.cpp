#include <chrono>
#include <thread>

#include "rift/hardware/byte_line.hpp"

namespace rift::hardware {

double SteadyClock::Now_s() {
  const auto since_start = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since_start).count();
}

void SteadyClock::Wait(double dt_s) {
  std::this_thread::sleep_for(std::chrono::duration<double>(dt_s));
}

}  // namespace rift::hardware
