#include "simulate.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sessions/simulate/pictures.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "rift/sessions/sweep/replay.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/sweep/falsify/uncrossed_note.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

/// A run and where it is saved.
struct RunToSave {
  fs::path out;
  sessions::Simulated made;
};

RunToSave SimulateFile(const SimulateRequest& request) {
  std::vector<fs::path> inputs;
  const experiment::Experiment experiment = LoadFor(request, inputs);
  const fs::path out = OutputOf(request.out, experiment.name);
  CheckNames(request, out, experiment, inputs);
  const sweep::SimulatedTrial trial =
      sessions::TrialAlone(experiment, request.experiment, FileInputs());
  SayTaskNotes(experiment, request.experiment);
  WarnOfTilt(experiment);
  if (const auto note = sweep::UncrossedNote(trial)) terminal::Say(*note);
  SaySimulatorNotes(experiment);
  return {out, {experiment, trial, sweep::Simulate(trial)}};
}

/// A row of a sweep that is made again, and where it goes.
struct ReplayedRow {
  explicit ReplayedRow(const SimulateRequest& request)
      : folder(request.replay[0]), id(request.replay[1]) {
    for (const char* name :
         {"table.csv", "experiment.yaml", "journal.sqlite", "inputs.txt", "summary.json"}) {
      files.push_back(folder / name);
    }
    const std::string table = files.front().string();
    if (id == "worst") {
      const std::string text = files::ReadFile(table);
      id = report::WorstIdOf(text, table, sessions::SavedExperiment(folder).gap.threshold_m);
    }
    out = request.out.empty() ? folder / "replay" / id : fs::path(request.out);
  }

  fs::path folder, out;
  std::string id;
  std::vector<fs::path> files;  ///< of the sweep
};

/// Of a sweep over somebody else's simulator: its trajectory is all there is of it. Returns the
/// exit code.
int SaveProgram(const SimulateRequest& request, const ReplayedRow& row,
                const sessions::ProgramReplay& replay) {
  Refuse(
      {{request.json || !request.figure.empty() || !request.video.empty() || request.window,
        "--json, --figure, --video and --view are of rift's own simulator, and candidate.kind is "
        "program"}});
  RequireRunName(row.out);
  const fs::path log = row.out.extension() == ".csv" ? row.out : row.out / "trajectory.csv";
  if (!request.IsStdout()) {
    // The same row gives the same bytes, in the place that is its own.
    CheckOutputs(row.files, {.files = {log},
                             .folder = log.parent_path(),
                             .force = request.force || request.out.empty()});
  }
  CheckOutputs({log}, {.files = request.copies.Files(), .force = request.force});
  if (!replay.trajectory.poses.empty()) {
    request.copies.Write(replay.trajectory);
    const std::string text = trajectory::WriteRift(replay.trajectory);
    if (request.IsStdout()) {
      terminal::PrintData(text);
    } else {
      files::WriteFile(log, text);
      terminal::Say("log: " + log.string());
    }
  }
  if (request.IsStdout()) {
    terminal::Say(replay.verdict);
  } else {
    terminal::PrintText(replay.verdict + "\n");
  }
  return replay.has_arrived ? terminal::kDone : terminal::kNotReached;
}

/// A run that ended before it moved, a fault mostly, has no path; that is no reason to end without
/// its verdict.
void Draw(const std::string& name, const sessions::Simulated& made) {
  if (made.run.truth.poses.size() < 2) {
    terminal::Say(fmt::format("note: {} is not drawn: the run ended at its first pose", name));
  } else {
    report::WriteFigure(name, sessions::FigureOf(made));
  }
}

int Save(const SimulateRequest& request, const RunToSave& run,
         const std::function<void(const sessions::Simulated&)>& show) {
  const auto& [out, made] = run;
  const sessions::RunFiles files(out);
  const trial::SteeringCheck check = sessions::CheckOf(made);
  if (!request.IsStdout()) sessions::SaveRun(files, made, check);
  const trial::TrialResult& result = made.run.result;
  request.copies.Write(result.trajectory);
  if (!request.figure.empty()) Draw(request.figure, made);
  if (show) show(made);
  if (request.IsStdout()) {
    terminal::PrintData(trajectory::WriteRift(result.trajectory));
  } else {
    terminal::Say("log: " + files.trajectory.string());
    request.json ? terminal::PrintData(report::SimulationJson(made.experiment, made.run, check))
                 : terminal::PrintText(report::SimulationText(made.experiment, made.run));
  }
  for (const std::string& line : report::SteeringLines(check, result.limits)) terminal::Say(line);
  return result.outcome == trial::Outcome::kReached ? terminal::kDone : terminal::kNotReached;
}

}  // namespace

int Simulate(const SimulateRequest& request,
             const std::function<void(const sessions::Simulated&)>& show) {
  if (request.replay.empty()) return Save(request, SimulateFile(request), show);
  Refuse({{!request.experiment.empty() || !request.overrides.empty() || !request.start.empty() ||
               !request.seed.empty(),
           "--replay takes everything from the sweep: leave EXPERIMENT, --set, --start, --seed "
           "out"}});
  const ReplayedRow row(request);
  const auto program = sessions::ReplayProgramRow(row.folder, row.id, FileInputs());
  if (program) return SaveProgram(request, row, *program);
  sessions::Replay again = sessions::ReplayRow(row.folder, row.id, FileInputs());
  terminal::Say(again.verdict);
  CheckNames(request, row.out, again.experiment, row.files);
  return Save(
      request,
      {row.out, {std::move(again.experiment), std::move(again.trial), std::move(again.run)}}, show);
}

}  // namespace rift::commands
