#include "rift/statistics/two_sample.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "rift/statistics/random.hpp"

namespace rift::statistics {
namespace {

constexpr size_t kFeatures = 4;

/// Settings with two observations of the first sample and `second` of the other. Each setting moves
/// all its observations alike; `shift` (in standard deviations) moves feature 2 of the first.
std::vector<Observation> Drawn(size_t groups, int second, double shift, Random& random) {
  std::vector<Observation> observations;
  for (size_t group = 0; group < groups; ++group) {
    std::vector<double> of_group(kFeatures);
    for (double& value : of_group) value = random.Normal();
    for (int i = 0; i < 2 + second; ++i) {
      Observation one{.features = of_group, .is_first = i < 2, .group = group};
      for (double& value : one.features) value += random.Normal();
      one.features[2] += one.is_first ? shift : 0.0;
      observations.push_back(one);
    }
  }
  return observations;
}

TEST_CASE("Two samples of one distribution are told apart no better than by guessing") {
  Random random(1, 1);
  constexpr int kRounds = 200;
  int covered = 0, below_a_tenth = 0, below_a_half = 0;
  double sum = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const TwoSampleTest test = TestTwoSamples(Drawn(24, 6, 0.0, random), {.permutations = 19},
                                              {.resamples = 200}, static_cast<size_t>(round));
    covered += test.accuracy_interval.low <= 0.5 && 0.5 <= test.accuracy_interval.high;
    below_a_tenth += test.p <= 0.1;
    below_a_half += test.p <= 0.5;
    sum += test.accuracy;
  }
  CHECK(sum / kRounds == Approx(0.5).margin(0.02));
  CHECK(covered >= 0.85 * kRounds);
  // p is uniform: 20 and 100 expected, of which 4 standard deviations are 17 and 28.
  CHECK(below_a_tenth == Approx(20).margin(17));
  CHECK(below_a_half == Approx(100).margin(28));
}

TEST_CASE("Labels of groups of two are shuffled as well: samples that lie apart are told by them") {
  // One of each sample in each of ten groups: of 1024 ways to name them two tell all.
  std::vector<Observation> observations;
  for (size_t group = 0; group < 10; ++group) {
    for (const bool is_first : {true, false}) {
      const double place = 0.01 * static_cast<double>(group) + (is_first ? 1.0 : 0.0);
      observations.push_back({.features = {place}, .is_first = is_first, .group = group});
    }
  }
  const TwoSampleTest test =
      TestTwoSamples(observations, {.permutations = 99}, {.resamples = 50}, 1);
  CHECK(test.accuracy == 1.0);
  CHECK(test.p <= 0.03);
}

TEST_CASE("The labels of a seed are shuffled alike in every version of rift, one after the other") {
  // Each permutation as a test of its own, of the labels of the one before, shuffled in its groups.
  Random random(11, 1);
  const std::vector<Observation> observations = Drawn(5, 3, 0.7, random);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const TwoSampleTest test =
        TestTwoSamples(observations, {.permutations = 30}, {.resamples = 2}, seed);
    Random shuffles(seed, 72);
    std::vector<Observation> shuffled = observations;
    int as_large = 1;
    for (int permutation = 0; permutation < 30; ++permutation) {
      for (size_t group = 0; group < 5; ++group) {
        for (size_t i = 5; i > 1; --i) {
          const bool last = shuffled[5 * group + i - 1].is_first;
          const size_t other = 5 * group + shuffles.Below(i);
          shuffled[5 * group + i - 1].is_first = shuffled[other].is_first;
          shuffled[other].is_first = last;
        }
      }
      const TwoSampleTest one =
          TestTwoSamples(shuffled, {.permutations = 0}, {.resamples = 2}, seed);
      as_large += one.accuracy >= test.accuracy;
    }
    CAPTURE(seed, as_large);
    CHECK(test.p == Approx(as_large / 31.0));
    CHECK(as_large > 2);
    CHECK(as_large < 30);
  }
}

TEST_CASE("A difference in one feature is found and that feature is named") {
  Random random(2, 1);
  const TwoSampleTest test =
      TestTwoSamples(Drawn(24, 20, 3.0, random), {.permutations = 99}, {}, 1);
  CHECK(test.first == 48);
  CHECK(test.second == 480);
  CHECK(test.groups == 24);
  CHECK(test.accuracy > 0.8);
  CHECK(test.accuracy_interval.low > 0.7);
  CHECK(test.accuracy_interval.low < test.accuracy);
  CHECK(test.accuracy_interval.high > test.accuracy);
  CHECK(test.p == Approx(0.01));
  REQUIRE(test.features.size() == kFeatures);
  CHECK(test.features[0].feature == 2);
  CHECK(test.features[0].accuracy_interval.low > 0.5);
  CHECK(test.features[0].weight > 0.5);
  for (size_t i = 1; i < kFeatures; ++i) {
    INFO("feature " << test.features[i].feature);
    CHECK(test.features[i].accuracy < 0.65);
    CHECK(std::abs(test.features[i].weight) < 0.5 * test.features[0].weight);
  }
}

