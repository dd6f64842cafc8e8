#include "rift/commands/arguments/arguments.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "rift/experiment/task.hpp"
#include "rift/files/files.hpp"
#include "rift/terminal/print.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::commands {

namespace fs = std::filesystem;

void AddSetFlag(CLI::App& app, std::vector<std::string>& overrides, const char* example) {
  app.add_option("--set", overrides, fmt::format("sets one key, such as {}", example))
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void AddKeysFlag(CLI::App& app) {
  const auto list_and_end = [] {
    terminal::PrintText(experiment::DescribeKeys());
    throw CLI::Success();
  };
  app.add_flag_callback("--keys", list_and_end, "list every key of an experiment and end")
      ->trigger_on_parse();
}

void AddAnyWaypointsFlag(CLI::App& app, bool& any_waypoints) {
  app.add_flag("--any-waypoints", any_waypoints,
               "drive waypoints outside trial.arena, or too far apart to be metres, all the same");
}

void AddForceFlag(CLI::App& app, bool& force) {
  app.add_flag("--force", force, "replace files that are there already");
}

experiment::Experiment ReadExperiment(const fs::path& file,
                                      const std::vector<std::string>& overrides) {
  return experiment::LoadExperiment(file.string(), overrides,
                                    [](const std::string& path) { return files::ReadFile(path); });
}

void SayTaskNotes(const experiment::Experiment& experiment, const std::string& file) {
  for (const std::string& note : experiment::TaskNotes(experiment, file)) terminal::Say(note);
}

void SaySimulatorNotes(const experiment::Experiment& experiment) {
  if (const auto note = experiment::FullLineNote(experiment)) terminal::Say(*note);
  if (const auto note = experiment::IdleHostNote(experiment)) terminal::Say(*note);
}

void WarnOfTilt(const experiment::Experiment& experiment) {
  if (const auto warning = simulation::TiltWarning(experiment.simulation.body)) {
    terminal::Say("warning: " + *warning);
  }
}

sweep::Inputs FileInputs() {
  return {[](const std::string& path) { return files::ReadIfThere(path); },
          [](const std::string& line) { terminal::Say("note: " + line); }};
}

fs::path OutputOf(const std::string& out, const std::string& name) {
  if (!out.empty()) return out;
  const bool is_plain =
      !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
  if (is_plain) return fs::path("out") / name;
  throw std::invalid_argument(
      fmt::format("the name of the experiment, '{}', is no folder name: say --out DIR", name));
}

void RefuseSweepFolder(const fs::path& folder) {
  Refuse({{fs::exists(folder / "journal.sqlite") || fs::exists(folder / "table.csv"),
           folder.string() + " holds a sweep: name another folder with --out"}});
}

void RefuseRunFolder(const fs::path& folder) {
  Refuse({{fs::exists(folder / "trajectory.csv"),
           folder.string() + " holds a run: name another folder with --out"}});
}

std::vector<fs::path> LogCopies::Files() const {
  std::vector<fs::path> files;
  for (const std::string& name : {tum, mcap}) {
    if (!name.empty()) files.emplace_back(name);
  }
  return files;
}

void LogCopies::Write(const trajectory::Trajectory& trajectory) const {
  if (!tum.empty()) files::WriteFile(tum, trajectory::WriteTum(trajectory));
  if (!mcap.empty()) files::WriteFile(mcap, trajectory::WriteMcap(trajectory));
  for (const auto& file : Files()) terminal::Say("log: " + file.string());
}

}  // namespace rift::commands
