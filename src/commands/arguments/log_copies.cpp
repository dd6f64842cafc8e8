#include "rift/commands/arguments/log_copies.hpp"

#include "rift/files/files.hpp"
#include "rift/terminal/print.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::commands {

std::vector<std::filesystem::path> LogCopies::Files() const {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : {tum, mcap}) {
    if (!name.empty()) files.emplace_back(name);
  }
  return files;
}

void AddLogCopyFlags(CLI::App& app, LogCopies& copies) {
  app.add_option("--tum", copies.tum, "write the log for evo as well")->type_name("FILE.tum");
  app.add_option("--mcap", copies.mcap, "write the log for Foxglove and PlotJuggler as well")
      ->type_name("FILE.mcap");
}

void WriteLogCopies(const LogCopies& copies, const trajectory::Trajectory& trajectory) {
  if (!copies.tum.empty()) files::WriteFile(copies.tum, trajectory::WriteTum(trajectory));
  if (!copies.mcap.empty()) files::WriteFile(copies.mcap, trajectory::WriteMcap(trajectory));
  for (const auto& file : copies.Files()) terminal::Say("log: " + file.string());
}

}  // namespace rift::commands
