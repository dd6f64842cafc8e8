#pragma once

#include <string>

namespace rift {

/// A short task, so that a trial takes milliseconds.
inline const std::string kTask =
    R"(waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]
gap: {threshold_m: 0.01}
reference: {kind: nominal, trials: 2}
)";
inline const std::string kGrid = kTask + R"(space:
  surface: [ground, parchment]
  v_min: [0.14, 0.16, 0.18]
)";

}  // namespace rift
