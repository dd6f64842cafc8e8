#include "rift/statistics/two_sample.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "logistic.hpp"
#include "rift/statistics/bootstrap.hpp"
#include "rift/statistics/random.hpp"

namespace rift::statistics {
namespace {

constexpr std::uint64_t kPermutations = 72;
/// A score nearer to zero is rounding, as of a feature that is constant.
constexpr double kLeastScore = 1e-9;

/// The observations as matrices, with the rows of each group.
struct Samples {
  Eigen::MatrixXd features;
  Eigen::VectorXd is_first;
  std::vector<std::vector<Eigen::Index>> groups;  ///< those that have a row

  bool CanBeTold() const {
    const double first = is_first.sum();
    return groups.size() >= 2 && first > 0.0 && first < static_cast<double>(is_first.size());
  }
};

Samples SamplesOf(const std::vector<Observation>& observations) {
  const size_t columns = observations.empty() ? 0 : observations.front().features.size();
  Samples samples{.features = Eigen::MatrixXd(observations.size(), columns),
                  .is_first = Eigen::VectorXd(observations.size())};
  for (size_t i = 0; i < observations.size(); ++i) {
    const Observation& observation = observations[i];
    if (observation.features.size() != columns) {
      throw std::invalid_argument(
          fmt::format("two samples: observation {} has {} features, and the first has {}", i,
                      observation.features.size(), columns));
    }
    const auto row = static_cast<Eigen::Index>(i);
    samples.features.row(row) = Eigen::Map<const Eigen::RowVectorXd>(
        observation.features.data(), static_cast<Eigen::Index>(columns));
    samples.is_first[row] = observation.is_first ? 1.0 : 0.0;
    if (observation.group >= samples.groups.size()) samples.groups.resize(observation.group + 1);
    samples.groups[observation.group].push_back(row);
  }
  std::erase_if(samples.groups, [](const auto& rows) { return rows.empty(); });
  return samples;
}

/// Rows of the groups that are in this fold, and of those that are not.
struct Split {
  std::vector<Eigen::Index> tried, trained;
};

std::vector<Split> SplitsOf(const Samples& samples, int most_folds) {
  const size_t folds = std::min(samples.groups.size(), static_cast<size_t>(most_folds));
  std::vector<Split> splits(folds);
  for (size_t group = 0; group < samples.groups.size(); ++group) {
    for (size_t fold = 0; fold < folds; ++fold) {
      std::vector<Eigen::Index>& rows =
          group % folds == fold ? splits[fold].tried : splits[fold].trained;
      rows.insert(rows.end(), samples.groups[group].begin(), samples.groups[group].end());
    }
  }
  return splits;
}

/// 1 for each row that was told right by a classifier trained on other groups, 0.5 for a guess.
Eigen::VectorXd ToldRight(const Eigen::MatrixXd& features, const Eigen::VectorXd& is_first,
                          const std::vector<Split>& splits, double ridge) {
  Eigen::VectorXd right = Eigen::VectorXd::Constant(is_first.size(), 0.5);
  for (const Split& split : splits) {
    const Eigen::VectorXd labels = is_first(split.trained);
    const double first = labels.sum();
    if (first == 0.0 || first == static_cast<double>(labels.size())) continue;
    const LogisticModel model = FitLogistic(features(split.trained, Eigen::all), labels, ridge);
    const Eigen::VectorXd scores = model.Scores(features(split.tried, Eigen::all));
    for (Eigen::Index i = 0; i < scores.size(); ++i) {
      const Eigen::Index row = split.tried[static_cast<size_t>(i)];
      if (std::abs(scores[i]) < kLeastScore) continue;
      right[row] = (scores[i] > 0.0) == (is_first[row] > 0.5) ? 1.0 : 0.0;
    }
  }
  return right;
}

/// Sums of what was told right of both samples.
struct Tally {
  double right_first = 0.0, first = 0.0, right_second = 0.0, second = 0.0;

