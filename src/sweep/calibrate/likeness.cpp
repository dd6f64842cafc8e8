#include "rift/sweep/calibrate/likeness.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "rift/experiment/parameter.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/sweep/falsify/grid.hpp"
#include "rift/sweep/falsify/result.hpp"

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

double LengthByStrides_m(const Trajectory& path) {
  constexpr double kStride_m = 0.02;
  double length_m = 0.0;
  Eigen::Vector2d last = path.poses.front().Position();
  for (const trajectory::StampedPose& pose : path.poses) {
    const double moved_m = (pose.Position() - last).norm();
    if (moved_m < kStride_m) continue;
    length_m += moved_m;
    last = pose.Position();
  }
  return length_m;
}

std::vector<RepeatedTrial> WithoutDetours(std::vector<RepeatedTrial> trials, double longest_run) {
  const auto longest_m = LongestBySetting_m(trials, &RepeatedTrial::real);
  for (RepeatedTrial& trial : trials) {
    const double limit_m = longest_run * longest_m.at(trial.setting);
    const auto is_detour = [&](const Trajectory& run) { return LengthByStrides_m(run) > limit_m; };
    trial.failed_runs += static_cast<int>(std::erase_if(trial.runs, is_detour));
  }
  return trials;
}

DriveLikeness MeasureDriveLikeness(const std::vector<RepeatedTrial>& trials, bool is_matched,
                                   const gap::GapOptions& gap, const gap::LikenessOptions& options,
                                   std::mt19937_64& generator) {
  DriveLikeness likeness;
  Answers sim, real;
  std::map<std::string, gap::RepeatedSetting> settings;
  for (const RepeatedTrial& trial : WithoutDetours(trials, options.longest_run)) {
    likeness.failed_runs += trial.failed_runs;
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
  return likeness;
}

namespace {

struct Labelled {
  std::string level;
  RepeatedTrial trial;
};

bool HasRepeatedLogs(const experiment::Experiment& experiment) {
  const auto& parameters = experiment.space.parameters;
  return experiment.reference.kind == experiment::ReferenceKind::kLogs &&
         experiment.reference.trials.names.size() > 1 &&
         std::none_of(parameters.begin(), parameters.end(),
                      [](const experiment::Parameter& axis) { return axis.IsContinuous(); });
}

/// The trials of one setting. A candidate log that serves all repeats is one run, not several.
void AddSetting(Evaluator& evaluator, const experiment::Theta& theta,
                std::vector<Labelled>& trials) {
  const experiment::Experiment& experiment = evaluator.experiment();
  const bool is_simulated = experiment.candidate.kind == experiment::CandidateKind::kSimulation;
  const experiment::Experiment at =
      is_simulated ? experiment::ExperimentAt(experiment, theta) : experiment;
  std::set<std::string> logs;
  for (const TrialRequest& request : TrialsAt(experiment, theta)) {
    const Recording real = evaluator.Reference(request);
    if (real.status != TrialStatus::kOk) continue;
    Labelled labelled{MainLevel(experiment.space.parameters, theta),
                      {.setting = SettingKey(experiment.space.parameters, theta),
                       .real = real.trajectory,
                       .waypoints = at.waypoints,
                       .control = at.control}};
    Recording run = evaluator.Candidate(request, real);
    const bool is_new = is_simulated || logs.insert(run.source).second;
    if (run.status != TrialStatus::kOk) {
      ++labelled.trial.failed_runs;
    } else if (is_new) {
      labelled.trial.runs.push_back(std::move(run.trajectory));
    }
    trials.push_back(std::move(labelled));
  }
}

}  // namespace

std::vector<GroupLikeness> MeasureSweepLikeness(Evaluator& evaluator) {
  const experiment::Experiment& experiment = evaluator.experiment();
  if (!HasRepeatedLogs(experiment)) return {};
  std::vector<Labelled> trials;
  for (const experiment::Theta& theta : experiment::GridPoints(experiment.space.parameters)) {
    AddSetting(evaluator, theta, trials);
  }
  std::vector<std::string> levels;
  for (const Labelled& trial : trials) {
    if (std::find(levels.begin(), levels.end(), trial.level) == levels.end()) {
      levels.push_back(trial.level);
    }
  }
  levels.push_back("all");
  const bool is_matched = experiment.start == experiment::Start::kReference;
  std::vector<GroupLikeness> rows;
  for (const std::string& level : levels) {
    const bool is_all = &level == &levels.back();
    std::vector<RepeatedTrial> group;
    for (const Labelled& trial : trials) {
      if (is_all || trial.level == level) group.push_back(trial.trial);
    }
    std::mt19937_64 generator(experiment.seed);
    rows.push_back({level, MeasureDriveLikeness(group, is_matched, experiment.gap,
                                                experiment.likeness, generator)});
  }
  return rows;
}

}  // namespace rift::sweep
