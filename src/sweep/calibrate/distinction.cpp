#include "rift/sweep/calibrate/distinction.hpp"

#include <cmath>
#include <map>
#include <string>

#include "rift/statistics/descriptive.hpp"

namespace rift::sweep {
namespace {

using statistics::Observation;
using statistics::TwoSampleTest;

std::vector<Observation> ObservationsOf(const std::vector<RepeatedTrial>& trials,
                                        const gap::LikenessOptions& options) {
  std::map<std::string, size_t> numbers;
  std::vector<Observation> observations;
  for (const RepeatedTrial& trial : trials) {
    const size_t group = numbers.try_emplace(trial.setting, numbers.size()).first->second;
    observations.push_back({FeaturesOf(trial.real, options), true, group});
    for (const trajectory::Trajectory& run : trial.runs) {
      observations.push_back({FeaturesOf(run, options), false, group});
    }
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
