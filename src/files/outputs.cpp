#include "rift/files/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "rift/files/files.hpp"

namespace rift::files {
namespace {

namespace fs = std::filesystem;

/// Whether `folder` is made on the way to `made`, or within it.
bool IsMadeWith(const fs::path& folder, const fs::path& made) {
  if (made.empty()) return false;
  const fs::path a = (fs::absolute(folder) / "").lexically_normal();
  const fs::path b = (fs::absolute(made) / "").lexically_normal();
  return a.string().starts_with(b.string()) || b.string().starts_with(a.string());
}

void RequireParent(const fs::path& file, const fs::path& made) {
  const fs::path folder = file.parent_path();
  std::error_code not_there;
  if (folder.empty() || fs::is_directory(folder, not_there) || IsMadeWith(folder, made)) return;
  throw std::invalid_argument(
      fmt::format("{}: there is no folder {}: mend the name, or make the folder with mkdir -p",
                  file.string(), folder.string()));
}

/// An ending that no folder has, but a table, a report or a film.
bool NamesFile(const fs::path& name) {
  static const std::set<std::string> endings{".csv", ".html", ".json", ".log", ".mcap",
                                             ".mp4", ".pdf",  ".png",  ".svg", ".tum",
                                             ".txt", ".xlsx", ".yaml", ".yml", ".zip"};
  return endings.contains(name.extension().string());
}

/// Throws std::invalid_argument when what is there of the way to a folder is not one.
void RequireWayTo(const fs::path& folder) {
  std::error_code not_there;
  for (fs::path above = folder.parent_path(); !above.empty(); above = above.parent_path()) {
    if (fs::is_directory(above, not_there)) return;
    if (fs::exists(above, not_there)) {
      throw std::invalid_argument(
          fmt::format("--out {}: {} is a file, and no folder can be below it", folder.string(),
                      above.string()));
    }
  }
}

/// Throws std::invalid_argument when `file` is there and `force` is not given.
void RefuseOverwriting(const fs::path& file, bool force) {
  std::error_code not_there;
  if (force || !fs::is_regular_file(file, not_there) || IsStandardStream(file)) return;
  throw std::invalid_argument(
      fmt::format("{} is there already: name another file or folder, or give --force to replace it",
                  file.string()));
}

}  // namespace

void CheckOutputs(const std::vector<fs::path>& inputs, const Outputs& outputs) {
  std::vector<fs::path> taken = inputs;
  for (const fs::path& output : outputs.files) {
    std::error_code not_there;
    if (output == "-") {
      throw std::invalid_argument("- is stdout, and a file is needed here: name a file");
    }
    if (fs::is_directory(output, not_there)) {
      throw std::invalid_argument(output.string() + " is a folder: name a file");
    }
    const bool is_taken = std::any_of(taken.begin(), taken.end(), [&](const fs::path& other) {
      return IsSameFile(output, other);
    });
    if (is_taken) {
      throw std::invalid_argument(
          fmt::format("{} is an input or another output: name another file", output.string()));
    }
    RequireParent(output, outputs.folder);
    RefuseOverwriting(output, outputs.force);
    taken.push_back(output);
  }
}

void RequireFolderName(const std::string& out, std::string_view what) {
  std::error_code not_there;
  if (fs::exists(out, not_there) && !fs::is_directory(out, not_there)) {
    throw std::invalid_argument(
        fmt::format("--out {} is a file, and {} is a folder of files: name a folder", out, what));
  }
  if (out == "-") {
    throw std::invalid_argument(fmt::format(
        "--out -: {} is a folder of files and cannot go to stdout: name a folder", what));
  }
  RequireWayTo(out);
  if (fs::is_directory(out, not_there) || !NamesFile(out)) return;
  throw std::invalid_argument(fmt::format(
      "--out {} is the name of a file, and {} is a folder of files: name a folder", out, what));
}

}  // namespace rift::files
