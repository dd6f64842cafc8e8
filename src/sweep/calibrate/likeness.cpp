#include "rift/sweep/calibrate/likeness.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "rift/statistics/descriptive.hpp"

namespace rift::sweep {

namespace {

using trajectory::Trajectory;

/// Loop delays of the paths on one side.
struct Answers {
  std::vector<double> lags_s, r2, gains;

  void Add(const Trajectory& log, const RepeatedTrial& trial) {
    try {
      const trial::LoopDelay delay = trial::EstimateLoopDelay(log, trial.waypoints, trial.control);
      if (delay.lag_s < 0.0) return;
      lags_s.push_back(delay.lag_s);
      r2.push_back(delay.r2);
      gains.push_back(delay.gain_rad_s);
    } catch (const std::invalid_argument&) {
      // A path without yaw or with a handful of rows tells no delay, and may tell the rest.
    }
  }
};

}  // namespace

DriveLikeness MeasureDriveLikeness(const std::vector<RepeatedTrial>& trials, bool is_matched,
                                   const gap::GapOptions& gap, const gap::LikenessOptions& options,
                                   std::mt19937_64& generator) {
  DriveLikeness likeness;
  Answers sim, real;
  std::map<std::string, gap::RepeatedSetting> settings;
  const std::vector<RepeatedTrial> judged = WithoutDetours(trials, options.longest_run);
  for (const RepeatedTrial& trial : judged) {
    likeness.runs += static_cast<int>(trial.runs.size()) + trial.failed_runs;
    likeness.failed_runs += trial.failed_runs;
    likeness.circled_runs += trial.circled_runs;
    real.Add(trial.real, trial);
    gap::RepeatedSetting& setting = settings[trial.setting];
    setting.reals.push_back(trial.real);
    if (is_matched || setting.sims.empty()) setting.sims.emplace_back();
    for (const Trajectory& run : trial.runs) sim.Add(run, trial);
    setting.sims.back().insert(setting.sims.back().end(), trial.runs.begin(), trial.runs.end());
  }
  std::vector<gap::RepeatedSetting> in_order;
  for (auto& [name, setting] : settings) in_order.push_back(std::move(setting));
  likeness.path = gap::MeasureLikeness(in_order, gap, options, generator);
  likeness.loop_delay_s = {statistics::Median(sim.lags_s), statistics::Median(real.lags_s)};
  likeness.loop_r2 = {statistics::Median(sim.r2), statistics::Median(real.r2)};
  likeness.steering_gain_rad_s = {statistics::Median(sim.gains), statistics::Median(real.gains)};
  const std::uint64_t seed = generator();
  likeness.prediction = MeasurePrediction(judged, gap, options, seed);
  likeness.ranks = MeasureRanks(judged, gap, options, seed);
  likeness.told_apart = Distinguish(judged, options, seed);
  return likeness;
}

}  // namespace rift::sweep
