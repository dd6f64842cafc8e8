#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/report/figures/figure.hpp"

namespace rift::commands {

/// `out`, or out/NAME where none was asked for. Throws std::invalid_argument when the name of an
/// experiment would lead elsewhere.
std::filesystem::path OutputOf(const std::string& out, const std::string& name);

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

/// Throws std::invalid_argument when `file` is there and `force` is not given.
void RefuseOverwriting(const std::filesystem::path& file, bool force);

/// `--force`, for every command that writes files.
void AddForceFlag(CLI::App& app, bool& force);

/// A run in the folder of a sweep would replace what its rows are made again from: throws
/// std::invalid_argument.
void RefuseSweepFolder(const std::filesystem::path& folder);

/// A sweep in the folder of a run would leave two experiments in one: throws std::invalid_argument.
void RefuseRunFolder(const std::filesystem::path& folder);

/// Throws std::invalid_argument, with `what` is written, for "-", which is stdout, and for a file.
void RequireFolderName(const std::string& out, std::string_view what);

/// Throws std::invalid_argument unless the name ends in .svg or .png.
void RequireFigureName(const std::filesystem::path& path);

/// Writes an SVG or PNG, as the name of the file ends. Throws std::invalid_argument for another
/// ending.
void WriteFigure(const std::filesystem::path& path, const report::Figure& figure);

}  // namespace rift::commands
