#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/replay.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/trajectory/log.hpp"
#include "simulate.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> SweepFiles(const fs::path& folder) {
  return {folder / "table.csv", folder / "experiment.yaml", folder / "journal.sqlite",
          folder / "inputs.txt", folder / "summary.json"};
}

/// The row's id, or that of the worst row.
std::string ReplayedId(const SimulateRequest& request) {
  if (request.replay[1] != "worst") return request.replay[1];
  const std::string table = (fs::path(request.replay[0]) / "table.csv").string();
  return report::WorstIdOf(files::ReadFile(table), table);
}

}  // namespace

std::optional<int> ReplayProgram(const SimulateRequest& request) {
  if (request.replay.empty()) return std::nullopt;
  const fs::path folder = request.replay[0];
  const std::string id = ReplayedId(request);
  const std::optional<sessions::ProgramReplay> replay =
      sessions::ReplayProgramRow(folder, id, FileInputs());
  if (!replay) return std::nullopt;
  const bool has_more = request.json || !request.pictures.figure.empty() ||
                        !request.pictures.video.empty() || request.pictures.window;
  if (has_more) {
    throw std::invalid_argument(
        "--json, --figure, --video and --view are of rift's own simulator, and candidate.kind is "
        "program");
  }
  const fs::path out = (request.out.empty() ? folder / "replay" / id : fs::path(request.out));
  const fs::path log = out.extension() == ".csv" ? out : out / "trajectory.csv";
  // The same row gives the same bytes, in the place that is its own.
  CheckOutputs(
      SweepFiles(folder),
      {.files = {log}, .folder = log.parent_path(), .force = request.force || request.out.empty()});
  CheckOutputs({log}, {.files = request.copies.Files(), .force = request.force});
  if (!replay->trajectory.poses.empty()) {
    files::WriteFile(log, trajectory::WriteRift(replay->trajectory));
    WriteLogCopies(request.copies, replay->trajectory);
    terminal::Say("log: " + log.string());
  }
  terminal::PrintText(replay->verdict + "\n");
  return replay->has_arrived ? terminal::kDone : terminal::kNotReached;
}

RunToSave ReplayFor(const SimulateRequest& request) {
  const fs::path folder = request.replay[0];
  const std::string id = ReplayedId(request);
  sessions::Replay replay = sessions::ReplayRow(folder, id, FileInputs());
  terminal::Say(replay.verdict);
  const fs::path out = request.out.empty() ? folder / "replay" / id : fs::path(request.out);
  CheckNames(request, out, replay.experiment, SweepFiles(folder));
  return {out, {std::move(replay.experiment), std::move(replay.trial), std::move(replay.run)}};
}

}  // namespace rift::commands
