#pragma once

#include <vector>

#include "rift/search/strategy.hpp"
#include "rift/sweep/result.hpp"
#include "rift/sweep/trial_runner.hpp"

namespace rift::sweep {

/// Axes for a search: a range as it is, or its natural logarithm where it is logarithmic; a list of
/// numbers as the ranks of its values; a list with a text in it as categories.
std::vector<search::Axis> AxesOf(const std::vector<Parameter>& parameters);

/// The values of the parameters at a point of those axes.
Theta ThetaAt(const std::vector<Parameter>& parameters, const search::Point& point);

}  // namespace rift::sweep