TEST_CASE("What only tells the settings apart tells nothing of settings not seen") {
  Random random(3, 1);
  std::vector<Observation> observations = Drawn(10, 2, 0.0, random);
  // A classifier that had seen the settings would know each by this.
  for (Observation& one : observations) one.features[0] = static_cast<double>(one.group);
  const TwoSampleTest test = TestTwoSamples(observations, {.permutations = 39}, {}, 1);
  CHECK(test.accuracy < 0.7);
  CHECK(test.p > 0.02);
}

TEST_CASE("Neither the unit of a feature nor what is not known changes what can be told") {
  Random random(4, 1);
  std::vector<Observation> observations = Drawn(16, 6, 6.0, random);
  const TwoSampleTest before = TestTwoSamples(observations, {.permutations = 0}, {}, 1);
  CHECK(std::isnan(before.p));
  for (Observation& one : observations) one.features[2] = 1e-6 * one.features[2] + 40.0;
  const TwoSampleTest scaled = TestTwoSamples(observations, {.permutations = 0}, {}, 1);
  CHECK(scaled.accuracy == Approx(before.accuracy));
  CHECK(scaled.features[0].weight == Approx(before.features[0].weight).epsilon(1e-3));
  for (Observation& one : observations) one.features[1] = NAN;
  CHECK(TestTwoSamples(observations, {.permutations = 0}, {}, 1).accuracy > 0.9);
  for (Observation& one : observations) one.features.assign(kFeatures, NAN);
  const TwoSampleTest unknown = TestTwoSamples(observations, {.permutations = 19}, {}, 1);
  CHECK(unknown.accuracy == 0.5);
  CHECK(unknown.p == 1.0);  // each permutation gives as much
}

TEST_CASE("Separable samples have finite weights and all are told") {
  Random random(5, 1);
  const TwoSampleTest test = TestTwoSamples(Drawn(8, 4, 50.0, random), {.permutations = 19}, {}, 1);
  CHECK(test.accuracy == 1.0);
  CHECK(std::isfinite(test.features[0].weight));
  CHECK(test.p == Approx(0.05));
}

TEST_CASE("A test of one sample or of one setting is not a number, and ragged rows are refused") {
  Random random(6, 1);
  std::vector<Observation> observations = Drawn(4, 2, 0.0, random);
  std::vector<Observation> one_setting(observations.begin(), observations.begin() + 4);
  CHECK(std::isnan(TestTwoSamples(one_setting, {}, {}, 1).accuracy));
  CHECK(std::isnan(TestTwoSamples({}, {}, {}, 1).accuracy_interval.low));
  for (Observation& one : observations) one.is_first = true;
  CHECK(std::isnan(TestTwoSamples(observations, {}, {}, 1).p));
  observations[1].features.pop_back();
  CHECK_THROWS_AS(TestTwoSamples(observations, {}, {}, 1), std::invalid_argument);
  CHECK_THROWS_WITH(TestTwoSamples(observations, {}, {}, 1),
                    "two samples: observation 1 has 3 features, and the first has 4");
}

TEST_CASE("The same seed gives the same test") {
  Random random(7, 1);
  const std::vector<Observation> observations = Drawn(8, 3, 0.5, random);
  const TwoSampleTest a = TestTwoSamples(observations, {.permutations = 19}, {}, 5);
  const TwoSampleTest b = TestTwoSamples(observations, {.permutations = 19}, {}, 5);
  const TwoSampleTest other = TestTwoSamples(observations, {.permutations = 19}, {}, 6);
  CHECK(a.accuracy == b.accuracy);
  CHECK(a.accuracy_interval.low == b.accuracy_interval.low);
  CHECK(a.p == b.p);
  CHECK(a.accuracy == other.accuracy);
}

