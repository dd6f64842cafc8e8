#include "rift/sweep/falsify/distinct_rows.hpp"

#include <catch2/catch.hpp>
#include <numeric>
#include <string>

#include "sweep/falsify/rows.hpp"

namespace rift::sweep {
namespace {

using Rows = std::vector<TrialRow>;

TrialRow At(TrialRow row, const std::vector<int>& values, const std::string& trial = "1",
            std::optional<std::uint64_t> seed = {}) {
  for (const int value : values) {
    row.theta.push_back({std::to_string(value), static_cast<double>(value)});
  }
  row.trial = trial;
  row.seed = seed;
  return row;
}

std::vector<int> Distinct(const Rows& rows) {
  std::vector<int> all(rows.size());
  std::iota(all.begin(), all.end(), 0);
  return DistinctRows(rows, all);
}

bool AreCopies(const TrialRow& a, const TrialRow& b) { return Distinct({a, b}).size() == 1; }

TEST_CASE("Copies have the same path, the same gap and the same end") {
  CHECK(AreCopies(Ok(0.05, 7), Ok(0.05, 7)));
  CHECK_FALSE(AreCopies(Ok(0.05, 7), Ok(0.05, 8)));
  CHECK_FALSE(AreCopies(Ok(0.05, 0), Ok(0.05, 0)));  // nothing is known of their paths
  CHECK_FALSE(AreCopies(Ok(0.05, 7), Ok(0.051, 7)));
  CHECK(AreCopies(Failed(0.5, 7), Failed(0.5, 7)));
  CHECK_FALSE(AreCopies(Failed(0.5, 0), Failed(0.5, 0)));
  CHECK_FALSE(AreCopies(Failed(0.5, 7), Ok(0.05, 7)));
  TrialRow fell = Failed(0.5, 7);
  fell.status = TrialStatus::kFell;
  CHECK_FALSE(AreCopies(Failed(0.5, 7), fell));
  TrialRow uncounted = Failed(0.5, 7);
  uncounted.falsified = false;
  CHECK_FALSE(AreCopies(Failed(0.5, 7), uncounted));
  CHECK(AreCopies(uncounted, uncounted));
}

TEST_CASE(
    "Of copies the first stands, in the order asked for, and rows without a path stand each") {
  const Rows rows{Ok(0.05, 7), Ok(0.05, 7), Ok(0.06, 7), Ok(0.01, 0),
                  Ok(0.01, 0), Ok(0.06, 7), Ok(0.05, 9), Ok(0.05, 7)};
  CHECK(DistinctRows(rows, {0, 1, 2, 3, 4, 5, 6, 7}) == std::vector<int>{0, 2, 3, 4, 6});
  CHECK(DistinctRows(rows, {7, 5, 1}) == std::vector<int>{7, 5});
  CHECK(DistinctRows(rows, {}).empty());
}

TEST_CASE("Repeats with seeds of their own are one run where all are the same, else a draw each") {
  const auto repeat = [](const TrialRow& row, std::uint64_t seed) {
    return At(row, {3}, std::to_string(seed), seed);
  };
  Rows rows;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) rows.push_back(repeat(Ok(0.05, 7), seed));
  CHECK(Distinct(rows) == std::vector<int>{0});
  rows.push_back(repeat(Failed(0.5, 8), 7));
  rows.push_back(repeat(Failed(0.5, 8), 8));
  CHECK(Distinct(rows).size() == 8);
  rows.push_back(rows.back());  // the same seed again
  CHECK(Distinct(rows).size() == 8);
  // Another setting without chance beside it is one run, and of a search all trials are named 1.
  for (std::uint64_t seed = 1; seed <= 3; ++seed) rows.push_back(At(Ok(0.02, 9), {4}, "1", seed));
  CHECK(Distinct(rows).size() == 9);
  // Asked about the first six alone, chance is not seen to act.
  CHECK(DistinctRows(rows, {0, 1, 2, 3, 4, 5}) == std::vector<int>{0});
}

TEST_CASE("A log that was copied is no second repeat, however many others there are") {
  const Rows rows{At(Ok(0.05, 7), {1}, "1"), At(Ok(0.04, 7), {1}, "2"), At(Ok(0.05, 7), {1}, "3")};
  CHECK(Distinct(rows) == std::vector<int>{0, 1});
}

TEST_CASE("A parameter that does nothing adds no run, whichever it is and whatever is between") {
  Rows rows;
  for (const int a : {0, 1}) {
    for (const int inert : {5, 6, 7}) {
      for (const int also : {0, 1}) {
        for (const std::uint64_t seed : {1, 2}) {
          const std::uint64_t path = 10 * static_cast<std::uint64_t>(a) + seed;
          rows.push_back(At(Ok(0.01 * static_cast<double>(path), path), {inert, a, also},
                            std::to_string(seed), seed));
        }
      }
    }
  }
  CHECK(Distinct(rows) == std::vector<int>{0, 1, 12, 13});
  // It does something at one value of the other.
  for (TrialRow& row : rows) {
    if (row.theta[1].number == 1.0 && row.theta[0].number == 7.0) row.evidence.fingerprint += 100;
  }
  CHECK(Distinct(rows).size() == 6);
}

TEST_CASE(
    "Trials of one noise count once where every trial of the two settings came out the same") {
  // A parameter that makes a fixed path fail more often: half of the trials come out alike.
  Rows rows;
  for (const int share : {0, 5}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const TrialRow end = share > 0 && seed % 2 == 0 ? Failed(0.5, 7) : Ok(0.02, 7);
      rows.push_back(At(end, {share}, std::to_string(seed), seed));
    }
  }
  CHECK(Distinct(rows).size() == 7);  // those of the first setting are one run
  std::vector<int> all(rows.size());
  std::iota(all.begin(), all.end(), 0);
  CHECK(DistinctRows(rows, all, true) == all);
  // A third setting that comes out as the second is no other than it.
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    rows.push_back(
        At(seed % 2 == 0 ? Failed(0.5, 7) : Ok(0.02, 7), {6}, std::to_string(seed), seed));
  }
  CHECK(Distinct(rows).size() == 7);
}

