#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "identification/grid_study.hpp"
#include "rift/sweep/calibrate/calibration.hpp"

namespace rift::test {

/// What a calibration is to find again in logs of the simulated robot.
struct Planted {
  std::string key;
  double min = 0.0, max = 1.0;
  double start = 0.5;
  double truth = 0.5;
  bool is_irrelevant = false;  ///< nothing in the logs depends on it
};

/// A delay, a mismatch and the caster's friction, drawn anew for each repeat, and the friction of a
/// surface that the robot never sees.
std::vector<Planted> PlantAt(std::uint64_t repeat);

/// The planted robot drives the paper's waypoints on parchment, put down by hand, with all its
/// noise; then the logs alone are calibrated to.
sweep::Calibration FindPlanted(const GridStudy& robot, const std::vector<Planted>& planted,
                               std::uint64_t repeat, int logs,
                               const sweep::CalibrationOptions& options, int threads);

}  // namespace rift::test