TEST_CASE(
    "Every feature has its evidence, the one that tells first, and numbers of groups have gaps") {
  // Feature 1 tells all, 0 nothing, 2 the opposite way round; groups 0 and 5.
  std::vector<Observation> observations;
  for (const size_t group : {0, 5}) {
    for (int i = 0; i < 4; ++i) {
      const bool is_first = i < 2;
      observations.push_back(
          {.features = {double(i % 2), is_first ? 1.0 : 0.0, is_first ? -3.0 : 4.0},
           .is_first = is_first,
           .group = group});
    }
  }
  TwoSampleOptions options;
  options.permutations = 19;
  const TwoSampleTest test = TestTwoSamples(observations, options, {}, 1);
  CHECK(test.groups == 2);
  CHECK(test.first == 4);
  CHECK(test.second == 4);
  CHECK(test.accuracy == 1.0);
  CHECK(test.p >= 1.0 / 20.0);
  CHECK(test.p <= 1.0);
  REQUIRE(test.features.size() == 3);
  CHECK(test.features[0].feature == 1);
  CHECK(test.features[0].accuracy == 1.0);
  CHECK(test.features[0].weight > 0.0);
  CHECK(test.features[1].feature == 2);
  CHECK(test.features[1].accuracy == 1.0);
  CHECK(test.features[1].weight < 0.0);
  CHECK(test.features[2].feature == 0);
  CHECK(test.features[2].accuracy == Approx(0.5));
  options.permutations = 0;
  CHECK(std::isnan(TestTwoSamples(observations, options, {}, 1).p));
  CHECK(TestTwoSamples(observations, options, {}, 1).accuracy == 1.0);
}

TEST_CASE("One observation of the first sample among others is told") {
  std::vector<Observation> observations;
  for (size_t group = 0; group < 3; ++group) {
    observations.push_back({.features = {0.0}, .is_first = false, .group = group});
    observations.push_back({.features = {1.0}, .is_first = true, .group = group});
  }
  observations.resize(4);
  const TwoSampleTest test = TestTwoSamples(observations, {}, {}, 1);
  CHECK(test.first == 2);
  CHECK(test.accuracy == 1.0);
  std::erase_if(observations, [](const Observation& one) { return !one.is_first; });
  CHECK(std::isnan(TestTwoSamples(observations, {}, {}, 1).accuracy));
}

/// Two observations of the first sample and one of the second in each group; the first are at the
/// group's sign, the second at the other.
std::vector<Observation> Signed(const std::vector<double>& signs) {
  std::vector<Observation> observations;
  for (size_t group = 0; group < signs.size(); ++group) {
    for (int i = 0; i < 3; ++i) {
      observations.push_back(
          {.features = {i < 2 ? signs[group] : -signs[group]}, .is_first = i < 2, .group = group});
    }
  }
  return observations;
}

TEST_CASE(
    "Each group is told by a classifier that was trained on all the others, and on no other") {
  // Where the groups contradict each other, more of the others do so than agree.
  const auto accuracy = [](const std::vector<double>& signs, int folds) {
    return TestTwoSamples(Signed(signs), {.folds = folds, .permutations = 0}, {}, 1).accuracy;
  };
  CHECK(accuracy({1.0, -1.0, 1.0, -1.0}, 4) == 0.0);
  CHECK(accuracy({1.0, -1.0, 1.0, -1.0}, 2) == 0.0);  // groups 0 and 2 by those of 1 and 3
  CHECK(accuracy({1.0, 1.0, -1.0, -1.0, 1.0, 1.0}, 12) == Approx(4.0 / 6.0));
}

TEST_CASE("An accuracy is the mean of both samples' shares, however many each has") {
  std::vector<Observation> observations = Signed({1.0, 1.0, 1.0, 1.0});
  observations[0].features[0] = -1.0;  // one of eight of the first sample
  TwoSampleTest test = TestTwoSamples(observations, {.permutations = 0}, {}, 1);
  CHECK(test.accuracy == Approx(0.5 * (7.0 / 8.0 + 1.0)));
  CHECK(test.features[0].accuracy == test.accuracy);
  observations = Signed({1.0, 1.0, 1.0, 1.0});
  observations[2].features[0] = 1.0;  // one of four of the second
  test = TestTwoSamples(observations, {.permutations = 0}, {}, 1);
  CHECK(test.accuracy == Approx(0.5 * (1.0 + 3.0 / 4.0)));
}

TEST_CASE("What is tried by a classifier that saw one sample alone is guessed") {
  // In the second group there is one sample alone: it is told by the first, and not the first.
  for (const bool is_first : {true, false}) {
    const std::vector<Observation> observations{
        {.features = {1.0}, .is_first = is_first, .group = 0},
        {.features = {0.0}, .is_first = !is_first, .group = 0},
        {.features = {0.0}, .is_first = !is_first, .group = 1},
        {.features = {0.0}, .is_first = !is_first, .group = 1}};
    const TwoSampleTest test = TestTwoSamples(observations, {.permutations = 0}, {}, 1);
    CHECK(test.accuracy == Approx(0.5 * (0.5 + 2.5 / 3.0)));
    CHECK(test.first == (is_first ? 1 : 3));
    CHECK(test.second == (is_first ? 3 : 1));
  }
}

}  // namespace
}  // namespace rift::statistics
