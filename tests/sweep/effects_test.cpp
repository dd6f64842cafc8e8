#include "rift/sweep/explain/sensitivity.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "rift/sweep/explain/failing_region.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {
namespace {

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

const SobolIndex& Of(const Sensitivity& sensitivity, const std::string& name) {
  for (const SobolIndex& index : sensitivity.indices) {
    if (index.parameter == name) return index;
  }
  throw std::runtime_error("no index of " + name);
}

TEST_CASE("The indices of the Ishigami function are those of the textbook") {
  const Sensitivity found =
      EstimateSensitivity(Sampled(500, Ishigami), {.most_terms = 130, .bootstraps = 3});
  CHECK(found.q2 > 0.98);
  CHECK(Of(found, "a").first == Approx(0.3139).margin(0.03));
  CHECK(Of(found, "b").first == Approx(0.4424).margin(0.03));
  CHECK(Of(found, "c").first == Approx(0.0).margin(0.02));
  CHECK(Of(found, "a").total == Approx(0.5576).margin(0.03));
  CHECK(Of(found, "c").total == Approx(0.2437).margin(0.03));
  CHECK(found.indices.front().parameter == "a");
}

TEST_CASE("Intervals hold the truth and an idle parameter has next to nothing") {
  // Variances of a and b are 4 to 1; the noise is the trial's own.
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed + 100);
    std::normal_distribution<double> noise(0.0, 0.3);
    const Sensitivity found = EstimateSensitivity(Sampled(
        200, [&](const double* x) { return 2.0 * x[0] + x[1] + noise(random); }, seed));
    const SobolIndex a = Of(found, "a");
    held += a.first_low <= 0.8 && 0.8 <= a.first_high;
    CHECK(Of(found, "c").total < 0.02);
  }
  CHECK(held >= 17);
}

TEST_CASE("Words take part as factors") {
  SweepResult result = Sampled(300, [](const double* x) { return x[0]; });
  result.parameters[1] = {.key = "b", .levels = {{"x", {}}, {"y", {}}, {"z", {}}}};
  for (size_t i = 0; i < result.rows.size(); ++i) {
    TrialRow& row = result.rows[i];
    row.theta[1] = result.parameters[1].levels[i % 3];
    row.comparison.gap_m = 0.1 * *row.theta[0].number + (i % 3 == 2 ? 1.0 : 0.0);
  }
  const Sensitivity found = EstimateSensitivity(result);
  const double by_a = 0.01 * std::pow(std::numbers::pi, 2) / 3.0, by_b = 2.0 / 9.0;
  CHECK(Of(found, "b").first == Approx(by_b / (by_a + by_b)).margin(0.03));
}

TEST_CASE("Too few trials and no ranges give no indices") {
  CHECK(EstimateSensitivity(Sampled(3, Ishigami)).indices.empty());
  CHECK(EstimateSensitivity(Sampled(50, [](const double*) { return 1.0; })).indices.empty());
  SweepResult grid;
  grid.parameters = {{.key = "a", .levels = {{"1", 1.0}}}};
  CHECK(EstimateSensitivity(grid).note.empty());
}

TEST_CASE("The failing region is where the failures are") {
  const SweepResult result =
      Sampled(2000, [](const double* x) { return x[0] + x[1] > 0.0 ? 0.1 : 0.0; });
  const Sensitivity sensitivity =
      EstimateSensitivity(result, {.most_trials = 200, .most_terms = 20, .bootstraps = 3});
  const std::array<int, 2> most = MostInfluential(result, AnalyseFactors(result), sensitivity);
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

}  // namespace
}  // namespace rift::sweep
