#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "rift/report/figures/options.hpp"

namespace rift::report {

/// A drawing as a value: gnuplot commands with their data, without terminal and output.
struct Figure {
  std::string name;   ///< of its files, without extension: "fig10_gap_heat_map"
  std::string title;  ///< one sentence, for captions; not drawn
  int width_px = 480;
  int height_px = 320;
  std::string plot{};
};

/// A figure that makes no sense for the data at hand.
struct OmittedFigure {
  std::string name;
  std::string reason;
};

enum class FigureFormat { kSvg, kPng };

constexpr std::array<std::string_view, 2> EnumNames(FigureFormat) { return {"svg", "png"}; }

/// The whole script: terminal, style, plot. Names in it are plain text, never markup.
std::string GnuplotScript(const Figure& figure, FigureFormat format, const ReportOptions& options);

/// The bytes of the image file; the same figure gives the same bytes.
/// Throws std::runtime_error when gnuplot is not installed, or with what gnuplot complained about.
std::string Render(const Figure& figure, FigureFormat format, const ReportOptions& options = {});

/// Several figures of one width below each other, for one file.
Figure Stack(std::string name, std::string title, const std::vector<Figure>& figures);

/// Throws std::invalid_argument unless the name ends in .svg or .png.
void RequireFigureName(const std::filesystem::path& path);

/// Writes an SVG or PNG, as the name of the file ends. Throws std::invalid_argument for another
/// ending.
void WriteFigure(const std::filesystem::path& path, const Figure& figure);
/// FOLDER/NAME.svg and FOLDER/NAME.png.
void WriteFigureFiles(const std::filesystem::path& folder, const Figure& figure);

}  // namespace rift::report
