#include "rare_event_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "files.hpp"
#include "rift/report/json/sweep.hpp"
#include "rift/report/text/sweep.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/falsify/falsify.hpp"
#include "rift/sweep/falsify/grid.hpp"
#include "rift/sweep/falsify/search_space.hpp"

namespace rift::commands {
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
