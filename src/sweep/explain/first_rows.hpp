#pragma once

#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

struct FirstRows {
  std::vector<int> rows;
  int most_of_setting = 0;  ///< of each setting so many; 0: all of them
};

/// Of these rows the first ones of each setting, as many as the median one has, of an even number
/// of settings the lesser of the middle two. A search repeats a setting that it cannot decide, and
/// a hundred trials of one would outweigh those beside it. In a grid, whose settings are all tried
/// alike, twice as many, so that missing trials cost none.
FirstRows FirstOfEachSetting(const SweepResult& result, const std::vector<int>& rows);

}  // namespace rift::sweep
