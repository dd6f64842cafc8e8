#pragma once

#include <string>
#include <vector>

#include "rift/sweep/calibrate/calibration.hpp"
#include "rift/sweep/calibrate/drive_likeness.hpp"
#include "rift/sweep/calibrate/error_structure.hpp"

namespace rift::sweep {

/// One simulator held against one group of trials.
struct JudgedGroup {
  std::string level;  ///< of the main parameter of the space, or "all"
  std::string side;   ///< "fitted", "held out", or "both"
  DriveLikeness before, after;
};

struct CalibrationTrial {
  std::string level;
  std::string trial;
  std::string source;  ///< file of the log
  bool is_held_out = false;
  double gap_before_m = 0.0;  ///< mean simulated path to the real one; NaN: no run reached the end
  double gap_after_m = 0.0;
};

/// Everything that `goal: calibrate` found.
struct CalibrationReport {
  Calibration calibration;
  std::vector<double> values;  ///< of calibrate.fit, in its order
  std::vector<CalibrationTrial> trials;
  std::vector<std::string> missing;  ///< why a log of the plan takes no part
  std::vector<JudgedGroup> judged;
  struct Errors {
    std::string side;
    ErrorStructure before, after;
  };
  std::vector<Errors> errors;  ///< fitted, then held out
  /// Of the held-out trial (else fitted) whose gap after the fit is the median one: what is drawn.
  size_t shown = 0;
  trajectory::Trajectory shown_real;
  std::vector<trajectory::Trajectory> shown_before, shown_after;  ///< a few runs of it
};

}  // namespace rift::sweep
