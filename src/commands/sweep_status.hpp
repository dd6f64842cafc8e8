#pragma once

#include <filesystem>
#include <string>

namespace rift::commands {

/// How far the sweep in a folder is: while it runs, when it was stopped or killed, or when it is
/// done. Throws std::invalid_argument when there is no journal of a sweep.
std::string SweepStatus(const std::filesystem::path& folder, bool json);

}  // namespace rift::commands
