#pragma once

#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// A mean with its 95 % interval (Student).
struct Estimate {
  double mean = gap::kNotComputed;
  double low = gap::kNotComputed;
  double high = gap::kNotComputed;
  int n = 0;
};

/// A share of the gap, and who could remove it.
struct GapPart {
  std::string name;
  Estimate size_m;
  std::string remedy;  ///< "a better simulator", "nobody", ...
};

/// What the gaps of a whole table are made of. start + frame + shape = gap.
struct Anatomy {
  bool is_over_settings = false;  ///< from three settings with a gap on; else over the trials
  Estimate gap_m;
  Estimate start_m;      ///< goes when the first points are laid together
  Estimate frame_m;      ///< goes beyond that with the best rigid motion: heading, camera frame
  Estimate shape_m;      ///< what no motion removes
  Estimate pace_m;       ///< equal arc length against the best pairing of points: gap - Frechet
  Estimate timing_m;     ///< what comparing at equal times would add: no part of the gap
  Estimate goal_m;       ///< goes when runs that stopped short of the goal go on: gap - way gap
  int only_at_goal = 0;  ///< trials above the threshold by that alone, which are no failures
  Estimate noise_m;      ///< the references of one setting among each other
  /// Gap less noise floor, setting by setting: the most that a perfect simulator could take away.
  Estimate removable_m;
  std::vector<GapPart> parts;
};

Anatomy Dissect(const SweepResult& result);

/// True when the interval does not hold zero.
inline bool IsClear(const Estimate& estimate) { return estimate.low > 0.0 || estimate.high < 0.0; }

}  // namespace rift::sweep
