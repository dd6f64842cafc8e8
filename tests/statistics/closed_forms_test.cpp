// Statistics against closed forms and numbers worked out by hand.
#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "rift/statistics/bootstrap.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/statistics/random.hpp"
#include "rift/statistics/rank_correlation.hpp"
#include "rift/statistics/sequential.hpp"
#include "statistics/logistic.hpp"

namespace rift::statistics {
namespace {

TEST_CASE("A spread far from zero keeps its digits where the mean is no number of the machine") {
  const double far = 1e9;
  const std::vector<double> values{far + 1.0, far + 2.0, far + 4.0};  // mean far + 7/3
  CHECK(StandardDeviation(values) == Approx(std::sqrt(7.0 / 3.0)).epsilon(1e-6));
  CHECK(StandardError(values) == Approx(std::sqrt(7.0 / 9.0)).epsilon(1e-6));
}

TEST_CASE("Means of values of one sign, of two, and of squares") {
  CHECK(Mean(std::vector<double>{-1.0, 2.0, 5.0}) == 2.0);
  CHECK(RootMeanSquare(std::vector<double>{3.0, -4.0, 5.0}) == Approx(std::sqrt(50.0 / 3.0)));
  CHECK(MeanOfKnown(std::vector<double>{1.0, std::nan(""), 4.0}) == 2.5);
  CHECK(std::isnan(MeanOfKnown(std::vector<double>{std::nan("")})));
  CHECK(CentralInterval({0.0, 1.0, 2.0, 3.0, 4.0}, 0.5).low == 1.0);
  CHECK(CentralInterval({0.0, 1.0, 2.0, 3.0, 4.0}, 0.5).high == 3.0);
}

TEST_CASE("The mean of a normal variable within limits moves away from the nearer one") {
  // Half of a normal distribution.
  CHECK(MeanOfNormalWithin(0.0, 2.0, 0.0, 1e3) == Approx(2.0 * std::sqrt(2.0 / M_PI)));
  CHECK(MeanOfNormalWithin(5.0, 2.0, -1e3, 5.0) == Approx(5.0 - 2.0 * std::sqrt(2.0 / M_PI)));
  CHECK(MeanOfNormalWithin(0.3, 0.01, 0.0, 1.0) == Approx(0.3));
  CHECK(MeanOfNormalWithin(0.5, 0.8, 0.0, 1.0) == Approx(0.5));
  // Hardly told: the middle.
  CHECK(MeanOfNormalWithin(0.1, 50.0, 0.0, 1.0) == Approx(0.5).epsilon(1e-3));
  for (const double mean : {0.0, 0.1, 0.4}) {
    const double within = MeanOfNormalWithin(mean, 0.3, 0.0, 1.0);
    CHECK(within > mean);
    CHECK(MeanOfNormalWithin(1.0 - mean, 0.3, 0.0, 1.0) == Approx(1.0 - within));
  }
}

TEST_CASE("The mean of a normal variable within limits is that of its density there") {
  for (const double mean : {0.0, 0.2, 0.9, 1.0}) {
    for (const double sd : {0.05, 0.4, 3.0}) {
      constexpr int kParts = 4000;
      double sum = 0.0, weighted = 0.0;
      for (int i = 0; i < kParts; ++i) {
        const double x = -0.5 + 1.5 * (i + 0.5) / kParts;
        const double density = std::exp(-0.5 * std::pow((x - mean) / sd, 2));
        sum += density, weighted += density * x;
      }
      INFO(mean << " " << sd);
      CHECK(MeanOfNormalWithin(mean, sd, -0.5, 1.0) == Approx(weighted / sum).margin(1e-5));
    }
  }
}

TEST_CASE("F with two degrees of freedom, and beta with an integer, have closed forms") {
  for (const double f : {0.1, 1.0, 4.2, 20.0}) {
    for (const double m : {1.0, 9.0, 40.0}) {
      CHECK(FUpperTail(2.0, m, f) == Approx(std::pow(1.0 + 2.0 * f / m, -m / 2.0)));
      CHECK(FCriticalValue(2.0, m, FUpperTail(2.0, m, f)) == Approx(f));
    }
  }
  for (const double x : {0.0, 0.3, 0.9, 1.0}) {
    CHECK(BetaCdf(3.0, 1.0, x) == Approx(x * x * x));
    CHECK(BetaCdf(1.0, 4.0, x) == Approx(1.0 - std::pow(1.0 - x, 4.0)));
  }
  CHECK(BinomialPdf(3, 0.2, 1) == Approx(3 * 0.2 * 0.64));
  CHECK(BinomialPdf(3, 0.2, 0) == Approx(0.512));
  CHECK(StudentQuantile(1.0, 0.75) == Approx(1.0));  // Cauchy
  CHECK(StudentQuantile(2.0, 0.75) == Approx(std::sqrt(2.0 / 3.0)));
  CHECK(NormalCdf(-1.0) == Approx(0.158655254));
}

/// The mixture of central distributions with Poisson weights.
double NoncentralF(double df1, double df2, double lambda, double f) {
  const double x = df1 * f / (df1 * f + df2);
  double sum = 0.0;
  for (int j = 0; j < 2000; ++j) {
    const double weight =
        std::exp(-lambda / 2.0 + j * std::log(lambda / 2.0) - std::lgamma(j + 1.0));
    sum += weight * BetaCdf(df1 / 2.0 + j, df2 / 2.0, x);
  }
  return sum;
}

TEST_CASE("The noncentral F is a mixture of central ones, nearly so where it is large") {
  for (const double lambda : {0.5, 5.0, 80.0, 200.0}) {
    for (const double share : {0.5, 1.0, 1.6}) {
      const double f = share * (3.0 + lambda) / 3.0;
      INFO(lambda << " " << f);
      CHECK(NoncentralFCdf(3.0, 20.0, lambda, f) ==
            Approx(NoncentralF(3.0, 20.0, lambda, f)).margin(1e-9));
    }
  }
  for (const double lambda : {201.0, 500.0}) {
    for (const double share : {0.5, 1.0, 1.6}) {
      const double f = share * (3.0 + lambda) / 3.0;
      CHECK(NoncentralFCdf(3.0, 20.0, lambda, f) ==
            Approx(NoncentralF(3.0, 20.0, lambda, f)).margin(2e-3));
      // From there on it is the central F that has its first two moments.
      const double scale = (3.0 + lambda) / 3.0,
                   df = (3.0 + lambda) * (3.0 + lambda) / (3.0 + 2.0 * lambda);
      CHECK(NoncentralFCdf(3.0, 20.0, lambda, f) ==
            Approx(1.0 - FUpperTail(df, 20.0, f / scale)).epsilon(1e-9));
    }
  }
}

TEST_CASE("Clopper-Pearson has closed ends for none, all and one of one") {
  CHECK(ClopperPearson(0, 10, 0.95).low == 0.0);
  CHECK(ClopperPearson(0, 10, 0.95).high == Approx(1.0 - std::pow(0.025, 0.1)));
  CHECK(ClopperPearson(10, 10, 0.95).low == Approx(std::pow(0.025, 0.1)));
  CHECK(ClopperPearson(10, 10, 0.95).high == 1.0);
  CHECK(ClopperPearson(1, 2, 0.9).low == Approx(1.0 - std::sqrt(0.95)));
  CHECK(ClopperPearson(1, 2, 0.9).high == Approx(std::sqrt(0.95)));
  for (const double wrong : {0.0, 1.0, -0.1, 1.1}) {
    CHECK_THROWS_AS(ClopperPearson(1, 2, wrong), std::invalid_argument);
  }
}

TEST_CASE("Groups of unequal size and empty ones: the analysis of variance by hand") {
  // Means 2, 6 and nothing; grand mean (4 + 18) / 5 = 4.4.
  const AnalysisOfVariance result = AnalyseVariance({{1, 3}, {}, {5, 6, 7}});
  CHECK(result.df_between == 1.0);
  CHECK(result.df_within == 3.0);
  const double between = 2 * 2.4 * 2.4 + 3 * 1.6 * 1.6, within = 4.0;
  CHECK(result.f == Approx(between / (within / 3.0)));
  CHECK(result.eta_squared == Approx(between / (between + within)));
  const AnalysisOfVariance none = AnalyseVariance({{1, 3}, {1, 3}});
  CHECK(none.f == Approx(0.0));
  CHECK(none.omega_squared == 0.0);  // never below
}

TEST_CASE("The evidence of one trial is the mean of five likelihood ratios") {
  // Odds 2, 3.5, 7, 20 and 100 times those of the bound 0.1, weights 3/8, 2/8 and 1/8 each.
  const double hit =
      0.375 * 2 / 1.1 + 0.25 * 3.5 / 1.25 + 0.125 * 7 / 1.6 + 0.125 * 20 / 2.9 + 0.125 * 100 / 10.9;
  const double miss = 0.375 / 1.1 + 0.25 / 1.25 + 0.125 / 1.6 + 0.125 / 2.9 + 0.125 / 10.9;
  CHECK(EvidenceOnShare(1, 1, 0.1).above == Approx(std::log(hit)));
  CHECK(EvidenceOnShare(0, 1, 0.1).above == Approx(std::log(miss)));
  CHECK(EvidenceOnShare(0, 0, 0.1).above == Approx(0.0).margin(1e-12));
  // Below is the same of failures at the other bound.
  CHECK(EvidenceOnShare(0, 1, 0.9).below == Approx(std::log(hit)));
  CHECK(EvidenceOnShare(3, 5, 0.3).below == Approx(EvidenceOnShare(2, 5, 0.7).above));
  CHECK(NeededEvidence(20, 4, 0.05) == Approx(std::log(100.0)));
  CHECK(NeededEvidence(1, 1, 0.05) == Approx(std::log(20.0)));
}

TEST_CASE("Discoveries are counted from the strongest evidence down") {
  // Of ten hypotheses at 5 %: one needs log 200, two need log 100 each, three log 66.7.
  CHECK(CountDiscoveries({5.2, 0.0, 0.0}, 10, 0.05) == 0);
  CHECK(CountDiscoveries({5.3, 0.0, 0.0}, 10, 0.05) == 1);
  CHECK(CountDiscoveries({4.7, 0.0, 4.7}, 10, 0.05) == 2);
  CHECK(CountDiscoveries({4.5, 4.5, 0.0}, 10, 0.05) == 0);
  CHECK(CountDiscoveries({4.3, 4.3, 4.3}, 10, 0.05) == 3);
  CHECK(CountDiscoveries({}, 10, 0.05) == 0);
}

TEST_CASE("An interval that holds at every look ends where the evidence is what is needed") {
  for (const auto& [successes, trials] : {std::pair{0, 8}, {3, 8}, {8, 8}}) {
    const Interval interval = AnytimeInterval(successes, trials, 0.9);
    INFO(successes);
    if (successes > 0) {
      CHECK(EvidenceOnShare(successes, trials, interval.low).above ==
            Approx(std::log(10.0)).margin(1e-6));
    } else {
      CHECK(interval.low == 0.0);
    }
    if (successes < trials) {
      CHECK(EvidenceOnShare(successes, trials, interval.high).below ==
            Approx(std::log(10.0)).margin(1e-6));
    } else {
      CHECK(interval.high == 1.0);
    }
  }
}

TEST_CASE("A logistic regression of one feature of two values has a closed form") {
  // 2 of 3 with the larger value are of the first sample, 1 of 3 with the smaller.
  Eigen::MatrixXd features(6, 1);
  features << 5, 5, 3, 3, 3, 5;
  Eigen::VectorXd is_first(6);
  is_first << 1, 1, 1, 0, 0, 0;
  const LogisticModel free = FitLogistic(features, is_first, 0.0);
  CHECK(free.mean[0] == Approx(4.0));
  CHECK(free.inverse[0] == Approx(1.0));
  CHECK(free.weights[0] == Approx(std::log(2.0)));  // the odds are 2 and 1/2
  CHECK(free.intercept == Approx(0.0).margin(1e-9));
  Eigen::MatrixXd tried(3, 1);
  tried << 5, 3, std::nan("");
  const Eigen::VectorXd scores = free.Scores(tried);
  CHECK(scores[0] == Approx(std::log(2.0)));
  CHECK(scores[1] == Approx(-std::log(2.0)));
  CHECK(scores[2] == Approx(0.0).margin(1e-9));  // not known: the mean
  // With a ridge of r the weight w solves 6 / (1 + e^-w) - 4 + r w = 0.
  const double w = FitLogistic(features, is_first, 0.8).weights[0];
  CHECK(6.0 / (1.0 + std::exp(-w)) - 4.0 + 0.8 * w == Approx(0.0).margin(1e-7));
  CHECK(w > 0.0);
  CHECK(w < std::log(2.0));
}

TEST_CASE("A logistic regression of samples that a value divides ends after fifty steps") {
  // Without a ridge the weight w has no end: a step of Newton's adds 1 + e^-w.
  Eigen::MatrixXd features(2, 1);
  features << 5, 3;
  const LogisticModel model = FitLogistic(features, Eigen::Vector2d(1.0, 0.0), 0.0);
  double w = 0.0;
  for (int step = 0; step < 50; ++step) w += 1.0 + std::exp(-w);
  CHECK(model.weights[0] == Approx(w).margin(0.01));
  CHECK(model.intercept == Approx(0.0).margin(0.01));
}

TEST_CASE("A logistic regression weighs both samples alike and leaves constants out") {
  // Twice as many of the second sample, every value in each: nothing can be told.
  Eigen::MatrixXd features(6, 2);
  features << 1, 7, 2, 7, 1, 7, 2, 7, 1, 7, 2, 7;
  Eigen::VectorXd is_first(6);
  is_first << 1, 1, 0, 0, 0, 0;
  const LogisticModel model = FitLogistic(features, is_first, 0.1);
  CHECK(model.intercept == Approx(0.0).margin(1e-9));
  CHECK(model.weights[0] == Approx(0.0).margin(1e-9));
  CHECK(model.weights[1] == 0.0);
  CHECK(model.inverse[1] == 0.0);
  CHECK(model.inverse[0] == Approx(2.0));  // deviation 1/2
}

TEST_CASE("A logistic regression knows mean and scatter of what is known of a column") {
  Eigen::MatrixXd features(8, 1);
  const double none = std::nan("");
  features << none, 5, 5, 3, 3, none, 3, 5;
  Eigen::VectorXd is_first(8);
  is_first << 1, 1, 1, 1, 0, 0, 0, 0;
  const LogisticModel model = FitLogistic(features, is_first, 0.0);
  CHECK(model.mean[0] == Approx(4.0));
  CHECK(model.inverse[0] == Approx(1.0));
  CHECK(model.weights[0] == Approx(std::log(2.0)));  // what is not known is at the mean
}

TEST_CASE("Random numbers of other seeds and streams are others, in every word of both") {
  const auto first = [](std::uint64_t seed, std::uint64_t stream) {
    return Random(seed, stream).Uniform();
  };
  const std::uint64_t high = std::uint64_t{1} << 32;
  std::set<double> values{first(1, 2),        first(2, 1), first(1 + high, 2),
                          first(1, 2 + high), first(1, 3), first(2, 2)};
  CHECK(values.size() == 6);
  CHECK(first(1, 2) == first(1, 2));
  Random random(5, 6);
  std::vector<int> counts(4, 0);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const double uniform = random.Uniform();
    CHECK((uniform >= 0.0 && uniform < 1.0));
    ++counts.at(random.Below(4));
    const double normal = random.Normal();
    sum += normal;
    squares += normal * normal;
  }
  for (const int count : counts) CHECK(count == Approx(5000).margin(300));
  CHECK(sum / 20'000 == Approx(0.0).margin(0.03));
  CHECK(squares / 20'000 == Approx(1.0).margin(0.05));
  CHECK(Random(1, 1).Below(1) == 0);
}

TEST_CASE("A bootstrap of two groups hands each draw of two, and widens by Student") {
  int calls = 0;
  std::set<std::vector<size_t>> seen;
  const GroupStatistic statistic = [&](std::span<const size_t> drawn) {
    ++calls;
    seen.insert({drawn.begin(), drawn.end()});
    return static_cast<double>(drawn[0] + drawn[1]);
  };
  BootstrapOptions options;
  options.resamples = 400;
  options.confidence = 0.5;
  const Interval interval = BootstrapGroups(2, statistic, options, 3);
  CHECK(calls == 400);
  CHECK(seen.size() == 4);
  // Of 0, 1 and 2 with chances 1/4, 1/2, 1/4 more than the middle half is taken.
  CHECK(interval.low == 0.0);
  CHECK(interval.high == 2.0);
  CHECK(std::isnan(BootstrapGroups(1, statistic, options, 3).low));
}

TEST_CASE("A rank correlation with ties is that of the mean ranks") {
  // Ranks 0.5 0.5 2 3 against 0 1 2 3: covariance 4.5, squares 4.5 and 5.
  CHECK(RankCorrelation(std::vector<double>{1, 1, 5, 9}, std::vector<double>{1, 2, 3, 4}) ==
        Approx(4.5 / std::sqrt(4.5 * 5.0)));
  CHECK(RankCorrelation(std::vector<double>{3, 2, 1}, std::vector<double>{1, 2, 3}) == -1.0);
  CHECK(std::isnan(RankCorrelation(std::vector<double>{1, 2}, std::vector<double>{1, 2})));
  CHECK(std::isnan(RankCorrelation(std::vector<double>{1, 1, 1}, std::vector<double>{1, 2, 3})));
  CHECK(std::isnan(RankCorrelation(std::vector<double>{1, 2, 3}, std::vector<double>{1, 1, 1})));
}

TEST_CASE(
    "A counter's normal is Box and Muller's of its two uniforms, and heavy tails are Bailey's") {
  const CounterRandom random(3, 4);
  const double u = random.Uniform(7, 0), v = random.Uniform(7, 1);
  CHECK(random.Normal(7, 0) ==
        Approx(std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * 3.14159265358979 * v)));
  // Student's t with 5 degrees has the variance 5/3, which is divided out.
  const double t =
      std::sqrt(5.0 * (std::pow(u, -2.0 / 5.0) - 1.0)) * std::cos(2.0 * 3.14159265358979 * v);
  CHECK(random.HeavyTailed(7, 0, 5.0) == Approx(t / std::sqrt(5.0 / 3.0)));
}

TEST_CASE("A logistic regression leaves constants out that no machine has, of either sign") {
  // Their mean is rounded, so that they seem to scatter by some 1e-17.
  Eigen::MatrixXd features(7, 4);
  Eigen::VectorXd is_first(7);
  for (Eigen::Index i = 0; i < 7; ++i) {
    features.row(i) << 0.7, -1.1, 0.0, static_cast<double>(i % 3);
    is_first[i] = i < 2 ? 1.0 : 0.0;
  }
  const LogisticModel model = FitLogistic(features, is_first, 0.1);
  for (const int constant : {0, 1, 2}) {
    INFO(constant);
    CHECK(model.inverse[constant] == 0.0);
    CHECK(model.weights[constant] == 0.0);
  }
  CHECK(model.inverse[3] > 0.5);
  // One that scatters by a millionth of its value is told.
  features.col(1) *= -1e5;
  features(0, 1) += 0.1;
  CHECK(FitLogistic(features, is_first, 0.1).inverse[1] > 1.0);
}

TEST_CASE("An analysis of variance needs no more than one value beyond its groups") {
  // Means 1.5 and 5, grand mean 8/3; F with 1 and 1 degrees is the square of Cauchy's t.
  const AnalysisOfVariance result = AnalyseVariance({{1.0, 2.0}, {5.0}});
  CHECK(result.df_between == 1.0);
  CHECK(result.df_within == 1.0);
  CHECK(result.f == Approx(49.0 / 3.0));
  CHECK(result.p == Approx(2.0 / M_PI * std::atan(std::sqrt(3.0) / 7.0)));
  CHECK(result.eta_squared == Approx(49.0 / 52.0));
  CHECK(result.omega_squared == Approx((49.0 - 3.0) / (52.0 + 3.0)));
}

}  // namespace
}  // namespace rift::statistics
