#pragma once

#include <chrono>
#include <functional>

#include "rift/hardware/arming.hpp"

namespace rift::sessions {

/// A drive and whoever looks at it.
struct ViewedDrive {
  std::function<hardware::DriveRun()> drive;  ///< in a thread of its own
  std::function<void()> look;                 ///< here, again and again until the drive is over
  std::function<void()> stop;                 ///< asks the drive to end soon; from any thread
  std::chrono::milliseconds redraw;
  /// For which an exit() waits for the drive: what it takes to stop a robot and hear of it.
  std::chrono::milliseconds patience{1500};
};

/// What the drive gives, or throws. It is not left to itself: when `look` throws, and when anything
/// ends this process with exit() meanwhile (Qt, when its display goes away), it is told to stop and
/// waited for.
hardware::DriveRun DriveInView(const ViewedDrive& viewed);

}  // namespace rift::sessions
