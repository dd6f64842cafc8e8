#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/report/figures/figure.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"

namespace rift::commands {

/// The whole file. Throws std::invalid_argument with the path and the system's reason.
std::string ReadFile(const std::filesystem::path& path);

/// The whole file; nothing when there is no such file. Throws as ReadFile does.
std::optional<std::string> ReadIfThere(const std::filesystem::path& path);

/// Files for computation, whose notes go to stderr.
sweep::Inputs FileInputs();

/// Writes beside the target and renames, so that the target is whole or absent; a pipe or a device
/// is written to as it is, and a link leads to its file. Missing parent folders are made. Throws
/// std::runtime_error with the path and the system's reason.
void WriteFile(const std::filesystem::path& target, std::string_view text);

/// `out`, or out/NAME where none was asked for. Throws std::invalid_argument when the name of an
/// experiment would lead elsewhere.
std::filesystem::path OutputOf(const std::string& out, const std::string& name);

/// Keeps other sweeps out of a folder, until the end of its scope or of the process, however it
/// ends. The folder is made when it is not there.
class FolderLock {
 public:
  /// Throws std::runtime_error when the folder cannot be made or another sweep is at work in it.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// True while some process holds the lock of a folder.
  static bool IsHeld(const std::filesystem::path& folder);

 private:
  int descriptor_ = -1;
};

/// One file behind two names, there or not.
bool IsSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// What can be wrong with the names of outputs, said before anything is computed or written: throws
/// std::invalid_argument for a folder and for a file that is an input or another output.
void CheckOutputs(const std::vector<std::filesystem::path>& inputs,
                  const std::vector<std::filesystem::path>& outputs);

/// A run in the folder of a sweep would replace what its rows are made again from: throws
/// std::invalid_argument.
void RefuseSweepFolder(const std::filesystem::path& folder);

/// Throws std::invalid_argument unless the name ends in .svg or .png.
void RequireFigureName(const std::filesystem::path& path);

/// Writes an SVG or PNG, as the name of the file ends. Throws std::invalid_argument for another
/// ending.
void WriteFigure(const std::filesystem::path& path, const report::Figure& figure);

}  // namespace rift::commands
