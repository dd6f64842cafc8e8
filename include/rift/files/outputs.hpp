#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace rift::files {

/// The files that a command will write.
struct Outputs {
  std::vector<std::filesystem::path> files;
  std::filesystem::path folder;  ///< that the command makes when it is not there; may be empty
  bool force = false;            ///< replace what is there
};

/// The one rule about outputs, said before anything is computed or written. Throws
/// std::invalid_argument for a folder in place of a file, for a file that is an input or another
/// output, for one whose folder is not there and is not made by the command either (a mistyped
/// path), for one that is there already unless `force`, and for "-".
void CheckOutputs(const std::vector<std::filesystem::path>& inputs, const Outputs& outputs);

/// Throws std::invalid_argument, with `what` is written, for "-", which is stdout, and for a file.
void RequireFolderName(const std::string& out, std::string_view what);

}  // namespace rift::files
