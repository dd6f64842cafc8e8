#pragma once

#include <functional>

#include "rift/hardware/real_robot.hpp"

namespace rift::hardware {

/// Seconds for which this machine has been suspended since it was started. Clock stands still
/// meanwhile, so that on waking an old pose looks like one of now.
double Suspended_s();

/// Stops a drive as host_stalled when the machine was suspended for longer than `most_s` since it
/// was last asked.
Stopper SuspendStopper(double most_s, std::function<double()> suspended_s = Suspended_s);

}  // namespace rift::hardware
