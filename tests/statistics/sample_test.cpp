#include "rift/statistics/sample.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

namespace rift::statistics {
namespace {

TEST_CASE("Of few enough places all are looked at, in their order") {
  CHECK(SampleInOrder(0, 5).empty());
  CHECK(SampleInOrder(5, 0).empty());
  CHECK(SampleInOrder(3, 3) == std::vector<std::size_t>{0, 1, 2});
  CHECK(SampleInOrder(3, 9) == std::vector<std::size_t>{0, 1, 2});
}

TEST_CASE(
    "Of too many places just as many as wanted are picked, each once, rising, the same ones") {
  for (const std::size_t most : {1U, 7U, 500U, 999U}) {
    const std::vector<std::size_t> places = SampleInOrder(1000, most);
    CHECK(places.size() == most);
    CHECK(std::set(places.begin(), places.end()).size() == most);
    CHECK(std::is_sorted(places.begin(), places.end()));
    CHECK(places.back() < 1000);
    CHECK(SampleInOrder(1000, most) == places);
  }
}

TEST_CASE("No remainder and no part of the places is left out") {
  const std::size_t count = 21'000, most = 2'000;
  const std::vector<std::size_t> places = SampleInOrder(count, most);
  for (const std::size_t period : {2U, 3U, 10U, 21U}) {
    std::vector<double> of_remainder(period), of_part(period);
    for (const std::size_t place : places) {
      ++of_remainder[place % period];
      ++of_part[place * period / count];
    }
    const double mean = static_cast<double>(most) / static_cast<double>(period);
    for (std::size_t i = 0; i < period; ++i) {
      INFO(period << " " << i);
      CHECK(std::abs(of_remainder[i] - mean) < 4.0 * std::sqrt(mean));
      CHECK(std::abs(of_part[i] - mean) < 4.0 * std::sqrt(mean));
    }
  }
}

}  // namespace
}  // namespace rift::statistics
