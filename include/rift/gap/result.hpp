#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/gap/likeness.hpp"
#include "rift/gap/verdict.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

/// One simulated path held against repeats of the real one: what `rift gap` found.
struct GapResult {
  struct Trial {
    std::string path;  ///< of its log
    Comparison comparison;
  };

  GapOptions options;
  double tag_offset_m = 0.0;  ///< already in `reals`; for the record
  std::string sim_path;       ///< of its log
  trajectory::Trajectory sim;
  std::vector<Trial> trials;
  std::vector<trajectory::Trajectory> reals;  ///< one for each trial
  double mean_gap_m = kNotComputed;
  double noise_floor_m = kNotComputed;  ///< NaN for one real log
  RepeatVerdict verdict;
  std::optional<Likeness> likeness;  ///< only with repeats of the simulator
};

/// Fills in the mean, the noise floor and the verdict from the trials.
void Judge(GapResult& result);

}  // namespace rift::gap
