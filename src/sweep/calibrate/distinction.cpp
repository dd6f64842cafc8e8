#include "rift/sweep/calibrate/distinction.hpp"

#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/falsify/copy_sets.hpp"

namespace rift::sweep {
namespace {

using statistics::Observation;
using statistics::TwoSampleTest;

/// The same for paths with the same rows.
std::uint64_t KeyOf(const trajectory::Trajectory& path) {
  std::vector<double> numbers;
  for (const trajectory::StampedPose& pose : path.poses) {
    numbers.insert(numbers.end(), {pose.t_s, pose.x_m, pose.y_m});
  }
  return statistics::Hash64(std::as_bytes(std::span<const double>(numbers)));
}

/// Of each trial, counted from 0: its setting with all that have a path in common with it, as those
/// have that differ in what no log names. A classifier trained on one of them has seen the others'.
std::vector<size_t> GroupsOf(const std::vector<RepeatedTrial>& trials) {
  std::map<std::string, size_t> first_of_setting;
  std::map<std::uint64_t, size_t> first_with_path;
  CopySets sets(trials.size());
  for (size_t i = 0; i < trials.size(); ++i) {
    const auto join_with_first = [&](const trajectory::Trajectory& path) {
      sets.Join(i, first_with_path.try_emplace(KeyOf(path), i).first->second);
    };
    sets.Join(i, first_of_setting.try_emplace(trials[i].setting, i).first->second);
    join_with_first(trials[i].real);
    for (const trajectory::Trajectory& run : trials[i].runs) join_with_first(run);
  }
  std::map<size_t, size_t> numbers;
  std::vector<size_t> groups;
  for (size_t i = 0; i < trials.size(); ++i) {
    groups.push_back(numbers.try_emplace(sets.FirstOf(i), numbers.size()).first->second);
  }
  return groups;
}

/// Each path of a side once, however many trials have it: labels of copies cannot be shuffled.
std::vector<Observation> ObservationsOf(const std::vector<RepeatedTrial>& trials,
                                        const gap::LikenessOptions& options) {
  const std::vector<size_t> groups = GroupsOf(trials);
  std::set<std::pair<bool, std::uint64_t>> seen;
  std::vector<Observation> observations;
  for (size_t i = 0; i < trials.size(); ++i) {
    const auto add = [&](const trajectory::Trajectory& path, bool is_real) {
      if (!seen.insert({is_real, KeyOf(path)}).second) return;
      observations.push_back({FeaturesOf(path, options), is_real, groups[i]});
    };
    add(trials[i].real, true);
    for (const trajectory::Trajectory& run : trials[i].runs) add(run, false);
  }
  return observations;
}

/// The test by the features at these places.
TwoSampleTest TestBy(const std::vector<size_t>& places, std::vector<Observation> observations,
                     const gap::LikenessOptions& options, std::uint64_t seed) {
  for (Observation& observation : observations) {
    std::vector<double> chosen;
    for (const size_t place : places) chosen.push_back(observation.features[place]);
    observation.features = std::move(chosen);
  }
  TwoSampleTest test =
      statistics::TestTwoSamples(observations, options.classifier, options.bootstrap, seed);
  for (statistics::FeatureEvidence& evidence : test.features) {
    evidence.feature = places[evidence.feature];
  }
  return test;
}

FeatureSummary SummaryOf(const std::vector<Observation>& observations, size_t place) {
  std::vector<double> sim, real;
  for (const Observation& observation : observations) {
    const double value = observation.features[place];
    if (!std::isnan(value)) (observation.is_first ? real : sim).push_back(value);
  }
  return {{statistics::Mean(sim), statistics::Mean(real)},
          {statistics::StandardDeviation(sim), statistics::StandardDeviation(real)}};
}

}  // namespace

Distinction Distinguish(const std::vector<RepeatedTrial>& trials,
                        const gap::LikenessOptions& options, std::uint64_t seed) {
  const std::vector<Observation> observations = ObservationsOf(trials, options);
  std::vector<size_t> all, without_timing;
  Distinction distinction;
  for (size_t place = 0; place < DriveFeatures().size(); ++place) {
    all.push_back(place);
    if (!DriveFeatures()[place].is_timing) without_timing.push_back(place);
    distinction.features.push_back(SummaryOf(observations, place));
  }
  distinction.all = TestBy(all, observations, options, seed);
  distinction.without_timing = TestBy(without_timing, observations, options, seed);
  return distinction;
}

}  // namespace rift::sweep
