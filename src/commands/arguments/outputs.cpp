#include "rift/commands/arguments/outputs.hpp"

#include <fmt/format.h>

#include <stdexcept>

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

void AddForceFlag(CLI::App& app, bool& force) {
  app.add_flag("--force", force, "replace files that are there already");
}

void RefuseSweepFolder(const fs::path& folder) {
  if (!fs::exists(folder / "journal.sqlite") && !fs::exists(folder / "table.csv")) return;
  throw std::invalid_argument(
      fmt::format("{} holds a sweep: name another folder with --out", folder.string()));
}

void RefuseRunFolder(const fs::path& folder) {
  if (!fs::exists(folder / "trajectory.csv")) return;
  throw std::invalid_argument(
      fmt::format("{} holds a run: name another folder with --out", folder.string()));
}

}  // namespace rift::commands
