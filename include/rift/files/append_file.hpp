#pragma once

#include <filesystem>
#include <string_view>

#include "rift/files/descriptor.hpp"

namespace rift::files {

/// A new file that grows. What was appended outlives the process; what was synced, the machine too.
class AppendFile {
 public:
  /// Makes the file. Throws std::runtime_error with the path and the system's reason, also where
  /// there is one of that name.
  explicit AppendFile(std::filesystem::path path);

  /// Each throws std::runtime_error with the path and the system's reason. A text that finds no
  /// room stands in the file up to its last whole line.
  void Append(std::string_view text);
  void Sync();
  /// Throws when the file is no longer where it was made: removed, moved, or its folder was.
  void RequireInPlace() const;

 private:
  std::filesystem::path path_;
  Descriptor file_;
};

}  // namespace rift::files
