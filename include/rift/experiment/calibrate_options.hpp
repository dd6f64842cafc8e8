#pragma once

#include <string>
#include <vector>

#include "rift/sweep/calibrate/options.hpp"

namespace rift::experiment {

/// A parameter that may change, in its own unit.
struct FreeParameter {
  std::string key;
  double min = 0.0;
  double max = 1.0;
  double start = 0.5;
  std::string origin{};  ///< where it was written, for messages
};

/// `fit: {motor.mismatch: {min: -0.1, max: 0.1}, surfaces.{surface}.mu: {min: 0.1, max: 1}}`: keys
/// of the experiment, whose values are where the fit starts; {surface} stands for each level of
/// that parameter of the space.
struct FreeParameters {
  std::vector<FreeParameter> list;
};

/// Trials by name, as in reference.trials; there may be none.
struct HeldOutTrials {
  std::vector<std::string> names;
};

/// What `goal: calibrate` fits, and to which logs.
struct CalibrateOptions {
  FreeParameters fit;
  HeldOutTrials holdout;
  int judge_runs = 20;
  sweep::CalibrationOptions method;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("fit", self.fit,
          "parameters of the simulator to fit and their ranges; {surface} in a key makes one for "
          "each surface of the space");
    field("holdout", self.holdout,
          "trials of reference.trials that the fit never sees and that judge it");
    field("judge_runs", self.judge_runs, 2, 1000,
          "simulated runs of each trial, before and after the fit, that whole paths are judged by");
    field("method", self.method, "how it is fitted");
  }
};

}  // namespace rift::experiment
