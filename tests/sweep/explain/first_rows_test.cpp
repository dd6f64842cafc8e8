// Which trials of each setting are looked at where some were repeated more often than others.
#include "sweep/explain/first_rows.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <vector>

#include "sweep/explain/effect_rows.hpp"

namespace rift::sweep {
namespace {

/// The trials of so many settings in turn: first one of each, then the second of each that has one.
SweepResult Repeated(const std::vector<int>& counts) {
  SweepResult result;
  for (int repeat = 0; repeat < 100; ++repeat) {
    for (size_t setting = 0; setting < counts.size(); ++setting) {
      if (repeat >= counts[setting]) continue;
      result.rows.push_back(Row({experiment::NumberValue(static_cast<double>(setting))}, 0.01));
    }
  }
  return result;
}

std::vector<int> AllRows(const SweepResult& result) {
  std::vector<int> rows(result.rows.size());
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

/// How many trials of each setting are left.
std::vector<int> Left(const std::vector<int>& counts, bool is_search, int& most_of_setting) {
  SweepResult result = Repeated(counts);
  if (is_search) result.falsification.emplace();
  const FirstRows first = FirstOfEachSetting(result, AllRows(result));
  most_of_setting = first.most_of_setting;
  std::vector<int> left(counts.size(), 0);
  for (const int row : first.rows) {
    ++left[static_cast<size_t>(*result.rows[static_cast<size_t>(row)].theta[0].number)];
  }
  CHECK(std::is_sorted(first.rows.begin(), first.rows.end()));
  return left;
}

TEST_CASE(
    "Of a search as many trials of each setting as the median one has, of a grid twice that") {
  int most = -1;
  CHECK(Left({10, 1, 3}, true, most) == std::vector<int>{3, 1, 3});
  CHECK(most == 3);
  CHECK(Left({10, 1, 3}, false, most) == std::vector<int>{6, 1, 3});
  CHECK(most == 6);
  // Of two in the middle the smaller one.
  CHECK(Left({10, 4, 1, 3}, true, most) == std::vector<int>{3, 3, 1, 3});
  CHECK(most == 3);
  CHECK(Left({7, 7, 2, 2, 8, 2}, false, most) == std::vector<int>{4, 4, 2, 2, 4, 2});
  CHECK(most == 4);
  CHECK(Left({5}, true, most) == std::vector<int>{5});
  CHECK(most == 0);  // none is left out
  CHECK(Left({6, 3, 3}, false, most) == std::vector<int>{6, 3, 3});
  CHECK(most == 0);
  CHECK(Left({7, 3, 3}, false, most) == std::vector<int>{6, 3, 3});
  CHECK(most == 6);
}

TEST_CASE("Without rows there are none of each setting, and rows not given are not counted") {
  const SweepResult result = Repeated({4, 1});
  const FirstRows none = FirstOfEachSetting(result, {});
  CHECK(none.rows.empty());
  CHECK(none.most_of_setting == 0);
  // Two of four trials of the first setting: as many as twice those of the other.
  CHECK(FirstOfEachSetting(result, {1, 2, 4}).rows == std::vector<int>{1, 2, 4});
  CHECK(FirstOfEachSetting(result, {0, 1, 2, 3}).rows == std::vector<int>{0, 1, 2});
}

}  // namespace
}  // namespace rift::sweep
