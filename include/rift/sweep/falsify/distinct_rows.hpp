#pragma once

#include <span>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// Of these rows those that statistics count, in their order: of runs that are identical to the
/// last bit (path, gap, how they ended; rows without a path are none) and had to be, the first.
/// Such are
/// - the repeats of a setting, where all of them are: nothing is left to chance there, and one run
///   tells all. Where chance acts each repeat with a seed of its own is a draw, also one that comes
///   out as another did, and with `chance_repeats_runs` (ChanceAmongRuns) it may act everywhere;
/// - repeats of a setting without seeds, or with the same one: a log that was copied;
/// - trials of one name and seed of settings that differ in one parameter, which then does nothing
///   there, and of settings with such ones between them. Where another trial of the two settings
///   parts them it does something, and all of them count: to leave out those alone that came out
///   alike would be to choose trials by their outcome. Two settings that differ in more may give
///   one path by chance, and each counts.
std::vector<int> DistinctRows(std::span<const TrialRow> rows, const std::vector<int>& indices,
                              bool chance_repeats_runs = false);

/// Those of a whole sweep, of the rows that tell.
std::vector<int> RowsThatCount(const SweepResult& result);

}  // namespace rift::sweep
