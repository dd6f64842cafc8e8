#pragma once

#include <vector>

#include "rift/search/strategy.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"

namespace rift::sweep {

/// Axes for a search: a range as it is, or its natural logarithm where it is logarithmic; a list of
/// numbers as the ranks of its values; a list with a text in it as categories.
std::vector<search::Axis> AxesOf(const std::vector<experiment::Parameter>& parameters);

/// The values of the parameters at a point of those axes.
experiment::Theta ThetaAt(const std::vector<experiment::Parameter>& parameters,
                          const search::Point& point);

}  // namespace rift::sweep
