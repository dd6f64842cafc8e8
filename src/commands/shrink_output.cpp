#include "shrink_output.hpp"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>

#include "files.hpp"
#include "rift/report/figures/sweep_figures.hpp"
#include "rift/report/json/sweep.hpp"
#include "rift/report/json/table.hpp"
#include "rift/report/text/sweep.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/falsify.hpp"
#include "rift/sweep/falsify/grid.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::commands {
namespace {

/// Index of the row with that id, or of the largest gap.
int IndexOf(const sweep::SweepResult& result, const std::string& id) {
  if (id == "worst") {
    const std::optional<int> worst = report::WorstRow(result);
    if (!worst) throw std::invalid_argument("--shrink worst: no trial has a gap");
    return *worst;
  }
  size_t number = 0;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), number);
  const bool is_there = error == std::errc{} && end == id.data() + id.size() && number >= 1 &&
                        number <= result.rows.size();
  if (!is_there) {
    throw std::invalid_argument(
        fmt::format("--shrink {}: table.csv has the rows 1 to {}", id, result.rows.size()));
  }
  return static_cast<int>(number) - 1;
}

/// The row's trial at another setting: the same repeat and random numbers.
sweep::TrialRequest At(const sweep::TrialRow& row, const experiment::Theta& theta) {
  return {.theta = theta, .trial = row.trial, .seed = row.seed};
}

void RequireFailure(const sweep::SweepResult& result, int index, const std::string& id) {
  const sweep::TrialRow& row = result.rows[index];
  if (row.falsified) return;
  const std::string what = row.IsOk() ? fmt::format("its gap is {:.4f} m", row.comparison.gap_m)
                                      : fmt::format("it ended as '{}'", yaml::NameOf(row.status));
  throw std::invalid_argument(
      fmt::format("--shrink {}: row {} does not fail ({}, and above {:g} m falsifies){}", id,
                  index + 1, what, result.gap.threshold_m,
                  id == "worst" ? ": nothing of this sweep can be shrunk"
                                : "; --shrink worst takes the worst"));
}

sweep::ShrunkRow ShrinkRow(const experiment::Experiment& experiment,
                           const sweep::SweepResult& result, int index,
                           const sweep::ShrinkOptions& options, FurtherTrials& trials) {
  const sweep::TrialRow& row = result.rows[index];
  const auto robustness_m = [&](const experiment::Theta& theta) {
    const std::vector<sweep::TrialRow> rows = trials.Run({At(row, theta)});
    return sweep::Robustness_m(rows, result.gap.threshold_m);
  };
  sweep::ShrunkRow found{.id = index + 1, .nominal = experiment::NominalTheta(experiment)};
  found.shrunk = sweep::Shrink(result.parameters, found.nominal, row.theta, robustness_m, options);
  std::vector<sweep::TrialRequest> requests{At(row, row.theta), At(row, found.shrunk.theta)};
  for (const int i : found.shrunk.changed) {
    experiment::Theta without = found.shrunk.theta;
    without[i] = found.nominal[i];
    requests.push_back(At(row, without));
  }
  found.rows = trials.Run(std::move(requests));
  return found;
}

}  // namespace

std::string ShrinkInto(const std::filesystem::path& folder,
                       const experiment::Experiment& experiment, const sweep::SweepResult& result,
                       const std::string& row, const sweep::ShrinkOptions& options,
                       FurtherTrials& trials) {
  const int index = IndexOf(result, row);
  RequireFailure(result, index, row);
  const sweep::ShrunkRow found = ShrinkRow(experiment, result, index, options, trials);
  sweep::SweepResult table = sweep::EmptyResult(experiment);
  table.rows = found.rows;
  WriteFile(folder / "shrunk" / "experiment.yaml", experiment::WriteExperiment(experiment));
  WriteFile(folder / "shrunk" / "table.csv", report::TableCsv(table));
  const std::string trials_folder = (folder / "shrunk").string();
  WriteFile(folder / "shrunk.json", report::ShrunkJson(result, found, trials_folder));
  return report::ShrunkText(result, found, trials_folder);
}

}  // namespace rift::commands
