#include "replay.hpp"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>

#include "files.hpp"
#include "rift/report/json/table.hpp"
#include "simulated_runs.hpp"
#include "sweep_sources.hpp"

namespace rift::commands {
namespace {

sweep::TrialRequest RequestOf(const experiment::Experiment& experiment,
                              const report::TableRow& row) {
  sweep::TrialRequest request{.trial = row.at("trial")};
  std::uint64_t seed = 0;
  const std::string& text = row.at("seed");
  std::from_chars(text.data(), text.data() + text.size(), seed);
  request.seed = seed;
  for (const experiment::Parameter& parameter : experiment.space.parameters) {
    const std::string& cell = row.at(parameter.Name());
    double number = 0.0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    const bool is_number =
        !parameter.IsCategorical() && error == std::errc{} && end == cell.data() + cell.size();
    request.theta.push_back({cell, is_number ? std::optional(number) : std::nullopt});
    for (const experiment::ParameterValue& level : parameter.levels) {
      if (level.text == cell) request.theta.back() = level;
    }
  }
  return request;
}

/// Cells that the trial alone decides.
std::string Evidence(const report::TableRow& row) {
  std::string text;
  for (const auto& [column, cell] : row) {
    if (column != "id") text += fmt::format("{} {}, ", column, cell);
  }
  return text;
}

}  // namespace

Replay ReplayRow(const std::filesystem::path& folder, const std::string& id) {
  const std::filesystem::path table = folder / "table.csv";
  const report::TableRow row = report::TableRowOf(ReadFile(table), id, table.string());
  const std::string file = (folder / "experiment.yaml").string();
  const experiment::Experiment experiment =
      experiment::LoadExperiment(file, {}, [](const std::string& path) { return ReadFile(path); });
  if (experiment.candidate.kind != experiment::CandidateKind::kSimulation) {
    throw std::invalid_argument(
        fmt::format("{}: candidate.kind is logs: there is nothing to simulate again", file));
  }
  SweepSources sources(experiment, file);
  sources.LoadLogs();
  const sweep::TrialRequest request = RequestOf(experiment, row);
  Replay replay{.experiment = experiment::ExperimentAt(experiment, request.theta)};
  replay.experiment.seed = *request.seed;
  replay.trial = sources.TrialFor(request, sources.Reference(request));
  replay.run = sweep::Simulate(replay.trial);
  sweep::SweepResult again = sweep::EmptyResult(sources.Plan());
  again.rows = {sources.Evaluate(request)};
  const report::TableRow made = report::FirstTableRow(report::TableCsv(again));
  if (Evidence(made) != Evidence(row)) {
    throw std::runtime_error(fmt::format(
        "row {} comes out different (gap {} m, not {} m): another version of rift, or of its logs, "
        "made the table",
        id, made.at("gap_m"), row.at("gap_m")));
  }
  replay.verdict = fmt::format("row {}: status {}, gap {} m, to the last bit as in the table", id,
                               row.at("status"), row.at("gap_m"));
  return replay;
}

}  // namespace rift::commands
