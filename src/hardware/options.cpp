#include "rift/hardware/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace rift::hardware {

void HardwareOptions::Check() const {
  if (!(line.heartbeat_s < guard.link_lag_s)) {
    throw std::invalid_argument(
        fmt::format("line.heartbeat_s is {}, and it must be below guard.link_lag_s, which is {}",
                    line.heartbeat_s, guard.link_lag_s));
  }
}

double StoppingDistance_m(const StoppingOptions& options, double power, double blind_s) {
  const double speed_mps = options.full_power_speed_mps * power;
  return speed_mps * (std::max(options.robot_watchdog_s, blind_s) + options.delay_s) +
         speed_mps * speed_mps / (2.0 * options.braking_mps2);
}

}  // namespace rift::hardware
