#include "rift/sweep/explain/anatomy.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/sweep/falsify/distinct_rows.hpp"

namespace rift::sweep {
namespace {

using OfTrial = std::function<double(const TrialRow&)>;

Estimate EstimateOf(const std::vector<double>& values) {
  const statistics::Interval interval = statistics::MeanInterval(values, 0.95);
  return {statistics::Mean(values), interval.low, interval.high, static_cast<int>(values.size())};
}

/// The settings with the rows that count (RowsThatCount), without those that have none: copies of
/// others.
std::vector<SettingResult> CountedSettings(const SweepResult& result) {
  std::vector<bool> counts(result.rows.size(), false);
  for (const int row : RowsThatCount(result)) counts[row] = true;
  std::vector<SettingResult> settings = result.settings;
  for (SettingResult& setting : settings) {
    std::erase_if(setting.rows, [&](int row) { return !counts[row]; });
  }
  std::erase_if(settings, [](const SettingResult& setting) { return setting.rows.empty(); });
  return settings;
}

class Averages {
 public:
  explicit Averages(const SweepResult& result)
      : result_(result), settings_(CountedSettings(result)) {
    const auto with_gap = std::count_if(settings_.begin(), settings_.end(), [&](const auto& one) {
      return std::isfinite(MeanGap_m(one));
    });
    is_over_settings_ = with_gap >= 3;
  }

  /// Repeats of a setting share its candidate, so it is settings that are independent.
  bool IsOverSettings() const { return is_over_settings_; }

  Estimate Over(const OfTrial& of_trial) const {
    std::vector<double> means, all;
    for (const SettingResult& setting : settings_) {
      const std::vector<double> values = ValuesIn(setting, of_trial);
      if (values.empty()) continue;
      means.push_back(statistics::Mean(values));
      all.insert(all.end(), values.begin(), values.end());
    }
    return EstimateOf(is_over_settings_ ? means : all);
  }

  Estimate OverSettings(const std::function<double(const SettingResult&)>& of_setting) const {
    std::vector<double> values;
    for (const SettingResult& setting : settings_) {
      const double value = of_setting(setting);
      if (std::isfinite(value)) values.push_back(value);
    }
    return EstimateOf(values);
  }

  double MeanGap_m(const SettingResult& setting) const {
    return statistics::Mean(
        ValuesIn(setting, [](const TrialRow& row) { return row.comparison.gap_m; }));
  }

 private:
  std::vector<double> ValuesIn(const SettingResult& setting, const OfTrial& of_trial) const {
    std::vector<double> values;
    for (const int row : setting.rows) {
      if (!result_.rows[row].IsOk()) continue;
      const double value = of_trial(result_.rows[row]);
      if (std::isfinite(value)) values.push_back(value);
    }
    return values;
  }

  const SweepResult& result_;
  std::vector<SettingResult> settings_;
  bool is_over_settings_ = false;
};

std::vector<GapPart> PartsOf(const SweepResult& result, const Anatomy& anatomy) {
  const bool is_robot = result.reference_kind == "logs";
  return {
      {"start placement", anatomy.start_m,
       "no fault of a simulator: start it where the reference stood (start: reference)"},
      {"frame", anatomy.frame_m,
       is_robot ? "heading at the start and the camera's frame; a simulator removes only what its "
                  "own first turn adds"
                : "heading at the start; a simulator removes what its own first turn adds"},
      {"shape", anatomy.shape_m,
       "drift and weave: a better simulator, down to what repeats differ among themselves"},
  };
}

}  // namespace

Anatomy Dissect(const SweepResult& result) {
  using gap::Comparison;
  const Averages averages(result);
  const auto over = [&](const std::function<double(const Comparison&)>& of_paths) {
    return averages.Over([&](const TrialRow& row) { return of_paths(row.comparison); });
  };
  Anatomy anatomy;
  anatomy.is_over_settings = averages.IsOverSettings();
  anatomy.gap_m = over([](const Comparison& c) { return c.gap_m; });
  anatomy.start_m = over([](const Comparison& c) { return c.gap_m - c.start_aligned_gap_m; });
  anatomy.frame_m = over([](const Comparison& c) { return c.start_aligned_gap_m - c.shape_gap_m; });
  anatomy.shape_m = over([](const Comparison& c) { return c.shape_gap_m; });
  anatomy.pace_m = over([](const Comparison& c) { return c.gap_m - c.frechet_m; });
  anatomy.timing_m = over([](const Comparison& c) { return c.equal_time_m - c.gap_m; });
  anatomy.goal_m =
      averages.Over([](const TrialRow& row) { return row.comparison.gap_m - row.way_gap_m; });
  anatomy.only_at_goal = static_cast<int>(
      std::count_if(result.rows.begin(), result.rows.end(), [&](const TrialRow& row) {
        return row.IsOk() && !row.falsified && row.comparison.gap_m > result.gap.threshold_m;
      }));
  anatomy.noise_m =
      averages.OverSettings([](const SettingResult& setting) { return setting.noise_floor_m; });
  anatomy.removable_m = averages.OverSettings([&](const SettingResult& setting) {
    return averages.MeanGap_m(setting) - setting.noise_floor_m;
  });
  anatomy.parts = PartsOf(result, anatomy);
  return anatomy;
}

}  // namespace rift::sweep
