#include "rift/twin/options.hpp"

#include "rift/hardware/listener.hpp"

namespace rift::twin {
namespace {

constexpr int kReceiveBuffer = 512;  // RECEIVE_BUFFER of src/firmware/main.py

}  // namespace

simulation::SimulationOptions AsTwin(simulation::SimulationOptions simulation,
                                     const TwinOptions& options) {
  simulation.link.poll_s = 0.0;
  simulation.link.uart_bytes = kReceiveBuffer;
  simulation.link.watchdog_s = 1e-3 * hardware::Listener::kWatchdog_ms;
  simulation.mocap.rate_hz = options.fps;
  simulation.mocap.frame_jitter_s = 0.0;
  simulation.encoder.reported = true;
  return simulation;
}

}  // namespace rift::twin
