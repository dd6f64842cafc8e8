#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "rift/statistics/bootstrap_options.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/statistics/two_sample_options.hpp"

namespace rift::statistics {

/// One observation of two samples that are to be told apart.
struct Observation {
  std::vector<double> features;  ///< as many in each; NaN: not known, taken for the mean
  bool is_first = false;         ///< of the first sample, else of the second
  std::size_t group = 0;  ///< what belongs together, such as a setting: numbers from 0 upwards
};

/// What one feature has to do with it.
struct FeatureEvidence {
  std::size_t feature = 0;  ///< its place in Observation::features
  double accuracy = std::numeric_limits<double>::quiet_NaN();  ///< of a classifier of it alone
  Interval accuracy_interval;
  /// In the classifier of all features, for a standard deviation of it; positive: larger in the
  /// first sample.
  double weight = std::numeric_limits<double>::quiet_NaN();
};

/// How well a classifier tells the samples of groups that it was not trained on.
struct TwoSampleTest {
  std::size_t first = 0;   ///< observations of the first sample
  std::size_t second = 0;  ///< and of the second
  std::size_t groups = 0;
  /// Mean of the shares of both samples that are told right: 0.5 for guessing, 1 for all.
  double accuracy = std::numeric_limits<double>::quiet_NaN();
  Interval accuracy_interval{accuracy, accuracy};
  /// Share of the permutations of labels within the groups that give as much.
  double p = std::numeric_limits<double>::quiet_NaN();
  std::vector<FeatureEvidence> features;  ///< the one that tells most first
};

/// Classifier two-sample test (Lopez-Paz and Oquab 2017, "Revisiting classifier two-sample tests"):
/// logistic regression with a ridge penalty, each sample of the same weight, tried by
/// cross-validation with whole groups in a fold. Intervals: bootstrap over the groups, with the
/// classifiers as they are. Accuracies are NaN when a sample is empty or there are fewer than two
/// groups. Throws std::invalid_argument when observations have different numbers of features. The
/// same seed gives the same bytes.
TwoSampleTest TestTwoSamples(const std::vector<Observation>& observations,
                             const TwoSampleOptions& options, const BootstrapOptions& bootstrap,
                             std::uint64_t seed);

}  // namespace rift::statistics
