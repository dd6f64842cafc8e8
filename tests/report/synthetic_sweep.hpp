#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "rift/report/figures/figures.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report::synthetic {

inline experiment::ParameterValue Word(const std::string& text) { return {text, {}}; }
inline experiment::ParameterValue Numeric(const std::string& text) {
  return {text, std::stod(text)};
}

/// A row whose gap is known beforehand.
inline sweep::TrialRow Row(experiment::Theta theta, std::string trial, double gap_m) {
  sweep::TrialRow row;
  row.theta = std::move(theta);
  row.trial = std::move(trial);
  row.comparison.gap_m = row.comparison.exact_gap_m = gap_m;
  row.comparison.gap_u = 0.75;
  row.comparison.start_aligned_gap_m = 0.8 * gap_m;
  row.comparison.shape_gap_m = 0.5 * gap_m;
  row.comparison.start_offset_m = 0.02;
  row.falsified = gap_m > 0.06;
  return row;
}

inline void LoseGap(sweep::TrialRow* row, const std::string& reason) {
  row->status = sweep::TrialStatus::kMissing;
  row->reason = reason;
  row->comparison = {};
  row->falsified = false;
}

/// 3 surfaces x 2 v_min x 2 v_max x 2 trials. The surface and only the surface matters; gaps are
/// 0.03, 0.05 and 0.07 m and the trials stand 4 mm beside them. The trial named in `Missing` has
/// no gap.
inline sweep::SweepResult Grid(const std::vector<std::string>& surfaces = {"ice", "sand_fine",
                                                                           "rock"}) {
  sweep::SweepResult result;
  result.name = "synthetic";
  result.candidate_kind = result.reference_kind = "logs";
  result.parameters = {{"terrain.surface", {}}, {"control.v_min", {}}, {"control.v_max", {}}};
  for (const std::string& surface : surfaces) result.parameters[0].levels.push_back(Word(surface));
  result.parameters[1].levels = {Numeric("0.15"), Numeric("0.20")};
  result.parameters[2].levels = {Numeric("0.30"), Numeric("0.50")};
  double mean_m = 0.03;
  for (const auto& surface : result.parameters[0].levels) {
    for (const auto& v_min : result.parameters[1].levels) {
      for (const auto& v_max : result.parameters[2].levels) {
        result.rows.push_back(Row({surface, v_min, v_max}, "1", mean_m - 0.004));
        result.rows.push_back(Row({surface, v_min, v_max}, "2", mean_m + 0.004));
      }
    }
    mean_m += 0.02;
  }
  LoseGap(&result.rows[1], "no file real2.csv");
  sweep::Summarise(result);
  for (sweep::SettingResult& setting : result.settings) setting.noise_floor_m = 0.02;
  return result;
}

/// n trials over one continuous parameter; the gap grows from 0.02 to 0.08 m along it.
inline sweep::SweepResult Continuous(int n) {
  sweep::SweepResult result;
  result.name = "continuous";
  result.candidate_kind = "simulation";
  result.reference_kind = "nominal";
  result.parameters = {{"friction", {}, 0.2, 0.8}, {"delay_s", {}, 0.0, 0.5}};
  for (int i = 0; i < n; ++i) {
    const double share = (i + 0.5) / n;
    const auto friction = Numeric(std::to_string(0.2 + 0.6 * share));
    const auto delay = Numeric(std::to_string(0.5 * std::fmod(share * 7.0, 1.0)));
    result.rows.push_back(Row({friction, delay}, "1", 0.02 + 0.06 * share));
  }
  sweep::Summarise(result);
  return result;
}

/// A straight simulated path, and a real one that bulges to the left by `bulge_m` in its middle.
inline trajectory::Trajectory Path(double bulge_m) {
  trajectory::Trajectory path;
  for (int i = 0; i <= 100; ++i) {
    trajectory::StampedPose pose;
    pose.t_s = 0.05 * i;
    pose.x_m = 0.01 * i;
    pose.y_m = bulge_m * std::sin(std::numbers::pi * i / 100.0);
    pose.target_x_m = i < 50 ? 0.5 : 1.0;
    pose.target_y_m = 0.0;
    path.poses.push_back(pose);
  }
  return path;
}

inline ComparedPair Pair(double bulge_m, const std::string& real_name = "real_1") {
  return ComparePair("sim", Path(0.0), real_name, Path(bulge_m), {});
}

}  // namespace rift::report::synthetic
