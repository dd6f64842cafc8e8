#pragma once

#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// The settings of a sweep laid out as main factor x combination of all other parameters.
struct SettingGrid {
  std::string main_name;    ///< "surface"
  std::string others_name;  ///< "v_min, v_max"; empty for a single axis
  std::vector<sweep::LevelSummary> mains;
  /// Those of two parameters or more are named: "v_min 0.15, v_max 0.30". One unnamed entry for a
  /// single axis.
  std::vector<sweep::LevelSummary> others;
  /// [main][other]; null where the sweep holds no such setting; empty with a continuous axis,
  /// where no two settings share a value.
  std::vector<std::vector<const sweep::SettingResult*>> cells;

  int CellCount() const { return static_cast<int>(mains.size() * others.size()); }
};

SettingGrid LayOut(const sweep::SweepResult& result);

/// "ground, v_min 0.15, delay 0.2 s": values with their names and units, the main factor first.
std::string SettingLabel(const sweep::SweepResult& result, const experiment::Theta& theta);

/// Finite gaps of a setting's trials, in the order of its rows.
std::vector<double> GapsOf(const sweep::SweepResult& result, const sweep::SettingResult& setting);

/// Its trials without a gap.
int NotMeasured(const sweep::SweepResult& result, const sweep::SettingResult& setting);

}  // namespace rift::report