  void Add(const Tally& other) {
    right_first += other.right_first, first += other.first;
    right_second += other.right_second, second += other.second;
  }
  /// NaN without observations of both.
  double Accuracy() const { return 0.5 * (right_first / first + right_second / second); }
};

std::vector<Tally> TallyByGroup(const Samples& samples, const Eigen::VectorXd& right) {
  std::vector<Tally> tallies;
  for (const std::vector<Eigen::Index>& rows : samples.groups) {
    Tally& tally = tallies.emplace_back();
    for (const Eigen::Index row : rows) {
      const double is_first = samples.is_first[row];
      tally.right_first += is_first * right[row], tally.first += is_first;
      tally.right_second += (1.0 - is_first) * right[row], tally.second += 1.0 - is_first;
    }
  }
  return tallies;
}

double AccuracyOf(const std::vector<Tally>& tallies) {
  Tally all;
  for (const Tally& tally : tallies) all.Add(tally);
  return all.Accuracy();
}

Interval IntervalOf(const std::vector<Tally>& tallies, const BootstrapOptions& options,
                    std::uint64_t seed) {
  const auto accuracy = [&](std::span<const size_t> drawn) {
    Tally all;
    for (const size_t group : drawn) all.Add(tallies[group]);
    return all.Accuracy();
  };
  return BootstrapGroups(tallies.size(), accuracy, options, seed);
}

/// Labels shuffled within each group (Fisher and Yates).
Eigen::VectorXd Shuffled(const Samples& samples, Random& random) {
  Eigen::VectorXd labels = samples.is_first;
  for (const std::vector<Eigen::Index>& rows : samples.groups) {
    for (size_t i = rows.size(); i > 1; --i) {
      std::swap(labels[rows[i - 1]], labels[rows[random.Below(i)]]);
    }
  }
  return labels;
}

/// The measured labels are one of the permutations [Phipson and Smyth 2010].
double PermutationP(Samples samples, const std::vector<Split>& splits, double accuracy,
                    const TwoSampleOptions& options, std::uint64_t seed) {
  if (options.permutations == 0) return std::numeric_limits<double>::quiet_NaN();
  Random random(seed, kPermutations);
  int as_large = 1;
  for (int i = 0; i < options.permutations; ++i) {
    samples.is_first = Shuffled(samples, random);
    const Eigen::VectorXd right =
        ToldRight(samples.features, samples.is_first, splits, options.ridge);
    as_large += AccuracyOf(TallyByGroup(samples, right)) >= accuracy;
  }
  return as_large / (options.permutations + 1.0);
}

std::vector<FeatureEvidence> EvidenceOf(const Samples& samples, const std::vector<Split>& splits,
                                        const TwoSampleOptions& options,
                                        const BootstrapOptions& bootstrap, std::uint64_t seed) {
  const LogisticModel all = FitLogistic(samples.features, samples.is_first, options.ridge);
  std::vector<FeatureEvidence> features;
  for (Eigen::Index k = 0; k < samples.features.cols(); ++k) {
    const std::vector<Tally> tallies = TallyByGroup(
        samples, ToldRight(samples.features.col(k), samples.is_first, splits, options.ridge));
    features.push_back({.feature = static_cast<size_t>(k),
                        .accuracy = AccuracyOf(tallies),
                        .accuracy_interval = IntervalOf(tallies, bootstrap, seed),
                        .weight = all.weights[k]});
  }
  std::stable_sort(features.begin(), features.end(),
                   [](const auto& a, const auto& b) { return a.accuracy > b.accuracy; });
  return features;
}

}  // namespace

TwoSampleTest TestTwoSamples(const std::vector<Observation>& observations,
                             const TwoSampleOptions& options, const BootstrapOptions& bootstrap,
                             std::uint64_t seed) {
  const Samples samples = SamplesOf(observations);
  TwoSampleTest test;
  test.first = static_cast<size_t>(samples.is_first.sum());
  test.second = observations.size() - test.first;
  test.groups = samples.groups.size();
  if (!samples.CanBeTold()) return test;
  const std::vector<Split> splits = SplitsOf(samples, options.folds);
  const std::vector<Tally> tallies =
      TallyByGroup(samples, ToldRight(samples.features, samples.is_first, splits, options.ridge));
  test.accuracy = AccuracyOf(tallies);
  test.accuracy_interval = IntervalOf(tallies, bootstrap, seed);
  test.p = PermutationP(samples, splits, test.accuracy, options, seed);
  test.features = EvidenceOf(samples, splits, options, bootstrap, seed);
  return test;
}

}  // namespace rift::statistics
