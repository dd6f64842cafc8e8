#include "rift/sessions/sweep/replay.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "rift/sweep/falsify/candidate_runs.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::sessions {
namespace {

/// Cells that the trial alone decides.
std::string Evidence(const report::TableRow& row) {
  std::string text;
  for (const auto& [column, cell] : row) {
    if (column != "id") text += fmt::format("{} {}, ", column, cell);
  }
  return text;
}

std::filesystem::path TableOf(const std::filesystem::path& folder) { return folder / "table.csv"; }

report::TableRow RowOf(const std::filesystem::path& folder, const std::string& id) {
  const std::filesystem::path table = TableOf(folder);
  return report::TableRowOf(files::ReadFile(table), id, table.string());
}

std::string GapText(const report::TableRow& row) {
  const std::string& gap_m = row.at("gap_m");
  return gap_m.empty() ? "no gap" : fmt::format("gap {} m", gap_m);
}

/// One line that a row came out as it is in the table; throws where it did not.
std::string Verify(const experiment::Experiment& experiment, sweep::TrialRow again,
                   const report::TableRow& row, const std::string& id) {
  sweep::SweepResult result = sweep::EmptyResult(experiment);
  result.rows = {std::move(again)};
  const report::TableRow made = report::FirstTableRow(report::TableCsv(result));
  if (Evidence(made) != Evidence(row)) {
    throw std::runtime_error(fmt::format(
        "row {} comes out different ({}, not {}): another version of rift, of the program "
        "or of its logs made the table",
        id, GapText(made), GapText(row)));
  }
  return fmt::format("row {}: status {}, {}, to the last bit as in the table", id, row.at("status"),
                     GapText(row));
}

}  // namespace

std::optional<ProgramReplay> ReplayProgramRow(const std::filesystem::path& folder,
                                              const std::string& id, const sweep::Inputs& inputs) {
  const report::TableRow row = RowOf(folder, id);
  const std::string file = (folder / "experiment.yaml").string();
  const experiment::Experiment experiment = SavedExperiment(folder);
  if (experiment.candidate.kind != experiment::CandidateKind::kProgram) return std::nullopt;
  sweep::Evaluator evaluator(experiment, file, inputs);
  evaluator.LoadLogs();
  const sweep::TrialRequest request = report::RequestOf(experiment, row, TableOf(folder).string());
  sweep::ProgramTrial again = sweep::RunProgramTrial(evaluator, request);
  ProgramReplay replay{.experiment = experiment};
  replay.verdict = Verify(experiment, std::move(again.row), row, id);
  sweep::Recording& run = again.candidate;
  replay.has_arrived = run.status == sweep::TrialStatus::kOk;
  replay.trajectory = std::move(run.trajectory);
  return replay;
}

Replay ReplayRow(const std::filesystem::path& folder, const std::string& id,
                 const sweep::Inputs& inputs) {
  const report::TableRow row = RowOf(folder, id);
  const std::string file = (folder / "experiment.yaml").string();
  const experiment::Experiment experiment = SavedExperiment(folder);
  if (experiment.candidate.kind != experiment::CandidateKind::kSimulation) {
    throw std::invalid_argument(
        fmt::format("{}: candidate.kind is logs: there is nothing to simulate again", file));
  }
  sweep::Evaluator evaluator(experiment, file, inputs);
  evaluator.LoadLogs();
  const sweep::TrialRequest request = report::RequestOf(experiment, row, TableOf(folder).string());
  Replay replay{.experiment = sweep::ExperimentFor(experiment, request)};
  replay.experiment.seed = *request.seed;
  replay.trial = evaluator.TrialFor(request, evaluator.Reference(request));
  replay.run = sweep::Simulate(replay.trial);
  replay.verdict = Verify(experiment, evaluator.Evaluate(request), row, id);
  return replay;
}

}  // namespace rift::sessions
