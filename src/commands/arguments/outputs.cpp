#include "rift/commands/arguments/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "rift/files/files.hpp"

namespace rift::commands {

namespace fs = std::filesystem;

std::filesystem::path OutputOf(const std::string& out, const std::string& name) {
  if (!out.empty()) return out;
  const bool is_plain =
      !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
  if (!is_plain) {
    throw std::invalid_argument(
        fmt::format("the name of the experiment, '{}', is no folder name: say --out DIR", name));
  }
  return std::filesystem::path("out") / name;
}

void CheckOutputs(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
  std::vector<fs::path> taken = inputs;
  for (const fs::path& output : outputs) {
    std::error_code not_there;
    if (fs::is_directory(output, not_there)) {
      throw std::invalid_argument(output.string() + " is a folder: name a file");
    }
    const bool is_taken = std::any_of(taken.begin(), taken.end(), [&](const fs::path& other) {
      return files::IsSameFile(output, other);
    });
    if (is_taken) {
      throw std::invalid_argument(
          fmt::format("{} is an input or another output: name another file", output.string()));
    }
    taken.push_back(output);
  }
}

void RefuseSweepFolder(const fs::path& folder) {
  if (!fs::exists(folder / "journal.sqlite") && !fs::exists(folder / "table.csv")) return;
  throw std::invalid_argument(
      fmt::format("{} holds a sweep: name another folder with --out", folder.string()));
}

namespace {

report::FigureFormat FormatOf(const std::filesystem::path& path) {
  if (path.extension() == ".svg") return report::FigureFormat::kSvg;
  if (path.extension() == ".png") return report::FigureFormat::kPng;
  throw std::invalid_argument("--figure " + path.string() + ": the name must end in .svg or .png");
}

}  // namespace

void RequireFigureName(const std::filesystem::path& path) { FormatOf(path); }

void WriteFigure(const std::filesystem::path& path, const report::Figure& figure) {
  files::WriteFile(path, report::Render(figure, FormatOf(path)));
}

void WriteFigureFiles(const std::filesystem::path& folder, const report::Figure& figure) {
  for (const char* extension : {".svg", ".png"}) {
    WriteFigure(folder / (figure.name + extension), figure);
  }
}

}  // namespace rift::commands
