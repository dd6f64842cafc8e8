#pragma once

#include <filesystem>

#include "rift/sweep/explain/sweep_change.hpp"

namespace rift::sessions {

/// What changed between two finished sweeps over the same space, from their folders. Throws
/// std::invalid_argument when a folder holds no sweep, and when they hold sweeps of different
/// experiments: the task, the space, the gap and what counts as a failure must be the same.
sweep::SweepChange CompareFolders(const std::filesystem::path& before,
                                  const std::filesystem::path& after);

}  // namespace rift::sessions
