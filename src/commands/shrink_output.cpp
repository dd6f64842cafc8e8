#include "shrink_output.hpp"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>

#include "files.hpp"
#include "json_fields.hpp"
#include "rift/report/figures/sweep_figures.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/falsify.hpp"
#include "rift/sweep/falsify/labels.hpp"
#include "rift/yaml/enum_name.hpp"
#include "sweep_output.hpp"

namespace rift::commands {
namespace {

using nlohmann::ordered_json;

/// Everything that shrunk.json tells.
struct ShrunkRow {
  int id = 0;  ///< of the row in the sweep's table
  experiment::Theta nominal;
  sweep::ShrunkFailure shrunk;
  /// The row, the shrunk one, and that without each of its changes: the table of DIR/shrunk.
  std::vector<sweep::TrialRow> rows;
};

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

ShrunkRow ShrinkRow(const experiment::Experiment& experiment, const sweep::SweepResult& result,
                    int index, const sweep::ShrinkOptions& options, FurtherTrials& trials) {
  const sweep::TrialRow& row = result.rows[index];
  const auto robustness_m = [&](const experiment::Theta& theta) {
    const std::vector<sweep::TrialRow> rows = trials.Run({At(row, theta)});
    return sweep::Robustness_m(rows, result.gap.threshold_m);
  };
  ShrunkRow found{.id = index + 1, .nominal = NominalTheta(experiment)};
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

ordered_json ThetaJson(const std::vector<experiment::Parameter>& parameters,
                       const experiment::Theta& theta) {
  ordered_json json = ordered_json::object();
  for (size_t i = 0; i < theta.size(); ++i) {
    const experiment::ParameterValue& value = theta[i];
    json[parameters[i].key] = value.number ? ordered_json(*value.number) : ordered_json(value.text);
  }
  return json;
}

std::string ReplayCommand(const std::filesystem::path& folder, size_t row) {
  return fmt::format("rift simulate --replay {} {}", (folder / "shrunk").string(), row + 1);
}

ordered_json TrialJson(const std::filesystem::path& folder,
                       const std::vector<experiment::Parameter>& parameters, const ShrunkRow& found,
                       size_t i) {
  const sweep::TrialRow& row = found.rows[i];
  return {{"theta", ThetaJson(parameters, row.theta)},
          {"status", yaml::NameOf(row.status)},
          {"gap_m", NumberOrNull(row.comparison.gap_m)},
          {"falsified", row.falsified},
          {"replay", ReplayCommand(folder, i)}};
}

std::string ShrunkJson(const std::filesystem::path& folder,
                       const std::vector<experiment::Parameter>& parameters, double threshold_m,
                       const ShrunkRow& found) {
  const sweep::TrialRow& failing = found.rows.front();
  ordered_json json{{"row", found.id}, {"trial", failing.trial}};
  if (failing.seed) json["seed"] = *failing.seed;
  json["threshold_m"] = threshold_m;
  json["nominal"] = ThetaJson(parameters, found.nominal);
  json["failing"] = TrialJson(folder, parameters, found, 0);
  json["shrunk"] = TrialJson(folder, parameters, found, 1);
  json["changes"] = ordered_json::array();
  for (size_t i = 0; i < found.shrunk.changed.size(); ++i) {
    const int parameter = found.shrunk.changed[i];
    json["changes"].push_back({{"parameter", parameters[parameter].key},
                               {"nominal", found.nominal[parameter].text},
                               {"failing", failing.theta[parameter].text},
                               {"shrunk", found.shrunk.theta[parameter].text},
                               {"without", TrialJson(folder, parameters, found, 2 + i)}});
  }
  json["is_minimal"] = found.shrunk.is_minimal;
  json["is_fewest"] = found.shrunk.is_fewest;
  json["evaluations"] = found.shrunk.evaluations;
  return Dump(json);
}

std::string OutcomeText(const sweep::TrialRow& row) {
  return row.IsOk() ? fmt::format("gap {:.4f} m", row.comparison.gap_m)
                    : std::string(yaml::NameOf(row.status));
}

std::string ShrunkText(const std::filesystem::path& folder,
                       const std::vector<experiment::Parameter>& parameters, double threshold_m,
                       const ShrunkRow& found) {
  const sweep::TrialRow& failing = found.rows[0];
  const sweep::TrialRow& least = found.rows[1];
  std::string text = fmt::format(
      "\nshrunk: row {} ({}; {}) still fails with {} of its {} changes from the experiment's own "
      "values ({}, above {:g} m; {} trials)\n",
      found.id, sweep::SettingText(parameters, failing.theta), OutcomeText(failing),
      found.shrunk.changed.size(), parameters.size(), OutcomeText(least), threshold_m,
      found.shrunk.evaluations);
  if (found.shrunk.changed.empty()) {
    text += "  it fails with none of them: the experiment's own values do\n";
  }
  for (size_t i = 0; i < found.shrunk.changed.size(); ++i) {
    const int parameter = found.shrunk.changed[i];
    text += fmt::format("  {}: {} instead of {}; taken back, {}\n", parameters[parameter].Name(),
                        found.shrunk.theta[parameter].text, found.nominal[parameter].text,
                        OutcomeText(found.rows[2 + i]));
  }
  text += found.shrunk.is_minimal ? "  none of these changes can be left out (each was tried)\n"
                                  : "  there may be less to it: no more trials are spent on it\n";
  if (found.shrunk.is_fewest)
    text += "  no smaller set of the row's changes fails (all were tried)\n";
  return text + fmt::format("  again: {}\n", ReplayCommand(folder, 1));
}

}  // namespace

std::string ShrinkInto(const std::filesystem::path& folder,
                       const experiment::Experiment& experiment, const sweep::SweepResult& result,
                       const std::string& row, const sweep::ShrinkOptions& options,
                       FurtherTrials& trials) {
  const int index = IndexOf(result, row);
  RequireFailure(result, index, row);
  const ShrunkRow found = ShrinkRow(experiment, result, index, options, trials);
  sweep::SweepResult table = sweep::EmptyResult(trials.plan());
  table.rows = found.rows;
  WriteFile(folder / "shrunk" / "experiment.yaml", experiment::WriteExperiment(experiment));
  WriteFile(folder / "shrunk" / "table.csv", TableCsv(table));
  const double threshold_m = result.gap.threshold_m;
  WriteFile(folder / "shrunk.json", ShrunkJson(folder, result.parameters, threshold_m, found));
  return ShrunkText(folder, result.parameters, threshold_m, found);
}

}  // namespace rift::commands
