#include "rift/report/json/stop_text.hpp"

namespace rift::report {

std::string StopText(std::optional<bool> acknowledged) {
  if (!acknowledged) return "the robot cannot say whether it stands: look at it";
  return *acknowledged
             ? "the robot acknowledged the stop"
             : "THE ROBOT DID NOT ACKNOWLEDGE THE STOP, OR ITS WHEELS TURN ON: switch it off";
}

}  // namespace rift::report
