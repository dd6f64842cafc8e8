#include "rift/commands/arguments/inputs.hpp"

#include "rift/files/files.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {

experiment::Experiment ReadExperiment(const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides) {
  return experiment::LoadExperiment(file.string(), overrides,
                                    [](const std::string& path) { return files::ReadFile(path); });
}

sweep::Inputs FileInputs() {
  return {[](const std::string& path) { return files::ReadIfThere(path); },
          [](const std::string& line) { terminal::Say("note: " + line); }};
}

}  // namespace rift::commands
