#pragma once

#include <string>
#include <vector>

#include "identification/grid_study.hpp"
#include "rift/sweep/calibrate/likeness.hpp"

namespace rift::test {

/// One of the authors' trials of any surface, the bumps included.
struct GridTrial {
  std::string surface;
  std::string setting;  ///< surface and speed limits
  int trial = 0;
  control::NavigatorOptions control;
  trajectory::Trajectory real;
  trajectory::Trajectory webots;  ///< empty for the bumps
};

/// The 48 trials of the paper's grid and the 11 on the bumps, as far as `trial` says (0: all).
std::vector<GridTrial> LoadTrialGrid(const GridStudy& study, int trial);

/// The simulated twin of a trial, where the real robot stood.
sweep::SimulatedTrial TwinOf(const GridStudy& study, const GridTrial& trial, std::uint64_t seed);

/// Every trial driven `runs` times.
std::vector<sweep::RepeatedTrial> DriveGrid(const GridStudy& study,
                                            const std::vector<GridTrial>& trials, int runs);
/// The authors' Webots run in the simulator's place, the tag moved to where Webots logs.
std::vector<sweep::RepeatedTrial> WebotsGrid(const std::vector<GridTrial>& trials);

}  // namespace rift::test
