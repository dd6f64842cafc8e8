#include "rift/statistics/inference.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

namespace rift::statistics {
namespace {

TEST_CASE("The analysis of variance agrees with one done by hand") {
  const AnalysisOfVariance result =
      AnalyseVariance({{6, 8, 4, 5, 3}, {8, 12, 9, 11, 6}, {13, 9, 11, 8, 7}});
  CHECK(result.df_between == 2.0);
  CHECK(result.df_within == 12.0);
  CHECK(result.f > 0.0);
  // Group means 5.2, 9.2, 9.6, grand mean 8; between 59.2, within 14.8 + 22.8 + 23.2.
  CHECK(result.f == Approx((59.2 / 2.0) / (60.8 / 12.0)));
  CHECK(result.eta_squared == Approx(59.2 / 120.0));
  CHECK(result.omega_squared == Approx((59.2 - 2.0 * 60.8 / 12.0) / (120.0 + 60.8 / 12.0)));
}

TEST_CASE("For two groups the analysis of variance is the t test squared") {
  const std::vector<double> a{1.0, 2.0, 4.0}, b{3.0, 5.0, 7.0};
  const AnalysisOfVariance result = AnalyseVariance({a, b});
  const double t = (5.0 - 7.0 / 3.0) / std::sqrt((14.0 / 3.0 + 8.0) / 4.0 * (2.0 / 3.0));
  CHECK(result.f == Approx(t * t));
}

TEST_CASE("Under no effect the p value is evenly spread") {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> noise;
  int below_half = 0, below_tenth = 0;
  constexpr int kRounds = 2000;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::vector<double>> groups(3, std::vector<double>(6));
    for (auto& group : groups) {
      for (double& value : group) value = noise(generator);
    }
    const double p = AnalyseVariance(groups).p;
    below_half += p < 0.5;
    below_tenth += p < 0.1;
  }
  CHECK(below_half == Approx(kRounds * 0.5).margin(90));
  CHECK(below_tenth == Approx(kRounds * 0.1).margin(55));
}

TEST_CASE("No test is made where the data allow none") {
  CHECK(std::isnan(AnalyseVariance({{1.0, 2.0}}).p));
  CHECK(std::isnan(AnalyseVariance({{1.0}, {2.0}}).p));
  CHECK(std::isnan(AnalyseVariance({{1.0, 1.0}, {2.0, 2.0}}).f));
  CHECK(std::isnan(AnalyseVariance({{1.0, 2.0}, {}}).p));
}

}  // namespace
}  // namespace rift::statistics
