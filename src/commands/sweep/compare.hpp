#pragma once

#include <string>
#include <vector>

namespace rift::commands {

/// Compares the folders of two finished sweeps over the same space: prints a table, or JSON, and
/// writes a page where one is asked for. Throws std::invalid_argument when a folder holds no
/// sweep, and when they hold sweeps of different experiments: the task, the space, the gap and what
/// counts as a failure must be the same.
void CompareSweepFolders(const std::vector<std::string>& folders, const std::string& page,
                         bool json, bool force);

}  // namespace rift::commands
