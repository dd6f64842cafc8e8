#include "rift/sweep/explain/effects.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "rift/sweep/explain/failing_region.hpp"
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

/// n trials drawn evenly over [-pi, pi]^3.
template <class Gap>
SweepResult Sampled(int n, const Gap& gap, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  SweepResult result;
  for (const char* name : {"a", "b", "c"}) {
    result.parameters.push_back({.key = name, .min = -std::numbers::pi, .max = std::numbers::pi});
  }
  for (int i = 0; i < n; ++i) {
    TrialRow row;
    double x[3];
    for (double& value : x) {
      value = angle(random);
      row.theta.push_back({std::to_string(i), value});
    }
    row.comparison.gap_m = gap(x);
    row.falsified = row.comparison.gap_m > result.gap.threshold_m;
    result.rows.push_back(row);
  }
  Summarise(result);
  return result;
}

double Ishigami(const double* x) {
  return std::sin(x[0]) + 7.0 * std::pow(std::sin(x[1]), 2) +
         0.1 * std::pow(x[2], 4) * std::sin(x[0]);
}

const ParameterEffect& Of(const Effects& effects, int parameter) {
  const ParameterEffect* effect = effects.Of(parameter);
  if (effect == nullptr) throw std::runtime_error("no effect of that parameter");
  return *effect;
}

TEST_CASE("The shares of the Ishigami function are its Sobol indices") {
  const Effects found = MeasureEffects(Sampled(2000, Ishigami), {.most_terms = 130});
  CHECK(found.predicted > 0.98);
  CHECK(Of(found, 0).alone == Approx(0.3139).margin(0.04));
  CHECK(Of(found, 1).alone == Approx(0.4424).margin(0.04));
  CHECK(Of(found, 2).alone == Approx(0.0).margin(0.02));
  CHECK(Of(found, 0).share == Approx(0.5576).margin(0.04));
  CHECK(Of(found, 1).share == Approx(0.4424).margin(0.04));
  CHECK(Of(found, 2).share == Approx(0.2437).margin(0.04));
  CHECK(found.parameters.front().name == "a");
  CHECK(Of(found, 0).together == std::vector<std::string>{"c"});
  CHECK(Of(found, 1).together.empty());
}

TEST_CASE("A balanced table gives the sums of squares of the textbook") {
  // Zar style 3 x 2 table with two trials a cell, worked by hand: of a total of 101.67, 77 go with
  // b, alone or together with a; 16 are left in the cells.
  SweepResult result = Table(2, 0.0, 1, [](int, int) { return 0.0; });
  const double gaps[12] = {4, 6, 8, 10, 6, 6, 9, 13, 11, 13, 5, 7};
  for (int i = 0; i < 12; ++i) result.rows[i].comparison.gap_m = gaps[i];
  Summarise(result);
  const Effects found = MeasureEffects(result);
  REQUIRE(found.degree == 2);
  CHECK(found.residual_df == 6.0);
  CHECK(std::pow(found.residual_sd_m, 2) == Approx(16.0 / 6.0));
  const double total = 101.0 + 2.0 / 3.0, mse = 16.0 / 6.0;
  CHECK(found.explained == Approx(1.0 - 16.0 / total).epsilon(1e-6));
  // Cell means 5 9 / 6 11 / 12 6: columns 23/3, 26/3; the b columns have 3 degrees of freedom.
  const double with_b = 2.0 * (2.0 * (4.0 + 6.25 + 9.0));
  CHECK(Of(found, 1).df == 3.0);
  CHECK(Of(found, 1).share == Approx((with_b - 3.0 * mse) / (total + mse)).epsilon(1e-6));
}

TEST_CASE("The effects that are there are seen and the others are not") {
  const SweepResult main_only = Table(6, 0.01, 3, [](int a, int) { return 0.02 * a; });
  const Effects found = MeasureEffects(main_only);
  CHECK(found.parameters.front().name == "a");
  CHECK(Of(found, 0).share_low > 0.2);
  CHECK(Of(found, 0).together.empty());
  CHECK_FALSE(Of(found, 1).IsSeen());

  const SweepResult crossed =
      Table(6, 0.01, 4, [](int a, int b) { return 0.02 * (a - 1) * (b == 0 ? 1 : -1); });
  const Effects both = MeasureEffects(crossed);
  CHECK(Of(both, 0).IsSeen());
  CHECK(Of(both, 0).together == std::vector<std::string>{"b"});
  CHECK(Of(both, 0).alone < 0.05);
}

