#include "rift/sweep/calibrate/prediction.hpp"

#include <cmath>
#include <map>
#include <random>
#include <span>
#include <string>

#include "rift/gap/likeness.hpp"
#include "rift/statistics/bootstrap.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/rank_correlation.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// Places of the trials of each setting.
std::map<std::string, std::vector<size_t>> BySetting(const std::vector<RepeatedTrial>& trials) {
  std::map<std::string, std::vector<size_t>> places;
  for (size_t i = 0; i < trials.size(); ++i) places[trials[i].setting].push_back(i);
  return places;
}

/// The real trials that repeat the one at `judged`.
std::vector<Trajectory> OthersOf(const std::vector<RepeatedTrial>& trials,
                                 const std::vector<size_t>& setting, size_t judged) {
  std::vector<Trajectory> others = trials[judged].other_reals;
  for (const size_t i : setting) {
    if (i != judged) others.push_back(trials[i].real);
  }
  return others;
}

/// Sums over the pairs of one setting.
struct Pairs {
  double simulated_m = 0.0, other_real_m = 0.0, count = 0.0;

  void Add(const Pairs& more) {
    simulated_m += more.simulated_m, other_real_m += more.other_real_m, count += more.count;
  }
};

double MeanGap_m(const std::vector<Trajectory>& paths, const Trajectory& to,
                 const gap::GapOptions& gap) {
  std::vector<double> gaps_m;
  for (const Trajectory& path : paths) gaps_m.push_back(gap::Gap(path, to, gap));
  return statistics::Mean(gaps_m);
}

Pairs PairsOf(const std::vector<RepeatedTrial>& trials, const std::vector<size_t>& setting,
              const gap::GapOptions& gap, const gap::LikenessOptions& options) {
  Pairs pairs;
  for (const size_t i : setting) {
    const std::vector<Trajectory> others = OthersOf(trials, setting, i);
    if (others.empty() || trials[i].runs.empty()) continue;
    pairs.Add({gap::MeanPathGap_m(trials[i].real, trials[i].runs, gap, options),
               MeanGap_m(others, trials[i].real, gap), 1.0});
  }
  return pairs;
}

/// Straight lines between the waypoints.
Trajectory LinesOf(const std::vector<control::Waypoint>& waypoints) {
  Trajectory path;
  for (const control::Waypoint& waypoint : waypoints) {
    path.poses.push_back(
        {.t_s = static_cast<double>(path.poses.size()), .x_m = waypoint.x_m, .y_m = waypoint.y_m});
  }
  return path;
}

/// Gaps to the task over the settings that have all three.
struct RankedSettings {
  std::vector<double> judged_m, simulated_m, other_real_m;
};

RankedSettings RankedOf(const std::vector<RepeatedTrial>& trials, const gap::GapOptions& gap) {
  RankedSettings ranked;
  for (const auto& [name, setting] : BySetting(trials)) {
    const RepeatedTrial& judged = trials[setting.back()];
    const std::vector<Trajectory> others = OthersOf(trials, setting, setting.back());
    if (judged.waypoints.size() < 2 || judged.runs.empty() || others.empty()) continue;
    const Trajectory task = LinesOf(judged.waypoints);
    ranked.judged_m.push_back(gap::Gap(judged.real, task, gap));
    ranked.simulated_m.push_back(MeanGap_m(judged.runs, task, gap));
    ranked.other_real_m.push_back(MeanGap_m(others, task, gap));
  }
  return ranked;
}

statistics::Interval IntervalOf(const std::vector<double>& a, const std::vector<double>& b,
                                const statistics::BootstrapOptions& options, std::uint64_t seed) {
  const auto correlation = [&](std::span<const size_t> drawn) {
    std::vector<double> drawn_a, drawn_b;
    for (const size_t i : drawn) drawn_a.push_back(a[i]), drawn_b.push_back(b[i]);
    return statistics::RankCorrelation(drawn_a, drawn_b);
  };
  return statistics::BootstrapGroups(a.size(), correlation, options, seed);
}

}  // namespace

PathPrediction MeasurePrediction(const std::vector<RepeatedTrial>& trials,
                                 const gap::GapOptions& gap, const gap::LikenessOptions& options,
                                 std::uint64_t seed) {
  std::vector<Pairs> settings;
  Pairs all;
  for (const auto& [name, setting] : BySetting(trials)) {
    settings.push_back(PairsOf(trials, setting, gap, options));
    all.Add(settings.back());
  }
  if (all.count == 0.0) return {};
  const auto difference_m = [](const Pairs& of) {
    return (of.simulated_m - of.other_real_m) / of.count;
  };
  const auto of_drawn = [&](std::span<const size_t> drawn) {
    Pairs sum;
    for (const size_t i : drawn) sum.Add(settings[i]);
    return difference_m(sum);
  };
  return {.reals = static_cast<size_t>(all.count),
          .simulated_m = all.simulated_m / all.count,
          .other_real_m = all.other_real_m / all.count,
          .difference_m = difference_m(all),
          .difference_interval_m =
              statistics::BootstrapGroups(settings.size(), of_drawn, options.bootstrap, seed)};
}

RankAgreement MeasureRanks(const std::vector<RepeatedTrial>& trials, const gap::GapOptions& gap,
                           const gap::LikenessOptions& options, std::uint64_t seed) {
  const RankedSettings ranked = RankedOf(trials, gap);
  return {
      .settings = ranked.judged_m.size(),
      .simulated = statistics::RankCorrelation(ranked.judged_m, ranked.simulated_m),
      .simulated_interval =
          IntervalOf(ranked.judged_m, ranked.simulated_m, options.bootstrap, seed),
      .real = statistics::RankCorrelation(ranked.judged_m, ranked.other_real_m),
      .real_interval = IntervalOf(ranked.judged_m, ranked.other_real_m, options.bootstrap, seed)};
}

}  // namespace rift::sweep
