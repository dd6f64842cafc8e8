#pragma once

#include <filesystem>
#include <string>

#include "rift/files/descriptor.hpp"

namespace rift::files {

/// Keeps other sweeps and series of drives out of a folder, until the end of its scope or of the
/// process, however it ends. The folder is made when it is not there.
class FolderLock {
 public:
  /// Throws std::runtime_error when the folder cannot be made or another sweep is at work in it.
  explicit FolderLock(const std::filesystem::path& folder);
  /// The same, with `at_work` as the words for a folder in which somebody is at work.
  FolderLock(const std::filesystem::path& folder, const std::string& at_work);

  /// Throws std::runtime_error when the folder is no longer where it was: removed, moved, replaced.
  void RequireInPlace() const;
  /// True while some process holds the lock of a folder.
  static bool IsHeld(const std::filesystem::path& folder);

 private:
  std::filesystem::path folder_;
  Descriptor lock_;
};

}  // namespace rift::files
