#include "figure_file.hpp"

#include <stdexcept>

#include "files.hpp"

namespace rift::commands {
namespace {

report::FigureFormat FormatOf(const std::filesystem::path& path) {
  if (path.extension() == ".svg") return report::FigureFormat::kSvg;
  if (path.extension() == ".png") return report::FigureFormat::kPng;
  throw std::invalid_argument("--figure " + path.string() + ": the name must end in .svg or .png");
}

}  // namespace

void RequireFigureName(const std::filesystem::path& path) { FormatOf(path); }

void WriteFigure(const std::filesystem::path& path, const report::Figure& figure) {
  WriteFile(path, report::Render(figure, FormatOf(path)));
}

}  // namespace rift::commands