TEST_CASE("A parameter that does nothing is seen in few sweeps") {
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Effects found = MeasureEffects(Table(8, 0.01, seed, [](int, int) { return 0.0; }));
    seen += Of(found, 0).IsSeen();
    seen += Of(found, 1).IsSeen();
  }
  CHECK(seen <= 40);  // 5 % of 800: the interval's low end is one-sided 2.5 %, the degree is chosen
}

TEST_CASE("An uneven table blames no parameter for another one") {
  // b does nothing, but most trials of y stand at the high values of a.
  SweepResult result = Table(8, 0.002, 5, [](int a, int) { return 0.02 * a; });
  std::erase_if(result.rows, [](const TrialRow& row) {
    return row.trial > "1" && (row.theta[1].text == "x") == (row.theta[0].text == "2");
  });
  Summarise(result);
  CHECK(result.anova[1].p < 0.05);  // one at a time it looks guilty
  CHECK_FALSE(Of(MeasureEffects(result), 1).IsSeen());
}

TEST_CASE("The interval of a share holds the truth about as often as it says") {
  // Effect of a: means -d, 0, d; noise 1: share of the variance = (2/3 d^2) / (2/3 d^2 + 1).
  const double d = 0.5, truth = (2.0 / 3.0 * d * d) / (2.0 / 3.0 * d * d + 1.0);
  int held = 0;
  for (int seed = 0; seed < 100; ++seed) {
    const Effects found =
        MeasureEffects(Table(8, 1.0, 100 + seed, [&](int a, int) { return d * (a - 1); }));
    held += Of(found, 0).share_low <= truth && truth <= Of(found, 0).share_high;
  }
  CHECK(held >= 89);
}

/// Share of the sweeps whose interval for the effect of a, planted at `truth`, holds it, and the
/// mean width of that interval. Means of a: -d, 0, d; noise 1.
std::pair<double, double> CoverageAt(double truth) {
  constexpr int kSweeps = 400;
  const double d = std::sqrt(1.5 * truth / (1.0 - truth));
  double held = 0.0, width = 0.0;
  for (std::uint64_t seed = 1; seed <= kSweeps; ++seed) {
    const Effects found =
        MeasureEffects(Table(8, 1.0, 9000 + seed, [&](int a, int) { return d * (a - 1); }));
    const ParameterEffect& a = Of(found, 0);
    held += a.share_low <= truth && truth <= a.share_high;
    width += a.share_high - a.share_low;
  }
  return {held / kSweeps, width / kSweeps};
}

TEST_CASE("The interval of a strong effect holds it, and is no wider than it has to be") {
  const auto [half_held, half_width] = CoverageAt(0.5);
  CAPTURE(half_held, half_width);
  CHECK(half_held >= 0.93);
  CHECK(half_width < 0.4);
  const auto [most_held, most_width] = CoverageAt(0.9);
  CAPTURE(most_held, most_width);
  CHECK(most_held >= 0.93);
  CHECK(most_width < 0.12);
}

TEST_CASE("Words and ranges are measured alike") {
  SweepResult result = Sampled(300, [](const double* x) { return x[0]; });
  result.parameters[1] = {.key = "b", .levels = {{"x", {}}, {"y", {}}, {"z", {}}}};
  for (size_t i = 0; i < result.rows.size(); ++i) {
    TrialRow& row = result.rows[i];
    row.theta[1] = result.parameters[1].levels[i % 3];
    row.comparison.gap_m = 0.1 * *row.theta[0].number + (i % 3 == 2 ? 1.0 : 0.0);
  }
  const double by_a = 0.01 * std::pow(std::numbers::pi, 2) / 3.0, by_b = 2.0 / 9.0;
  CHECK(Of(MeasureEffects(result), 1).share == Approx(by_b / (by_a + by_b)).margin(0.03));
}

