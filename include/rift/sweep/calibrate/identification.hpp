#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rift/sweep/calibrate/calibration.hpp"
#include "rift/sweep/calibrate/error_structure.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

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
  Calibration calibration;                  ///< from the experiment's own values
  std::vector<StartAgreement> agreement{};  ///< one for each parameter; none for a single start
  std::vector<double> values;               ///< of calibrate.fit, in its order
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

/// Told what goes on, a line at a time.
using Say = std::function<void(const std::string& line)>;

/// What `goal: calibrate` does: fits the free parameters to the logs that are not held out, then
/// judges the simulator before and after by whole paths and by the structure of its errors. `jobs`
/// logs are evaluated at once and change no result. Throws std::invalid_argument for less than two
/// logs to fit.
CalibrationReport Identify(Evaluator& evaluator, int jobs, const Say& say);

}  // namespace rift::sweep