TEST_CASE("Repeats that are the same are draws where chance picks among a few runs") {
  const Rows rows{At(Ok(0.02, 7), {1}, "1", 1), At(Ok(0.02, 7), {1}, "2", 2)};
  CHECK(DistinctRows(rows, {0, 1}, true) == std::vector<int>{0, 1});
  CHECK(DistinctRows(rows, {0, 1}, false) == std::vector<int>{0});
}

TEST_CASE("Settings that differ in two parameters may meet by chance, and both count") {
  // 2 a + b over three values each: (1, 3) and (2, 1) drive one path, as do (2, 3) and (3, 1).
  Rows rows;
  for (const int a : {1, 2, 3}) {
    for (const int b : {1, 2, 3}) {
      const int path = 2 * a + b;
      rows.push_back(At(Ok(0.01 * path, static_cast<std::uint64_t>(path)), {a, b}, "1", 4));
    }
  }
  CHECK(Distinct(rows).size() == 9);
  // And so do two that differ in one and in their noise.
  CHECK_FALSE(AreCopies(At(Ok(0.05, 7), {1}, "1", 4), At(Ok(0.05, 7), {2}, "1", 5)));
  CHECK_FALSE(AreCopies(At(Ok(0.05, 7), {1}, "1", 4), At(Ok(0.05, 7), {2}, "2", 4)));
  CHECK(AreCopies(At(Ok(0.05, 7), {1}, "1", 4), At(Ok(0.05, 7), {2}, "1", 4)));
}

TEST_CASE("Rows that count are the distinct ones with a loss") {
  SweepResult result;
  TrialRow missing;
  missing.status = TrialStatus::kMissing;
  result.rows = {missing, Ok(0.05, 7), Ok(0.05, 7), Failed(0.1, 3), Failed(0.1, 3), Ok(0.02)};
  CHECK(RowsThatCount(result) == std::vector<int>{1, 3, 5});
}

TEST_CASE("Any trial that parts two settings parts them, the first as the last, whoever is worse") {
  // Two settings of two trials; of one of these the gap is another, on the same path.
  for (const int parting : {0, 1}) {
    for (const double other_m : {0.03, 0.05}) {
      Rows rows;
      for (const int setting : {0, 1}) {
        for (const int trial : {0, 1}) {
          const bool is_other = setting == 1 && trial == parting;
          rows.push_back(At(Ok(is_other ? other_m : 0.04, static_cast<std::uint64_t>(7 + trial)),
                            {setting}, std::to_string(trial), static_cast<std::uint64_t>(trial)));
        }
      }
      CAPTURE(parting, other_m);
      CHECK(Distinct(rows) == std::vector<int>{0, 1, 2, 3});
      rows[static_cast<size_t>(2 + parting)].comparison.gap_m = 0.04;
      CHECK(Distinct(rows) == std::vector<int>{0, 1});
      // Another path with the same gap does, too.
      rows[static_cast<size_t>(2 + parting)].evidence.fingerprint = 9;
      CHECK(Distinct(rows) == std::vector<int>{0, 1, 2, 3});
    }
  }
}

TEST_CASE("Settings are told apart by the trials that both of them have") {
  const TrialRow one = At(Ok(0.05, 7), {1}, "1", 1), more = At(Ok(0.04, 8), {1}, "2", 2),
                 alone = At(Ok(0.05, 7), {2}, "1", 1);
  CHECK(Distinct({one, more, alone}) == std::vector<int>{0, 1});
  CHECK(Distinct({alone, one, more}) == std::vector<int>{0, 2});
  CHECK(Distinct({one, alone, more}) == std::vector<int>{0, 2});
}

TEST_CASE("A whole sweep leaves out repeats that are the same unless chance may bring them again") {
  SweepResult result;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    result.rows.push_back(At(Ok(0.05, 7), {1}, std::to_string(seed), seed));
  }
  CHECK(RowsThatCount(result) == std::vector<int>{0});
  result.chance_repeats_runs = true;
  CHECK(RowsThatCount(result) == std::vector<int>{0, 1, 2});
}

}  // namespace
}  // namespace rift::sweep