TEST_CASE("The smallest detectable difference is detected as often as promised") {
  const double detectable = SmallestDetectable({16, 16, 16}, 1.0, 42.0, 0.8);
  int found = 0;
  for (int seed = 0; seed < 300; ++seed) {
    const Effects effects = MeasureEffects(
        Table(8, 1.0, 500 + seed, [&](int a, int) { return 0.5 * detectable * (a - 1); }));
    found += Of(effects, 0).p < kSignificance;
  }
  CHECK(found / 300.0 == Approx(0.8).margin(0.1));
  CHECK(std::isnan(SmallestDetectable({16}, 1.0, 42.0, 0.8)));
  CHECK(std::isnan(SmallestDetectable({4, 4}, 0.0, 6.0, 0.8)));
}

TEST_CASE("Too few trials and losses that do not vary say so") {
  CHECK(MeasureEffects(Sampled(3, Ishigami)).parameters.empty());
  CHECK_FALSE(MeasureEffects(Sampled(3, Ishigami)).note.empty());
  const Effects flat = MeasureEffects(Sampled(50, [](const double*) { return 1.0; }));
  CHECK(flat.parameters.empty());
  CHECK(flat.note == "the loss does not vary: nothing is seen to matter");
  SweepResult one;
  one.parameters = {{.key = "a", .levels = {{"1", 1.0}}}};
  CHECK(MeasureEffects(one).note.empty());
}

TEST_CASE("The failing region is where the failures are") {
  const SweepResult result =
      Sampled(2000, [](const double* x) { return x[0] + x[1] > 0.0 ? 0.1 : 0.0; });
  const std::array<int, 2> most =
      MostInfluential(result, MeasureEffects(result, {.most_trials = 200, .most_terms = 20}));
  CHECK(most[0] + most[1] == 1);  // a and b
  const FailingRegion region = MapFailures(result, most);
  CHECK(region.is_smoothed);
  REQUIRE(region.cells.size() == 24 * 24);
  CHECK(region.cells.front().share == 0.0);
  CHECK(region.cells.back().share == 1.0);
  for (const RegionCell& cell : region.cells) {
    const double middle = 0.5 * (cell.x_low + cell.x_high + cell.y_low + cell.y_high);
    if (std::abs(middle) < 1.0) continue;
    CHECK(cell.share == (middle > 0.0 ? 1.0 : 0.0));
  }
  CHECK(MapFailures(result, {-1, -1}).cells.empty());
}

/// Lists a and b that always change together, and c: how much each of the two makes out, within
/// a millimetre.
SweepResult Entangled(double by_both_m, double by_c_m) {
  SweepResult result;
  for (const char* name : {"a", "b", "c"}) {
    result.parameters.push_back({.key = name, .levels = {{"0", 0.0}, {"1", 1.0}}});
  }
  for (const size_t both : {0, 1}) {
    for (const size_t c : {0, 1}) {
      for (const double off_m : {-0.001, 0.001}) {
        TrialRow row;
        row.theta = {result.parameters[0].levels[both], result.parameters[1].levels[both],
                     result.parameters[2].levels[c]};
        row.comparison.gap_m =
            0.1 + by_both_m * static_cast<double>(both) + by_c_m * static_cast<double>(c) + off_m;
        result.rows.push_back(row);
      }
    }
  }
  Summarise(result);
  return result;
}

TEST_CASE("What cannot be told apart is said from a tenth of the variance on, and stands last") {
  const auto by_both_m = [](double share) { return 0.1 * std::sqrt(share / (1.0 - share)); };
  const Effects little = MeasureEffects(Entangled(by_both_m(0.098), 0.1));
  CHECK(little.note.find("changed together") == std::string::npos);
  const Effects much = MeasureEffects(Entangled(by_both_m(0.102), 0.1));
  CHECK_THAT(much.note, Catch::Contains("; 10 % goes with parameters that were changed together"));
  REQUIRE(much.parameters.size() == 3);
  CHECK(much.parameters[0].name == "c");
  CHECK(much.parameters[0].IsSeen());
  CHECK(std::isnan(much.parameters[1].share));
  CHECK(std::isnan(much.parameters[2].share));
}

}  // namespace
}  // namespace rift::sweep
