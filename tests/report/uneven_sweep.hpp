#pragma once

#include <fmt/format.h>

#include "synthetic_sweep.hpp"

/// Sweeps without symmetry, for what must not be exchanged.
namespace rift::report::synthetic {

/// No two numbers of it are alike, no axis is as long as another, the threshold is not the
/// default, repeats are uneven, and rows are missing in every way.
inline sweep::SweepResult Uneven() {
  sweep::SweepResult result;
  result.name = "uneven";
  result.candidate_kind = "simulation";
  result.reference_kind = "logs";
  result.gap.threshold_m = 0.045;
  result.gap.skip_start = 0.1;
  result.tag_offset_m = 0.03;
  result.parameters = {{"control.v_min", {Numeric("0.15"), Numeric("0.20"), Numeric("0.25")}},
                       {"terrain.surface", {Word("ground"), Word("parchment")}},
                       {"simulation.link.delay_s", {Numeric("0.02"), Numeric("0.07")}}};
  std::uint64_t path = 11;
  int n = 0;
  for (int v = 0; v < 3; ++v) {
    for (int s = 0; s < 2; ++s) {
      for (int d = 0; d < 2; ++d) {
        for (int trial = 1; trial <= 2 + (v + s) % 2; ++trial) {
          const double gap_m = 0.02 + 0.011 * v + 0.007 * s * s + 0.004 * d + 0.0013 * (++n % 7);
          sweep::TrialRow row = Row({result.parameters[0].levels[v], result.parameters[1].levels[s],
                                     result.parameters[2].levels[d]},
                                    std::to_string(trial), gap_m);
          gap::Comparison& c = row.comparison;
          c.gap_u = 0.3 + 0.013 * n;
          c.exact_gap_m = gap_m + 0.0001 * n;
          c.mean_error_m = 0.41 * gap_m;
          c.rms_error_m = 0.47 * gap_m;
          c.start_offset_m = 0.003 + 0.0002 * n;
          c.start_aligned_gap_m = (0.6 + 0.01 * n) * gap_m;
          c.shape_gap_m = (0.3 + 0.01 * n) * gap_m;
          c.frechet_m = (0.7 + 0.003 * n) * gap_m;
          c.equal_time_m = (1.3 + 0.02 * n) * gap_m;
          c.length_ratio = 1.02 + 0.001 * n;
          c.end_error_m = 0.011 + 0.0003 * n;
          row.way_gap_m = gap_m - 0.0021 * (n % 3);
          row.falsified = row.CountedGap_m() > result.gap.threshold_m;
          row.seed = 100 + static_cast<std::uint64_t>(n);
          row.candidate = fmt::format("sim/{}.csv", n);
          row.reference = fmt::format("real/{}.csv", n);
          row.evidence.fingerprint = path++;
          for (int k = 1; k <= 8; ++k) {
            row.evidence.errors_m.emplace_back(0.001 * k * v, 0.002 * k * (s == 0 ? 1 : -1));
          }
          result.rows.push_back(row);
        }
      }
    }
  }
  LoseGap(&result.rows[3], "no file \"real, 4.csv\"");
  sweep::TrialRow& fell = result.rows[8];
  fell.status = sweep::TrialStatus::kFell;
  fell.reason = "fell sideways at 2.5 s";
  fell.comparison = {};
  fell.evidence.errors_m.clear();
  fell.way_gap_m = gap::kNotComputed;
  fell.left_m = 0.37;
  fell.falsified = true;
  result.replaced = {{7, 9, "fell"}};
  result.judged_by = {.share = 0.2, .confidence = 0.9};
  sweep::Summarise(result);
  int i = 0;
  for (sweep::SettingResult& setting : result.settings) setting.noise_floor_m = 0.01 + 0.0011 * i++;
  return result;
}

/// A search: its worst setting, first evaluation and end, over ranges of different width.
inline sweep::SweepResult Searched() {
  sweep::SweepResult result = Continuous(40);
  result.gap.threshold_m = 0.07;
  result.parameters[0].settable = true;
  for (size_t i = 0; i < result.rows.size(); ++i) {
    result.rows[i].falsified = result.rows[i].comparison.gap_m > 0.07;
    result.rows[i].evidence.fingerprint = i + 1;
    result.rows[i].is_random_draw = i % 2 == 0;
  }
  sweep::Summarise(result);
  result.falsification = sweep::Falsification{.strategy = "cmaes",
                                              .verdict = gap::Verdict::kFalsified,
                                              .evaluations = 40,
                                              .budget = 64,
                                              .first_evaluation = 35,
                                              .worst_setting = 38,
                                              .ended = "the first falsified setting"};
  return result;
}

}  // namespace rift::report::synthetic
