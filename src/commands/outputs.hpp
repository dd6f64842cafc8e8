#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rift::commands {

/// One file behind two names, there or not.
bool IsSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// What can be wrong with the names of outputs, said before anything is computed or written: throws
/// std::invalid_argument for a folder and for a file that is an input or another output.
void CheckOutputs(const std::vector<std::filesystem::path>& inputs,
                  const std::vector<std::filesystem::path>& outputs);

/// A run in the folder of a sweep would replace what its rows are made again from: throws
/// std::invalid_argument.
void RefuseSweepFolder(const std::filesystem::path& folder);

}  // namespace rift::commands
