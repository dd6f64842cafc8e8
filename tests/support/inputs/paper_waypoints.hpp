#pragma once

#include <vector>

#include "rift/control/waypoint.hpp"

namespace rift::test {

/// The task of the paper (authors' recorded_waypoints.yaml).
inline std::vector<control::Waypoint> PaperWaypoints() {
  return {{"start", -0.2822, -0.0655, -0.9, false},
          {"wp1", -0.0716, -0.0852, {}, true},
          {"wp2", 0.1076, -0.0866, {}, true},
          {"end", 0.3832, -0.0597, {}, true}};
}

}  // namespace rift::test
