#include <chrono>
#include <thread>

#include "rift/hardware/byte_line.hpp"
#include "rift/vision/camera/camera_source.hpp"

namespace rift::hardware {

double SteadyClock::Now_s() { return vision::SteadyNow_s(); }

void SteadyClock::Wait(double dt_s) {
  std::this_thread::sleep_for(std::chrono::duration<double>(dt_s));
}

}  // namespace rift::hardware
