#include "identification/trial_grid.hpp"

#include <filesystem>

namespace rift::test {
namespace {

constexpr double kFrontAheadOfTag_m = 0.03;  // as in the published gaps

std::string Stem(const std::string& v_min, const std::string& v_max) {
  return "vmin" + v_min + "_vmax" + v_max;
}

}  // namespace

std::vector<GridTrial> LoadTrialGrid(const GridStudy& study, int only) {
  std::vector<GridTrial> trials;
  for (const char* surface : {"ground", "cardboard", "parchment", "downhill", "bump"}) {
    for (const char* v_min : {"0.15", "0.20"}) {
      for (const char* v_max : {"0.30", "0.40", "0.50"}) {
        for (int number = 1; number <= 9; ++number) {
          const std::filesystem::path folder = TrialsFolder() / surface;
          const std::string stem = Stem(v_min, v_max);
          const auto real = folder / (stem + "_real" + std::to_string(number) + ".csv");
          if ((only != 0 && number != only) || !std::filesystem::exists(real)) continue;
          GridTrial trial{.surface = surface,
                          .setting = surface + ("/" + stem),
                          .trial = number,
                          .control = study.control};
          trial.control.v_min = std::stod(v_min);
          trial.control.v_max = std::stod(v_max);
          trial.real = LoadTrajectory(real, trajectory::Format::kTracker);
          const auto webots = folder / (stem + "_webots.csv");
          if (std::filesystem::exists(webots)) {
            trial.webots = LoadTrajectory(webots, trajectory::Format::kWebots);
          }
          trials.push_back(std::move(trial));
        }
      }
    }
  }
  return trials;
}

sweep::SimulatedTrial TwinOf(const GridStudy& study, const GridTrial& trial, std::uint64_t seed) {
  simulation::SimulationOptions simulation = study.simulation;
  simulation.terrain.surface = trial.surface;
  return {.task = study.waypoints,
          .control = trial.control,
          .trial = study.trial,
          .simulation = simulation,
          .start = sweep::StartFromLog(trial.real, 0.0, simulation.mocap),
          .seed = seed};
}

std::vector<sweep::RepeatedTrial> DriveGrid(const GridStudy& study,
                                            const std::vector<GridTrial>& trials, int runs) {
  std::vector<sweep::RepeatedTrial> driven;
  std::uint64_t number = 0;
  for (const GridTrial& trial : trials) {
    sweep::RepeatedTrial repeated{.setting = trial.setting,
                                  .real = trial.real,
                                  .waypoints = study.waypoints,
                                  .control = trial.control};
    ++number;
    for (int run = 1; run <= runs; ++run) {
      sweep::SimulatedRun result = sweep::Simulate(TwinOf(study, trial, 1000 * number + run));
      if (result.result.outcome == trial::Outcome::kReached) {
        repeated.runs.push_back(std::move(result.result.trajectory));
      } else {
        ++repeated.failed_runs;
      }
    }
    driven.push_back(std::move(repeated));
  }
  return driven;
}

std::vector<sweep::RepeatedTrial> WebotsGrid(const std::vector<GridTrial>& trials) {
  std::vector<sweep::RepeatedTrial> pairs;
  for (const GridTrial& trial : trials) {
    if (trial.webots.poses.empty()) continue;
    const bool is_new = pairs.empty() || pairs.back().setting != trial.setting;
    pairs.push_back({.setting = trial.setting,
                     .real = trajectory::OffsetAlongHeading(trial.real, kFrontAheadOfTag_m),
                     .control = trial.control});
    if (is_new) pairs.back().runs.push_back(trial.webots);
  }
  return pairs;
}

}  // namespace rift::test
