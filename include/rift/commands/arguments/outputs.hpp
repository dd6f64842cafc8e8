#pragma once

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
/// FOLDER/NAME.svg and FOLDER/NAME.png.
void WriteFigureFiles(const std::filesystem::path& folder, const report::Figure& figure);

}  // namespace rift::commands
