#pragma once

#include <cstdint>
#include <vector>

#include "rift/gap/likeness.hpp"
#include "rift/gap/options.hpp"
#include "rift/statistics/two_sample.hpp"
#include "rift/sweep/calibrate/drive_features.hpp"
#include "rift/sweep/calibrate/repeated_trial.hpp"

namespace rift::sweep {

/// A feature over the logs of both sides that tell it.
struct FeatureSummary {
  gap::BothSides mean;
  gap::BothSides sd;
};

/// Whether a small classifier tells simulated from real logs of settings that it was not trained
/// on, and by what: 0.5 says that it cannot. Places of features are those in DriveFeatures().
struct Distinction {
  statistics::TwoSampleTest all;             ///< by every feature
  statistics::TwoSampleTest without_timing;  ///< by those that look at no time stamps
  std::vector<FeatureSummary> features;      ///< one for each of DriveFeatures()
};

/// Settings are the groups of statistics::TestTwoSamples, those that share a log or a run together
/// one; real logs are its first sample.
Distinction Distinguish(const std::vector<RepeatedTrial>& trials,
                        const gap::LikenessOptions& options, std::uint64_t seed);

}  // namespace rift::sweep
