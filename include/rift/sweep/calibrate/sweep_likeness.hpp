#pragma once

#include <string>
#include <vector>

#include "rift/sweep/calibrate/drive_likeness.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::sweep {

/// Likeness of the trials that share a value of the main factor.
struct GroupLikeness {
  std::string level;  ///< "all" for every trial
  DriveLikeness likeness;
};

/// Likeness of a grid sweep's candidates to its repeated reference logs, by the values of its main
/// factor and over all ("all", last). Empty where the sweep has no repeated logs to be like.
std::vector<GroupLikeness> MeasureSweepLikeness(Evaluator& evaluator);

}  // namespace rift::sweep
