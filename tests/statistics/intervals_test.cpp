#include "rift/statistics/inference.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "rift/statistics/descriptive.hpp"

namespace rift::statistics {
namespace {

TEST_CASE("Means and standard deviations are those of the textbook") {
  const std::vector<double> values{2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0};
  CHECK(Mean(values) == 5.0);
  CHECK(StandardDeviation(values) == Approx(std::sqrt(32.0 / 7.0)));
  CHECK(StandardError(values) == Approx(std::sqrt(32.0 / 7.0 / 8.0)));
  CHECK(RootMeanSquare(std::vector<double>{3.0, -4.0}) == Approx(std::sqrt(12.5)));
  CHECK(std::isnan(RootMeanSquare(std::vector<double>{})));
}

TEST_CASE("A mean of nothing is NaN and so is a spread of one value") {
  CHECK(std::isnan(Mean({})));
  CHECK(std::isnan(MeanOfKnown({})));
  CHECK(Mean(std::vector<double>{3.0}) == 3.0);
  CHECK(std::isnan(StandardDeviation(std::vector<double>{3.0})));
  CHECK(std::isnan(StandardError(std::vector<double>{3.0})));
}

TEST_CASE("NaN makes a mean NaN unless only what is known is asked for") {
  const std::vector<double> values{1.0, NAN, 4.0};
  CHECK(std::isnan(Mean(values)));
  CHECK(std::isnan(StandardDeviation(values)));
  CHECK(MeanOfKnown(values) == 2.5);
  CHECK(std::isnan(MeanOfKnown(std::vector<double>{NAN, NAN})));
}

TEST_CASE("A standard deviation survives a mean that is much larger") {
  CHECK(StandardDeviation(std::vector{1e9 + 1.0, 1e9 + 2.0, 1e9 + 3.0}) == Approx(1.0));
}

TEST_CASE("Quantiles of the normal and Student's distribution are those of the tables") {
  CHECK(NormalQuantile(0.975) == Approx(1.959964).epsilon(1e-6));
  CHECK(NormalQuantile(0.5) == 0.0);
  CHECK(NormalQuantile(1e-6) == Approx(-4.753424).epsilon(1e-6));
  CHECK(NormalCdf(1.959963984540054) == Approx(0.975));
  CHECK(StudentQuantile(1.0, 0.975) == Approx(12.7062).epsilon(1e-5));
  CHECK(StudentQuantile(10.0, 0.95) == Approx(1.812461).epsilon(1e-6));
}

TEST_CASE("The F distribution is that of the tables and the noncentral one falls with lambda") {
  CHECK(FCriticalValue(2.0, 12.0, 0.05) == Approx(3.885294).epsilon(1e-6));
  CHECK(FUpperTail(2.0, 12.0, 3.885294) == Approx(0.05).epsilon(1e-5));
  CHECK(NoncentralFCdf(2.0, 12.0, 0.0, 3.885294) == Approx(0.95).epsilon(1e-5));
  double last = 1.0;
  for (const double lambda : {0.0, 1.0, 10.0, 100.0, 199.0, 201.0, 1000.0}) {
    const double cdf = NoncentralFCdf(2.0, 12.0, lambda, 50.0);
    CHECK(cdf < last);
    last = cdf;
  }
}

TEST_CASE("Binomial probabilities add up to one at any share") {
  for (const double share : {0.0, 0.3, 1.0}) {
    double sum = 0.0;
    for (int k = 0; k <= 7; ++k) sum += BinomialPdf(7, share, k);
    CHECK(sum == Approx(1.0));
  }
}

TEST_CASE("Clopper-Pearson intervals are those of the tables") {
  const auto check = [](int successes, int trials, double confidence, double low, double high) {
    INFO(successes << " of " << trials << " at " << confidence);
    const Interval interval = ClopperPearson(successes, trials, confidence);
    CHECK(interval.low == Approx(low).margin(5e-5));
    CHECK(interval.high == Approx(high).margin(5e-5));
  };
  check(0, 10, 0.95, 0.0, 0.3085);  // 1 - 0.025^(1/10)
  check(1, 10, 0.95, 0.0025, 0.4450);
  check(5, 10, 0.95, 0.1871, 0.8129);
  check(10, 10, 0.95, 0.6915, 1.0);
  check(8, 20, 0.95, 0.1912, 0.6395);
  check(0, 1, 0.95, 0.0, 0.975);
  check(0, 0, 0.95, 0.0, 1.0);
}

TEST_CASE("Clopper-Pearson intervals cover the share at least as often as they promise") {
  constexpr double kConfidence = 0.9;
  constexpr int kTrials = 17;
  for (double share = 0.02; share < 1.0; share += 0.02) {
    double covered = 0.0;
    for (int k = 0; k <= kTrials; ++k) {
      const Interval interval = ClopperPearson(k, kTrials, kConfidence);
      const bool is_inside = interval.low <= share && share <= interval.high;
      if (is_inside) covered += BinomialPdf(kTrials, share, k);
    }
    INFO("share " << share);
    CHECK(covered >= kConfidence);
  }
}

TEST_CASE("Counts that cannot be are refused") {
  for (const int wrong : {-1, 3}) {
    CHECK_THROWS_WITH(ClopperPearson(wrong, 2, 0.95),
                      "Clopper-Pearson: successes must lie between 0 and the trials");
  }
  for (const double wrong : {0.0, 1.0, double{NAN}}) {
    CHECK_THROWS_WITH(ClopperPearson(1, 2, wrong),
                      "Clopper-Pearson: the confidence must lie between 0 and 1");
  }
}

TEST_CASE("The interval of a mean is Student's and covers it as often as it promises") {
  const Interval interval = MeanInterval(std::vector{1.0, 2.0, 3.0}, 0.95);
  CHECK(interval.low == Approx(2.0 - 4.302653 / std::sqrt(3.0)).epsilon(1e-6));
  CHECK(interval.high == Approx(2.0 + 4.302653 / std::sqrt(3.0)).epsilon(1e-6));
  CHECK(std::isnan(MeanInterval(std::vector{1.0}, 0.95).low));
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal(5.0, 2.0);
  int covered = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<double> values(4);
    for (double& value : values) value = normal(generator);
    const Interval drawn = MeanInterval(values, 0.9);
    covered += drawn.low <= 5.0 && 5.0 <= drawn.high;
  }
  CHECK(covered == Approx(3600).margin(60));
}

}  // namespace
}  // namespace rift::statistics
