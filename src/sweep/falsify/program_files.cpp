#include "rift/sweep/falsify/program_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

/// True where it is certain that the first argument is a script, by interpreter and ending.
bool RunsScript(const std::vector<std::string>& words) {
  static const std::array<std::string_view, 10> kInterpreters{
      "python", "node", "ruby", "perl", "bash", "sh", "julia", "lua", "octave", "Rscript"};
  static const std::array<std::string_view, 10> kEndings{".py", ".js", ".mjs", ".cjs", ".rb",
                                                         ".pl", ".sh", ".jl",  ".lua", ".R"};
  std::string interpreter = fs::path(words.front()).filename().string();
  interpreter.resize(interpreter.find_last_not_of("0123456789.") + 1);  // python3.11
  const auto is_one_of = [](const auto& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return is_one_of(kInterpreters, interpreter) && words.size() > 1 &&
         words[1].find('{') == std::string::npos &&
         is_one_of(kEndings, fs::path(words[1]).extension().string());
}

void RequireProgram(const std::string& file, const std::string& key,
                    const std::vector<std::string>& words) {
  if (words.empty() || words.front().find('{') != std::string::npos) return;
  const std::string& program = words.front();
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(fmt::format("{}: {}.run: {}", file, key, why));
  };
  std::error_code none;
  if (program.find('/') != std::string::npos) {
    if (!fs::is_regular_file(program, none) || !fs::path(program).is_absolute()) {
      refuse(
          fmt::format("there is no program {}: name it by its whole path, by one from the folder "
                      "of the experiment's file, or by a name in PATH",
                      program));
    }
    if (::access(program.c_str(), X_OK) != 0) {
      refuse(
          fmt::format("{} is not executable: chmod +x it, or name its interpreter first", program));
    }
    return;
  }
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/local/bin:/bin:/usr/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file_there = fs::path(folder.empty() ? "." : folder) / program;
    if (fs::is_regular_file(file_there, none) && ::access(file_there.c_str(), X_OK) == 0) return;
  }
  refuse(fmt::format("there is no program '{}' in PATH: install it, or mend the name", program));
}

}  // namespace

void RequirePrograms(const experiment::Experiment& experiment, const std::string& file) {
  if (experiment.candidate.kind == experiment::CandidateKind::kProgram) {
    RequireProgram(file, "candidate", experiment.candidate.run.words);
  }
  if (experiment.reference.kind == experiment::ReferenceKind::kProgram) {
    RequireProgram(file, "reference", experiment.reference.run.words);
  }
}

void RequireScript(const std::vector<std::string>& words) {
  std::error_code none;
  if (!RunsScript(words)) return;
  if (fs::path(words[1]).is_absolute() && fs::exists(words[1], none)) return;
  throw std::invalid_argument(
      fmt::format("there is no file '{}' beside the experiment, and {} would end at once in every "
                  "trial: name it from the experiment's folder, or with its whole path",
                  words[1], words.front()));
}

}  // namespace rift::sweep
