#include "programs.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

/// A program that is not there would fail in every trial.
void RequireProgram(const std::string& file, const std::string& key,
                    const experiment::CommandLine& run) {
  if (run.words.empty() || run.words.front().find('{') != std::string::npos) return;
  const std::string& program = run.words.front();
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
    RequireProgram(file, "candidate", experiment.candidate.run);
  }
  if (experiment.reference.kind == experiment::ReferenceKind::kProgram) {
    RequireProgram(file, "reference", experiment.reference.run);
  }
}

}  // namespace rift::commands
