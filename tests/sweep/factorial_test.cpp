#include "rift/sweep/explain/factorial.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {
namespace {

/// 3 values of a, 2 of b, `repeats` trials; gap = 0.05 + effect(a, b) + noise.
template <class EffectAt>
SweepResult Table(int repeats, double noise_m, std::uint64_t seed, const EffectAt& effect) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  SweepResult result;
  result.parameters = {{.key = "a", .levels = {{"0", 0.0}, {"1", 1.0}, {"2", 2.0}}},
                       {.key = "b", .levels = {{"x", {}}, {"y", {}}}}};
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 2; ++b) {
      for (int trial = 0; trial < repeats; ++trial) {
        TrialRow row;
        row.theta = {result.parameters[0].levels[a], result.parameters[1].levels[b]};
        row.trial = std::to_string(trial);
        row.comparison.gap_m = 0.05 + effect(a, b) + noise_m * normal(random);
        result.rows.push_back(row);
      }
    }
  }
  Summarise(result);
  return result;
}

TEST_CASE("A balanced table gives the sums of squares of the textbook") {
  // Zar style 3 x 2 table with two trials a cell, worked by hand.
  SweepResult result = Table(2, 0.0, 1, [](int, int) { return 0.0; });
  const double gaps[12] = {4, 6, 8, 10, 6, 6, 9, 13, 11, 13, 5, 7};
  for (int i = 0; i < 12; ++i) result.rows[i].comparison.gap_m = gaps[i];
  Summarise(result);
  const FactorialAnalysis analysis = AnalyseFactors(result);
  REQUIRE(analysis.terms.size() == 3);
  CHECK(analysis.residual_df == 6.0);
  CHECK(std::pow(analysis.residual_sd_m, 2) == Approx(16.0 / 6.0));
  // Cell means 5 9 / 6 11 / 12 6: rows 7, 8.5, 9; columns 23/3, 26/3.
  CHECK(analysis.terms[0].f ==
        Approx(4.0 * (1.361111 + 0.111111 + 0.694444) / 2.0 / (16.0 / 6.0)).epsilon(1e-5));
  CHECK(analysis.terms[1].f == Approx(12.0 * 0.25 / (16.0 / 6.0)));
  CHECK(analysis.terms[2].name == "a x b");
  CHECK(analysis.terms[2].df == 2.0);
}

TEST_CASE("The effects that are there are found and the others are not") {
  const SweepResult main_only = Table(6, 0.01, 3, [](int a, int) { return 0.02 * a; });
  const FactorialAnalysis found = AnalyseFactors(main_only);
  CHECK(found.Main(0)->p < 1e-4);
  CHECK(found.Main(1)->p > 0.05);
  CHECK(found.terms[2].p > 0.05);
  CHECK(found.Main(0)->share_low > 0.2);
  CHECK(found.Main(1)->share_low == 0.0);

  const SweepResult crossed =
      Table(6, 0.01, 4, [](int a, int b) { return 0.02 * (a - 1) * (b == 0 ? 1 : -1); });
  const FactorialAnalysis interaction = AnalyseFactors(crossed);
  CHECK(interaction.Main(0)->p > 0.05);
  CHECK(interaction.terms[2].p < 1e-4);
}

TEST_CASE("An uneven table blames no parameter for another one") {
  // b does nothing, but most trials of y stand at the high values of a.
  SweepResult result = Table(8, 0.002, 5, [](int a, int) { return 0.02 * a; });
  std::erase_if(result.rows, [](const TrialRow& row) {
    return row.trial > "1" && (row.theta[1].text == "x") == (row.theta[0].text == "2");
  });
  Summarise(result);
  CHECK(result.effects[1].p < 0.05);  // one at a time it looks guilty
  CHECK(AnalyseFactors(result).Main(1)->p > 0.05);
}

TEST_CASE("The interval of a share holds the truth about as often as it says") {
  // Effect of a: means -d, 0, d; noise 1: population share = (2/3 d^2) / (2/3 d^2 + 1).
  const double d = 0.5, truth = (2.0 / 3.0 * d * d) / (2.0 / 3.0 * d * d + 1.0);
  int held = 0;
  for (int seed = 0; seed < 100; ++seed) {
    const FactorialAnalysis analysis =
        AnalyseFactors(Table(8, 1.0, 100 + seed, [&](int a, int) { return d * (a - 1); }));
    held += analysis.Main(0)->share_low <= truth && truth <= analysis.Main(0)->share_high;
  }
  CHECK(held >= 89);
  CHECK(held <= 100);
}

TEST_CASE("The smallest detectable difference is detected as often as promised") {
  const double detectable = SmallestDetectable({16, 16, 16}, 1.0, 42.0, 0.8);
  int found = 0;
  for (int seed = 0; seed < 300; ++seed) {
    found += AnalyseFactors(
                 Table(8, 1.0, 500 + seed, [&](int a, int) { return 0.5 * detectable * (a - 1); }))
                 .Main(0)
                 ->p < kSignificance;
  }
  CHECK(found / 300.0 == Approx(0.8).margin(0.08));
  CHECK(std::isnan(SmallestDetectable({16}, 1.0, 42.0, 0.8)));
  CHECK(std::isnan(SmallestDetectable({4, 4}, 0.0, 6.0, 0.8)));
}

TEST_CASE("A table without repeats has main effects and no test of what it cannot test") {
  const FactorialAnalysis analysis =
      AnalyseFactors(Table(1, 0.01, 9, [](int a, int) { return 0.1 * a; }));
  CHECK_FALSE(analysis.has_interactions);
  CHECK(analysis.Main(0)->p < 0.05);
  const FactorialAnalysis same = AnalyseFactors(Table(2, 0.0, 9, [](int, int) { return 0.0; }));
  CHECK(std::isnan(same.Main(0)->p));
}

}  // namespace
}  // namespace rift::sweep
