#pragma once

#include <chrono>

namespace rift::vision {

/// Seconds of the clock that frames are stamped with (steady_clock).
inline double SteadyNow_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace rift::vision
