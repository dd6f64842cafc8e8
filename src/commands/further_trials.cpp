#include "further_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "files.hpp"
#include "rift/report/figures/sweep_figures.hpp"
#include "rift/report/json/sweep.hpp"
#include "rift/report/json/table.hpp"
#include "rift/report/text/sweep.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/falsify.hpp"
#include "rift/sweep/falsify/grid.hpp"
#include "rift/sweep/falsify/search_space.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::commands {

FurtherTrials::FurtherTrials(sweep::Evaluator& evaluator, const Style& style,
                             const StopSignal& stop)
    : style_(style),
      runner_([&evaluator](const sweep::TrialRequest& trial) { return evaluator.Evaluate(trial); },
              [&evaluator](const sweep::TrialRequest& trial) { return evaluator.KeyOf(trial); },
              nullptr, style.jobs, evaluator.experiment().run,
              {[this](const sweep::TrialRow& row, bool from_journal) {
                 if (progress_) progress_->Seen(row, from_journal);
               },
               [this, &stop] {
                 if (progress_) progress_->Tick();
                 return !stop.IsAsked();
               }}) {
  evaluator.LoadLogs();  // workers are copies of what is there when they start
}

std::vector<sweep::TrialRow> FurtherTrials::Run(std::vector<sweep::TrialRequest> requests) {
  std::optional<std::vector<sweep::TrialRow>> rows = runner_.Run(std::move(requests));
  if (!rows) throw Stopped{};
  return *std::move(rows);
}

void FurtherTrials::Begin(int most) { progress_.emplace(style_.progress, SweepSize{.most = most}); }

void FurtherTrials::End() {
  progress_->End("done");
  progress_.reset();
}

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

namespace {

/// Whole numbers and lists get equal shares of the unit interval for each of their values.
double CoordinateOf(const search::Axis& axis, double x) {
  if (axis.kind == search::AxisKind::kContinuous) return axis.min + x * (axis.max - axis.min);
  return std::min(axis.max, axis.min + std::floor(x * (axis.max - axis.min + 1.0)));
}

experiment::Theta ThetaAtUnit(const std::vector<experiment::Parameter>& parameters,
                              const std::vector<search::Axis>& axes, std::span<const double> unit) {
  search::Point point;
  for (size_t i = 0; i < axes.size(); ++i) point.push_back(CoordinateOf(axes[i], unit[i]));
  return sweep::ThetaAt(parameters, point);
}

/// Of the worst trial; NaN when none tells.
double WorstRobustness_m(std::span<const sweep::TrialRow> rows, double threshold_m) {
  double worst_m = std::numeric_limits<double>::quiet_NaN();
  for (size_t i = 0; i < rows.size(); ++i) {
    worst_m = std::fmin(worst_m, sweep::Robustness_m(rows.subspan(i, 1), threshold_m));
  }
  return worst_m;
}

}  // namespace

std::string RareEventInto(const std::filesystem::path& folder,
                          const experiment::Experiment& experiment,
                          const sweep::RareEventOptions& options, FurtherTrials& trials) {
  const std::vector<experiment::Parameter>& parameters = experiment.space.parameters;
  const std::vector<search::Axis> axes = sweep::AxesOf(parameters);
  const double threshold_m = experiment.gap.threshold_m;
  const auto robustness_m = [&](std::span<const double> unit) {
    const experiment::Theta theta = ThetaAtUnit(parameters, axes, unit);
    return WorstRobustness_m(trials.Run(sweep::TrialsAt(experiment, theta)), threshold_m);
  };
  trials.Begin(options.samples_per_level * options.most_levels *
               static_cast<int>(experiment.reference.trials.names.size()));
  const sweep::RareEvent event = sweep::EstimateRareEvent(static_cast<int>(parameters.size()),
                                                          robustness_m, experiment.seed, options);
  trials.End();
  const size_t trials_per_setting = experiment.reference.trials.names.size();
  WriteFile(folder / "rare_event.json", report::RareEventJson(event, options, trials_per_setting));
  return fmt::format("\nrare event: {}\n", report::RareEventSentence(event));
}

}  // namespace rift::commands
