#include "rift/commands/arguments/inputs.hpp"

#include "rift/files/files.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {

experiment::Experiment ReadExperiment(const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides) {
  return experiment::LoadExperiment(file.string(), overrides,
                                    [](const std::string& path) { return files::ReadFile(path); });
}

std::string FindInput(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code not_there;
  if (name.empty() || fs::path(name).is_absolute() || fs::exists(name, not_there)) return name;
  const fs::path program = fs::read_symlink("/proc/self/exe", not_there);
  // PREFIX/bin/rift, or PREFIX/lib/rift/rift-camera.
  for (const fs::path& prefix :
       {program.parent_path().parent_path(), program.parent_path().parent_path().parent_path()}) {
    const fs::path installed = prefix / "share" / "rift" / name;
    if (fs::exists(installed, not_there)) return installed.string();
  }
  return name;
}

void WarnOfTilt(const experiment::Experiment& experiment) {
  if (const auto warning = simulation::TiltWarning(experiment.simulation.body)) {
    terminal::Say("warning: " + *warning);
  }
}

void AddAnyWaypointsFlag(CLI::App& app, bool& any_waypoints) {
  app.add_flag("--any-waypoints", any_waypoints,
               "drive waypoints outside trial.arena, or too far apart to be metres, all the same");
}

sweep::Inputs FileInputs() {
  return {[](const std::string& path) { return files::ReadIfThere(path); },
          [](const std::string& line) { terminal::Say("note: " + line); }};
}

}  // namespace rift::commands
