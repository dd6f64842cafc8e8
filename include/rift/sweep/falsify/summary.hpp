#pragma once

#include <span>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// Fills in everything of a result that follows from its parameters and rows: the settings with
/// their verdicts, the effects of the parameters and the summary of all rows. Settings stand in
/// the order of their first rows; their noise floor is left alone.
void Summarise(SweepResult& result);

/// A parameter with a p below this has a detected effect.
inline constexpr double kSignificance = 0.05;

}  // namespace rift::sweep
