#pragma once

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "rift/sweep/explain/explanation.hpp"
#include "synthetic_sweep.hpp"

/// Sweeps of different kinds, with everything that a report may have to say.
namespace rift::report::synthetic {

struct Kind {
  std::string name;
  sweep::SweepResult result;
  std::vector<sweep::RobotTrials> robot = {};
};

/// 3 surfaces x 2 v_min x 2 v_max x 4 runs with a loss of any kind.
inline sweep::SweepResult RepeatedGrid(
    const std::function<double(int surface, int v_min, int v_max, double noise)>& gap_m,
    const std::string& reference = "nominal") {
  sweep::SweepResult result = synthetic::Grid();
  result.reference_kind = reference;
  result.candidate_kind = "simulation";
  result.rows.clear();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::uint64_t path = 1;
  for (int s = 0; s < 3; ++s) {
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) {
        for (int trial = 1; trial <= 4; ++trial) {
          sweep::TrialRow row = synthetic::Row(
              {result.parameters[0].levels[s], result.parameters[1].levels[a],
               result.parameters[2].levels[b]},
              std::to_string(trial), std::max(0.001, gap_m(s, a, b, normal(random))));
          row.seed = static_cast<std::uint64_t>(trial);
          row.evidence.fingerprint = path++;
          result.rows.push_back(row);
        }
      }
    }
  }
  sweep::Summarise(result);
  return result;
}

inline sweep::SweepResult WithLost() {
  sweep::SweepResult result =
      RepeatedGrid([](int s, int, int, double n) { return 0.03 + 0.01 * s + 0.004 * n; });
  for (size_t i = 0; i < result.rows.size(); i += 3) {
    sweep::TrialRow& row = result.rows[i];
    if (i % 2 == 0) {
      synthetic::LoseGap(&row, "no file");
      continue;
    }
    row.status = sweep::TrialStatus::kTimedOut;
    row.comparison = {};
    row.falsified = true;
    row.left_m = 0.2;
  }
  sweep::Summarise(result);
  return result;
}

/// v_max never changes a run.
inline sweep::SweepResult WithInert() {
  sweep::SweepResult result =
      RepeatedGrid([](int s, int a, int, double) { return 0.03 + 0.02 * s + 0.01 * a; });
  for (sweep::TrialRow& row : result.rows) {
    row.evidence.fingerprint =
        static_cast<std::uint64_t>(1e6 * row.comparison.gap_m) * 10 + *row.seed;
  }
  sweep::Summarise(result);
  return result;
}

inline sweep::SweepResult OnlyAtTheGoal() {
  sweep::SweepResult result =
      RepeatedGrid([](int, int, int, double n) { return 0.065 + 0.002 * n; });
  for (sweep::TrialRow& row : result.rows) {
    row.way_gap_m = 0.03;
    row.falsified = false;
  }
  sweep::Summarise(result);
  return result;
}

inline std::vector<Kind> Kinds() {
  sweep::SweepResult noisy =
      RepeatedGrid([](int, int, int, double n) { return 0.055 + 0.02 * n; }, "logs");
  for (sweep::SettingResult& setting : noisy.settings) setting.noise_floor_m = 0.055;
  sweep::SweepResult nothing = synthetic::Grid();
  for (sweep::TrialRow& row : nothing.rows) synthetic::LoseGap(&row, "gone");
  sweep::Summarise(nothing);
  Kind driven{"a search whose predictions were driven", synthetic::Continuous(200)};
  driven.result.parameters[0].settable = true;
  sweep::Summarise(driven.result);
  driven.robot = {{{experiment::NumberValue(0.7)}, true, 3, 3},
                  {{experiment::NumberValue(0.75)}, true, 3, 0}};
  return {{"a grid over logs", synthetic::Grid()},
          {"a grid that holds",
           RepeatedGrid([](int s, int, int, double n) { return 0.02 + 0.005 * s + 0.002 * n; })},
          {"a grid that always fails",
           RepeatedGrid([](int, int, int, double n) { return 0.1 + 0.002 * n; })},
          {"without a gap", nothing},
          {"ranges", synthetic::Continuous(300)},
          {"two parameters that act together", RepeatedGrid([](int s, int a, int, double n) {
             return 0.05 + 0.02 * (s - 1) * (a == 0 ? 1.0 : -1.0) + 0.002 * n;
           })},
          {"lost trials and such as do not arrive", WithLost()},
          {"an inert parameter", WithInert()},
          {"above the threshold at the goal alone", OnlyAtTheGoal()},
          {"as far from the robot as the robot from itself", noisy},
          driven};
}

}  // namespace rift::report::synthetic
