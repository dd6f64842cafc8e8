#include "rift/sweep/explain/clusters.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rift::sweep {
namespace {

/// A failure whose errors grow evenly to (x, y) at the end.
TrialRow Failure(double x_m, double y_m, const char* level = "a") {
  TrialRow row;
  row.theta = {{level, {}}};
  row.falsified = true;
  row.comparison.gap_m = std::hypot(x_m, y_m);
  row.comparison.gap_u = 0.5;
  for (int k = 1; k <= 8; ++k) row.evidence.errors_m.push_back({x_m * k / 8.0, y_m * k / 8.0});
  return row;
}

TrialRow Passing(const char* level = "b") {
  TrialRow row = Failure(0.0, 0.01, level);
  row.falsified = false;
  return row;
}

TrialRow Ended(TrialStatus status, const char* level = "a", bool is_failure = true) {
  TrialRow row;
  row.theta = {{level, {}}};
  row.status = status;
  row.falsified = is_failure;
  return row;
}

SweepResult Of(std::vector<TrialRow> rows) {
  SweepResult result;
  result.parameters = {{.key = "sim.surface", .levels = {{"a", {}}, {"b", {}}}}};
  result.rows = std::move(rows);
  Summarise(result);
  return result;
}

TEST_CASE("The rows of a kind stand from the most typical to the least") {
  const SweepResult result = Of({Failure(0.0, 0.10), Passing(), Failure(0.0, 0.13),
                                 Failure(0.0, 0.121), Failure(0.0, 0.125)});
  const std::vector<FailureCluster> clusters = ClusterFailures(result, {.most_clusters = 1});
  REQUIRE(clusters.size() == 1);
  // Their mean is 0.119.
  CHECK(clusters[0].rows == std::vector<int>{3, 4, 2, 0});
  CHECK(clusters[0].mean_gap_m == Approx(0.119));
  CHECK(clusters[0].mean_u == Approx(0.5));
  CHECK(clusters[0].end_error_m.x() == Approx(0.0).margin(1e-12));
  CHECK(clusters[0].end_error_m.y() == Approx(0.119));
}

TEST_CASE("A kind is told with its number, gap, place, error at the end and where it happens") {
  const SweepResult result = Of({Failure(0.06, -0.08), Failure(0.06, -0.08), Passing(), Passing()});
  CHECK(ClusterFailures(result)[0].sentence ==
        "2 with a mean gap of 0.100 m at u = 0.50; at the end the reference lies +0.060 m in x and "
        "-0.080 m in y from the candidate; mostly at surface a (2 of 2)");
}

TEST_CASE("Three kinds that lie apart are three, the largest first") {
  std::vector<TrialRow> rows;
  for (int i = 0; i < 3; ++i) rows.push_back(Failure(0.1 + 0.001 * i, 0.0));
  for (int i = 0; i < 5; ++i) rows.push_back(Failure(0.0, 0.2 + 0.001 * i));
  for (int i = 0; i < 4; ++i) rows.push_back(Failure(-0.3 + 0.001 * i, 0.0));
  const SweepResult result = Of(rows);
  const std::vector<FailureCluster> clusters = ClusterFailures(result);
  REQUIRE(clusters.size() == 3);
  CHECK(clusters[0].rows.size() == 5);
  CHECK(clusters[1].rows.size() == 4);
  CHECK(clusters[2].rows.size() == 3);
  CHECK(clusters[0].end_error_m.y() == Approx(0.202));
  CHECK(clusters[1].end_error_m.x() == Approx(-0.2985));
  CHECK(clusters[2].end_error_m.x() == Approx(0.101));
  CHECK(ClusterFailures(result, {.most_clusters = 2}).size() == 2);
  CHECK(ClusterFailures(result, {.least_silhouette = 0.9999}).size() == 1);
}

TEST_CASE("Kinds are found with some of many failures, and every failure belongs to one") {
  std::vector<TrialRow> rows;
  for (int i = 0; i < 40; ++i) rows.push_back(Failure(i % 2 == 0 ? 0.1 : -0.1, 0.0001 * i));
  for (const int most_compared : {14, 20}) {  // of every second one half would be seen
    const std::vector<FailureCluster> clusters =
        ClusterFailures(Of(rows), {.most_compared = most_compared});
    REQUIRE(clusters.size() == 2);
    for (const FailureCluster& one : clusters) {
      CHECK(one.rows.size() == 20);
      for (const int row : one.rows) CHECK(row % 2 == one.rows.front() % 2);
    }
  }
}

TEST_CASE("Every end of a run that counts as a failure is a kind of its own, and no other end") {
  const SweepResult result =
      Of({Ended(TrialStatus::kFell), Ended(TrialStatus::kMissing, "a", false),
          Ended(TrialStatus::kLost), Ended(TrialStatus::kFault, "a", false),
          Ended(TrialStatus::kLost, "b"), Ended(TrialStatus::kLost, "b", false)});
  const std::vector<FailureCluster> clusters = ClusterFailures(result);
  REQUIRE(clusters.size() == 2);
  CHECK(clusters[0].status == TrialStatus::kLost);
  CHECK(clusters[0].rows == std::vector<int>{2, 4});
  CHECK(clusters[0].sentence == "2 ended as 'lost', at no particular value of a parameter");
  CHECK(std::isnan(clusters[0].mean_gap_m));
  CHECK(clusters[1].status == TrialStatus::kFell);
}

TEST_CASE("A value stands out with 60 % of the failures, and a quarter more than in the table") {
  const auto where_of = [](int failing_a, int failing_b, int passing_a, int passing_b) {
    std::vector<TrialRow> rows;
    for (int i = 0; i < failing_a; ++i) rows.push_back(Failure(0.1, 0.0, "a"));
    for (int i = 0; i < failing_b; ++i) rows.push_back(Failure(0.1, 0.0, "b"));
    for (int i = 0; i < passing_a; ++i) rows.push_back(Passing("a"));
    for (int i = 0; i < passing_b; ++i) rows.push_back(Passing("b"));
    const std::string sentence = ClusterFailures(Of(rows))[0].sentence;
    return sentence.substr(sentence.rfind("; ") + 2);
  };
  const std::string none = "at no particular value of a parameter";
  CHECK(where_of(6, 4, 0, 10) == "mostly at surface a (6 of 10)");  // twice as often
  CHECK(where_of(12, 8, 0, 20) == "mostly at surface a (12 of 20)");
  CHECK(where_of(11, 9, 0, 20) == none);                           // 55 %
  CHECK(where_of(4, 0, 12, 4) == "mostly at surface a (4 of 4)");  // 100 % of usually 80 %
  CHECK(where_of(4, 0, 13, 4) == none);                            // of usually 81 %
  CHECK(where_of(1, 9, 10, 0) == "mostly at surface b (9 of 10)");
}

TEST_CASE("Values of a range are no place, and failures without errors are left out") {
  SweepResult result = Of({Failure(0.1, 0.0), Failure(0.1, 0.0)});
  result.parameters[0].levels.clear();
  CHECK(ClusterFailures(result)[0].sentence.ends_with("; at no particular value of a parameter"));
  result.rows[0].evidence.errors_m.clear();
  CHECK(ClusterFailures(result)[0].rows == std::vector<int>{1});
  result.rows[1].falsified = false;
  CHECK(ClusterFailures(result).empty());
}

TEST_CASE("Kinds are told apart above a mean silhouette, in which a failure alone counts nothing") {
  const auto kinds = [](const std::vector<double>& ends_m, double least) {
    std::vector<TrialRow> rows;
    for (const double end_m : ends_m) rows.push_back(Failure(end_m, 0.0));
    return ClusterFailures(Of(rows), {.least_silhouette = least}).size();
  };
  // By hand, of each failure: (way to the others - way within its kind) / way to the others.
  const double of_pairs = (10.0 / 11.0 + 9.0 / 10.0 + 7.5 / 9.5 + 9.5 / 11.5) / 4.0;
  CHECK(kinds({0.0, 0.01, 0.1, 0.12}, of_pairs - 1e-9) == 2);
  CHECK(kinds({0.0, 0.01, 0.1, 0.12}, of_pairs + 1e-9) == 1);
  // Three that lie far apart are found where any two of them together would be no kind.
  CHECK(kinds({0.0, 0.001, 0.1, 0.101, 0.2, 0.201}, 0.9) == 3);
  const double of_one_alone = (9.0 / 10.0 + 8.0 / 9.0 + 0.0) / 3.0;
  CHECK(kinds({0.0, 0.01, 0.1}, of_one_alone - 1e-9) == 2);
  CHECK(kinds({0.0, 0.01, 0.1}, of_one_alone + 1e-9) == 1);
}

TEST_CASE("Failures that go astray at the first place alone are kinds of their own") {
  std::vector<TrialRow> rows;
  for (const double first_m : {0.3, 0.3, -0.3, -0.3}) {
    rows.push_back(Failure(0.1, 0.0));
    rows.back().evidence.errors_m.front() = {first_m, 0.0};
  }
  const std::vector<FailureCluster> clusters = ClusterFailures(Of(rows));
  REQUIRE(clusters.size() == 2);
  CHECK(clusters[0].rows.size() == 2);
}

TEST_CASE("A value of a list stands out behind a range, too") {
  SweepResult result = Of({Failure(0.1, 0.0), Failure(0.1, 0.0), Passing(), Passing()});
  result.parameters.insert(result.parameters.begin(),
                           experiment::Parameter{.key = "mu", .min = 0.0, .max = 1.0});
  for (TrialRow& row : result.rows) {
    row.theta.insert(row.theta.begin(), experiment::ParameterValue{"0.5", 0.5});
  }
  CHECK(ClusterFailures(result)[0].sentence.ends_with("; mostly at surface a (2 of 2)"));
}

TEST_CASE("Kinds are those whose centres have come to rest") {
  // Halves of the way from 0 to 1 first; the bound between them moves past 0.44, then past 0.37.
  std::vector<TrialRow> rows(10, Failure(0.0, 0.0));
  for (const double end_m : {0.37, 0.44, 0.6, 1.0}) rows.push_back(Failure(end_m, 0.0));
  const std::vector<FailureCluster> clusters = ClusterFailures(Of(rows), {.most_clusters = 2});
  REQUIRE(clusters.size() == 2);
  CHECK(clusters[0].rows.size() == 10);
  CHECK(clusters[1].rows.size() == 4);
}

TEST_CASE("As many failures as may be compared are all compared, of one more all but one") {
  for (const size_t count : {4, 5}) {
    int unseen = 0;
    for (size_t other = 0; other < count; ++other) {  // the only one of its kind
      std::vector<TrialRow> rows(count, Failure(0.0, 0.0));
      rows[other] = Failure(0.1, 0.0);
      unseen += ClusterFailures(Of(rows), {.most_compared = 4}).size() == 1;
      CHECK(ClusterFailures(Of(rows), {.most_compared = 5}).size() == 2);
    }
    CHECK(unseen == (count == 4 ? 0 : 1));
  }
}

}  // namespace
}  // namespace rift::sweep
