#pragma once

#include <string_view>

namespace rift::limits {

/// What of an input is counted before it is taken.
enum class Amount {
  kFileBytes,   ///< of one file that is read whole
  kYamlBytes,   ///< of one YAML file
  kPixels,      ///< of the picture of a heightfield
  kRows,        ///< of one log, or another table of text
  kColumns,     ///< of one row of it
  kSamples,     ///< gap.samples
  kWaypoints,   ///< of one task
  kGridTrials,  ///< of a grid: its settings times their repeats
};

/// The most that is taken, unless Lift was called.
double Most(Amount amount);

/// Throws std::invalid_argument for a count above it, which says how to lift the limit. `where`
/// starts the message: a file or a key.
void Require(Amount amount, double count, std::string_view where);

/// From now on this process, and those that it forks, takes everything.
void Lift();

}  // namespace rift::limits
