#include "outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace rift::commands {

namespace fs = std::filesystem;

bool IsSameFile(const fs::path& a, const fs::path& b) {
  std::error_code not_there;
  return fs::absolute(a).lexically_normal() == fs::absolute(b).lexically_normal() ||
         fs::equivalent(a, b, not_there);
}

void CheckOutputs(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
  std::vector<fs::path> taken = inputs;
  for (const fs::path& output : outputs) {
    std::error_code not_there;
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
    taken.push_back(output);
  }
}

void RefuseSweepFolder(const fs::path& folder) {
  if (!fs::exists(folder / "journal.sqlite") && !fs::exists(folder / "table.csv")) return;
  throw std::invalid_argument(
      fmt::format("{} holds a sweep: name another folder with --out", folder.string()));
}

}  // namespace rift::commands
