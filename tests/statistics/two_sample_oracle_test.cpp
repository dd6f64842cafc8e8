// Every number of a classifier two-sample test beside that of
// tests/statistics/oracle/two_sample.py, which knows the definition and nothing of rift.

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "rift/statistics/two_sample.hpp"
#include "support/inputs/oracle.hpp"

namespace rift::statistics {
namespace {

TEST_CASE("Each number of a two-sample test is the one that its definition gives in SciPy") {
  std::vector<Observation> observations;
  for (const std::vector<std::string>& cells : test::OracleRows("statistics", "observations.csv")) {
    Observation& one = observations.emplace_back();
    one.group = std::stoul(cells[0]);
    one.is_first = cells[1] == "1";
    for (size_t i = 2; i < cells.size(); ++i) one.features.push_back(std::stod(cells[i]));
  }
  constexpr int kPermutations = 999;
  const TwoSampleTest found =
      TestTwoSamples(observations, {.ridge = 0.7, .folds = 4, .permutations = kPermutations},
                     {.resamples = 200'000}, 3);
  std::map<std::string, double> exact{{"first", static_cast<double>(found.first)},
                                      {"second", static_cast<double>(found.second)},
                                      {"groups", static_cast<double>(found.groups)},
                                      {"accuracy", found.accuracy}};
  // Of groups drawn on either side.
  std::map<std::string, double> drawn{{"low", found.accuracy_interval.low},
                                      {"high", found.accuracy_interval.high}};
  REQUIRE(found.features.size() == 4);
  for (const FeatureEvidence& feature : found.features) {
    const std::string name(1, static_cast<char>('a' + feature.feature));
    exact[name + "/accuracy"] = feature.accuracy;
    exact[name + "/weight"] = feature.weight;
    drawn[name + "/low"] = feature.accuracy_interval.low;
    drawn[name + "/high"] = feature.accuracy_interval.high;
  }
  CHECK(found.features.front().feature == 1);
  size_t checked = 0;
  for (const std::vector<std::string>& cells : test::OracleRows("statistics", "two_sample.csv")) {
    INFO(cells[0] << " " << cells[1]);
    const double expected = std::stod(cells[1]);
    if (cells[0] == "p") {
      const double variance = expected * (1.0 - expected);
      const double sd = std::sqrt(variance / kPermutations + variance / 2000.0);
      CHECK(std::abs(found.p - expected) < 4.0 * sd);
    } else if (exact.count(cells[0]) == 1) {
      CHECK(exact.at(cells[0]) == Approx(expected).epsilon(1e-6).margin(1e-7));
    } else {
      CHECK(drawn.at(cells[0]) == Approx(expected).margin(0.01));
    }
    ++checked;
  }
  CHECK(checked == exact.size() + drawn.size() + 1);
}

}  // namespace
}  // namespace rift::statistics
