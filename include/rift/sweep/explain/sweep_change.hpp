#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "rift/experiment/parameter.hpp"
#include "rift/statistics/inference.hpp"

namespace rift::sweep {

inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// A trial as table.csv holds it.
struct TabledTrial {
  std::string key;      ///< of its setting: SettingKey
  std::string setting;  ///< the same for people
  std::string trial;
  bool is_told = false;  ///< it fails or it does not
  bool falsified = false;
  double gap_m = kNotKnown;
  experiment::Theta theta{};
};

/// A finished sweep as its folder tells of it.
struct TabledSweep {
  std::string folder;
  std::vector<TabledTrial> trials;
  std::map<std::string, std::string> verdicts;  ///< by key of the setting
};

struct ChangedSide {
  int failures = 0;
  int told = 0;
  double mean_gap_m = kNotKnown;  ///< of the trials with a gap
  std::string verdict;            ///< empty for several settings
};

/// A setting, or all of them, in two sweeps.
struct SettingChange {
  std::string setting;
  ChangedSide before, after;
  int pairs = 0;  ///< trials with a gap in both: of one name the first of each, the second, ...
  double gap_change_m = kNotKnown;  ///< mean of after - before over the pairs
  statistics::Interval gap_change_95_m{kNotKnown, kNotKnown};
};

/// A key of the experiment that is not the same in both.
struct ChangedKey {
  std::string key, before, after;
};

/// Two sweeps over the same space: before and after a calibration, or any other change.
struct SweepChange {
  std::string before, after;  ///< their folders
  std::vector<ChangedKey> keys;
  std::vector<SettingChange> settings;  ///< those of both, the largest change of failures first
  int only_before = 0;                  ///< settings that the other does not have
  int only_after = 0;
  /// Over the settings of both; the interval of the change of the mean gap is over settings where
  /// several have pairs, else over trials (Student). Settings that differ in one parameter and
  /// whose trials agree to the last bit in both sweeps are one there: it does nothing.
  SettingChange all;
  bool is_over_settings = false;
  /// Trials that failed before and hold after; of a setting whose repeats are one run in both
  /// sweeps one, and of settings that are copies those of the first.
  int now_hold = 0;
  int now_fail = 0;
  int copies = 0;  ///< that changed and are in neither of these
  /// 95 % (Clopper-Pearson) for the share of now_hold in the trials that changed: above a half, it
  /// became better, below worse.
  statistics::Interval better_share_95;
};

/// Throws std::invalid_argument when they have no setting in common.
SweepChange CompareSweeps(const TabledSweep& before, const TabledSweep& after,
                          std::vector<ChangedKey> keys);

}  // namespace rift::sweep
