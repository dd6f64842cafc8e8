#pragma once

#include "rift/hardware/arming.hpp"

namespace rift::commands {

/// What `rift drive` ends with after a drive: 0 when the last waypoint was reached, else 1. A dry
/// run has nowhere to arrive: 0 when it began and only its time or a person ended it. 1 for every
/// drive whose stop a robot that can say so did not acknowledge.
int ExitCodeOf(const hardware::DriveRun& run);

}  // namespace rift::commands
