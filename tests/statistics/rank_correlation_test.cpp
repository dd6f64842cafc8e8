#include "rift/statistics/rank_correlation.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace rift::statistics {
namespace {

double Of(const std::vector<double>& a, const std::vector<double>& b) {
  return RankCorrelation(a, b);
}

TEST_CASE("Ranks are all that a rank correlation looks at") {
  CHECK(Of({1, 2, 3, 4}, {10, 200, 3000, 1e9}) == Approx(1.0));
  CHECK(Of({1, 2, 3, 4}, {4, 3, 2, 1}) == Approx(-1.0));
  // 1 - 6 * 8 / (5 * 24): the textbook's formula without ties.
  CHECK(Of({1, 2, 3, 4, 5}, {2, 1, 4, 5, 3}) == Approx(1.0 - 6.0 * 8.0 / 120.0));
}

TEST_CASE("Equal values share the mean of their ranks") {
  // Ranks 0, 1.5, 1.5, 3 against 0, 1, 2, 3: 4.5 / sqrt(4.5 * 5).
  CHECK(Of({1, 2, 2, 3}, {1, 2, 3, 4}) == Approx(4.5 / std::sqrt(22.5)));
}

TEST_CASE("What is not known is left out, and too little is not a number") {
  CHECK(Of({1, NAN, 2, 3, 9}, {1, 7, 2, 3, NAN}) == Approx(1.0));
  CHECK(std::isnan(Of({1, 2}, {1, 2})));
  CHECK(std::isnan(Of({1, 1, 1}, {1, 2, 3})));
  CHECK(std::isnan(Of({}, {})));
}

}  // namespace
}  // namespace rift::statistics
