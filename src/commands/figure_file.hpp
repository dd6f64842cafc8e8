#pragma once

#include <filesystem>

#include "rift/report/figures/figure.hpp"

namespace rift::commands {

/// Throws std::invalid_argument unless the name ends in .svg or .png.
void RequireFigureName(const std::filesystem::path& path);

/// Writes an SVG or PNG, as the name of the file ends. Throws std::invalid_argument for another
/// ending.
void WriteFigure(const std::filesystem::path& path, const report::Figure& figure);

}  // namespace rift::commands
