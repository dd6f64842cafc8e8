// Which row of a sweep is shrunk, with which random numbers, and what a person reads of values.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {
namespace {

using Catch::Matchers::Contains;

experiment::ParameterValue Number(double number) { return experiment::NumberValue(number); }

TrialRow Row(double gap_m) {
  TrialRow row{.theta = {Number(0.25), Number(0.5)}, .trial = "2", .seed = 41};
  row.comparison.gap_m = gap_m;
  row.falsified = gap_m > 0.06;
  return row;
}

SweepResult Four() {
  SweepResult result;
  result.parameters = {{.key = "control.v_min", .min = 0.0, .max = 1.0},
                       {.key = "control.w_max", .min = 0.0, .max = 1.0}};
  result.rows = {Row(0.02), Row(0.07), Row(0.09), Row(0.08)};
  result.rows[3].status = TrialStatus::kCrashed;
  result.rows[3].falsified = false;
  return result;
}

TEST_CASE("A row is named by its number in the table, or as the worst") {
  const SweepResult result = Four();
  CHECK(FailingRow(result, "2") == 1);
  CHECK(FailingRow(result, "3") == 2);
  CHECK(FailingRow(result, "worst") == 2);
}

TEST_CASE("A row that is not there or does not fail is refused with what it did") {
  const SweepResult result = Four();
  for (const char* id : {"0", "5", "-1", "2.0", "2 ", "", "Worst", "99999999999999999999999"}) {
    INFO(id);
    CHECK_THROWS_WITH(FailingRow(result, id),
                      std::string("--shrink ") + id + ": table.csv has the rows 1 to 4");
  }
  CHECK_THROWS_WITH(FailingRow(result, "1"),
                    "--shrink 1: row 1 does not fail (its gap is 0.0200 m, and above 0.06 m "
                    "falsifies); --shrink worst takes the worst");
  CHECK_THROWS_WITH(FailingRow(result, "4"),
                    "--shrink 4: row 4 does not fail (it ended as 'crashed', and above 0.06 m "
                    "falsifies); --shrink worst takes the worst");
}

TEST_CASE("Where nothing fails or nothing tells the worst cannot be shrunk") {
  SweepResult result = Four();
  result.rows = {Row(0.02), Row(0.05)};
  CHECK_THROWS_WITH(FailingRow(result, "worst"),
                    "--shrink worst: row 2 does not fail (its gap is 0.0500 m, and above 0.06 m "
                    "falsifies): nothing of this sweep can be shrunk");
  for (TrialRow& row : result.rows) row.status = TrialStatus::kMissing;
  CHECK_THROWS_WITH(FailingRow(result, "worst"), "--shrink worst: no trial has a gap");
}

TEST_CASE("A failure without a gap is the worst where no gap fails") {
  SweepResult result = Four();
  result.rows = {Row(0.02), Row(0.05), Row(0.05)};
  result.rows[2].status = TrialStatus::kFell;
  result.rows[2].falsified = true;
  CHECK(FailingRow(result, "worst") == 2);
}

TEST_CASE("A row is shrunk with its repeat and random numbers, and its claims are run") {
  experiment::Experiment experiment;
  experiment.control.v_min = 0.125;
  experiment.control.w_max = 0.5;
  SweepResult result = Four();
  experiment.space.parameters = result.parameters;
  for (TrialRow& row : result.rows) row.theta = {Number(0.625), Number(0.75)};
  result.gap.threshold_m = 0.05;
  int runs = 0;
  const RunAllTrials run = [&](const std::vector<TrialRequest>& requests) {
    std::vector<TrialRow> rows;
    for (const TrialRequest& request : requests) {
      ++runs;
      CHECK(request.trial == "2");
      CHECK(request.seed == 41u);
      TrialRow row{.theta = request.theta, .trial = request.trial, .seed = request.seed};
      row.comparison.gap_m = 0.1 * *request.theta[0].number;  // fails above v_min = 0.5
      row.falsified = row.comparison.gap_m > 0.05;
      rows.push_back(row);
    }
    return rows;
  };
  const ShrunkRow shrunk = ShrinkRow(experiment, result, 2, {}, run);
  CHECK(shrunk.id == 3);
  CHECK(shrunk.nominal == experiment::Theta{Number(0.125), Number(0.5)});
  CHECK(shrunk.shrunk.changed == std::vector<int>{0});
  CHECK(*shrunk.shrunk.theta[0].number > 0.5);
  CHECK(*shrunk.shrunk.theta[0].number <= 0.5 + 0.02 * 0.5);
  CHECK(shrunk.shrunk.robustness == Approx(0.05 - 0.1 * *shrunk.shrunk.theta[0].number));
  REQUIRE(shrunk.rows.size() == 3);  // the row, the shrunk one, and that without its change
  CHECK(*shrunk.rows[0].theta[0].number == 0.625);
  CHECK(*shrunk.rows[0].theta[1].number == 0.75);
  CHECK(shrunk.rows[1].theta == shrunk.shrunk.theta);
  CHECK(shrunk.rows[2].theta == shrunk.nominal);
  CHECK(runs == shrunk.shrunk.evaluations + 3);
}

TEST_CASE("A change downwards is shrunk upwards, values have six digits, no setting runs twice") {
  const std::vector<experiment::Parameter> space{
      {.key = "x", .min = 0.0, .max = 1.0},
      {.key = "n", .levels = {{"9", 9.0}, {"1", 1.0}, {"5", 5.0}, {"3", 3.0}, {"11", 11.0}}}};
  const experiment::Theta nominal{Number(0.9), {"9", 9.0}}, failing{Number(0.1), {"1", 1.0}};
  std::set<experiment::Theta> asked;
  int runs = 0;
  const Robustness robustness = [&](const experiment::Theta& theta) {
    ++runs;
    CHECK(asked.insert(theta).second);
    return *theta[0].number < 0.4321 && *theta[1].number < 4.0 ? -0.5 : 0.5;
  };
  const ShrunkFailure shrunk = Shrink(space, nominal, failing, robustness, {.tolerance = 1e-4});
  CHECK(*shrunk.theta[0].number < 0.4321);
  CHECK(*shrunk.theta[0].number > 0.4321 - 1e-4 * 0.8 - 1e-6);
  CHECK(shrunk.theta[0].text.size() <= 8);  // 0.xxxxxx
  CHECK(shrunk.theta[1].text == "3");
  CHECK(shrunk.evaluations == runs);
  CHECK(shrunk.changed == std::vector<int>{0, 1});
  CHECK(shrunk.is_minimal);
}

TEST_CASE("A failure at the experiment's own values has no change left") {
  const std::vector<experiment::Parameter> space{{.key = "x", .min = 0.0, .max = 1.0}};
  const ShrunkFailure shrunk =
      Shrink(space, {Number(0.5)}, {Number(0.9)}, [](const experiment::Theta&) { return -0.25; });
  CHECK(shrunk.changed.empty());
  CHECK(shrunk.theta[0].text == "0.5");
  CHECK(shrunk.is_fewest);
  CHECK(shrunk.is_minimal);
  CHECK(shrunk.evaluations == 2);
  CHECK(shrunk.robustness == -0.25);
}

TEST_CASE("A gap at the threshold holds") {
  const std::vector<experiment::Parameter> space{{.key = "x", .min = 0.0, .max = 1.0}};
  CHECK_THROWS_WITH(
      Shrink(space, {Number(0.5)}, {Number(0.9)}, [](const experiment::Theta&) { return 0.0; }),
      Contains("nothing to shrink") && Contains("robustness 0 m"));
}

TEST_CASE("Sets of changes are tried by size, then each value by halves until it is near enough") {
  std::vector<std::string> tried;
  const std::vector<experiment::Parameter> words{{.key = "a", .levels = {{"-", {}}, {"A", {}}}},
                                                 {.key = "b", .levels = {{"-", {}}, {"B", {}}}},
                                                 {.key = "c", .levels = {{"-", {}}, {"C", {}}}}};
  const experiment::Theta none{{"-", {}}, {"-", {}}, {"-", {}}};
  const ShrunkFailure two =
      Shrink(words, none, {{"A", {}}, {"B", {}}, {"C", {}}}, [&](const experiment::Theta& theta) {
        tried.push_back(theta[0].text + theta[1].text + theta[2].text);
        return theta[1].text == "B" && theta[2].text == "C" ? -0.1 : 0.1;
      });
  CHECK(tried == std::vector<std::string>{"ABC", "---", "A--", "-B-", "--C", "AB-", "A-C", "-BC"});
  CHECK(two.changed == std::vector<int>{1, 2});
  CHECK(two.evaluations == 8);
  CHECK(two.is_fewest);

  std::vector<double> values;
  const auto above = [&](const experiment::Theta& theta) {
    values.push_back(*theta[0].number);
    return *theta[0].number > 0.42 ? -0.1 : 0.1;
  };
  const std::vector<experiment::Parameter> range{{.key = "x", .min = 0.0, .max = 1.0}};
  const ShrunkFailure near = Shrink(range, {Number(0.0)}, {Number(1.0)}, above, {.tolerance = 0.1});
  // To a tenth of the change, and to a tenth of what is left of it once more.
  const double expected[] = {1.0,    0.0,     0.5,      0.25,     0.375,
                             0.4375, 0.21875, 0.328125, 0.382812, 0.410156};
  REQUIRE(values.size() == 10);
  for (size_t i = 0; i < 10; ++i) CHECK(values[i] == Approx(expected[i]).epsilon(1e-5));
  CHECK(*near.theta[0].number == 0.4375);
}

TEST_CASE(
    "Of many changes, those that are needless by themselves leave few enough sets to be tried") {
  std::vector<experiment::Parameter> space;
  experiment::Theta nominal, failing;
  for (int i = 0; i < 12; ++i) {
    space.push_back({.key = std::string(1, static_cast<char>('a' + i)), .min = 0.0, .max = 1.0});
    nominal.push_back(Number(0.0));
    failing.push_back(Number(1.0));
  }
  const auto far = [](const experiment::Theta& theta, size_t i) { return *theta[i].number > 0.5; };
  const ShrunkFailure four = Shrink(space, nominal, failing, [&](const experiment::Theta& theta) {
    return far(theta, 8) && far(theta, 9) && far(theta, 10) && far(theta, 11) ? -0.1 : 0.1;
  });
  CHECK(four.changed == std::vector<int>{8, 9, 10, 11});
  CHECK(four.is_minimal);
  CHECK_FALSE(four.is_fewest);  // 299 sets of three and fewer
  CHECK(four.evaluations < 400);
  for (const int i : four.changed) CHECK(*four.theta[i].number == Approx(0.5).margin(0.02));
  // Taken back one by one the changes end at b and c; a alone is fewer, and found.
  const ShrunkFailure one = Shrink(space, nominal, failing, [&](const experiment::Theta& theta) {
    return far(theta, 0) || (far(theta, 1) && far(theta, 2)) ? -0.1 : 0.1;
  });
  CHECK(one.changed == std::vector<int>{0});
  CHECK(one.is_fewest);
  CHECK(one.is_minimal);
  // Two of four changes fail where three do not: only sets of what is left find it.
  const ShrunkFailure two = Shrink(space, nominal, failing, [&](const experiment::Theta& theta) {
    int of_four = 0;
    for (size_t i = 8; i < 12; ++i) of_four += far(theta, i);
    return of_four == 4 || (of_four == 2 && far(theta, 8) && far(theta, 11)) ? -0.1 : 0.1;
  });
  CHECK(two.changed == std::vector<int>{8, 11});
  CHECK(two.is_minimal);
  CHECK_FALSE(two.is_fewest);
}

TEST_CASE("A change that a smaller one makes needless is taken back") {
  const std::vector<experiment::Parameter> space{{.key = "x", .min = 0.0, .max = 1.0},
                                                 {.key = "y", .levels = {{"off", {}}, {"on", {}}}}};
  const Robustness robustness = [](const experiment::Theta& theta) {
    const double x = *theta[0].number;
    return (x > 0.9 && theta[1].text == "on") || (x > 0.3 && x < 0.6) ? -0.1 : 0.1;
  };
  const ShrunkFailure shrunk =
      Shrink(space, {Number(0.0), {"off", {}}}, {Number(1.0), {"on", {}}}, robustness);
  CHECK(shrunk.changed == std::vector<int>{0});
  CHECK(shrunk.theta[1].text == "off");
  CHECK(*shrunk.theta[0].number == Approx(0.3).margin(0.02));
  CHECK(robustness(shrunk.theta) < 0.0);
  CHECK(shrunk.is_minimal);
}

TEST_CASE("Of a list the values between one's own and the failing one are tried, and no others") {
  const std::vector<experiment::Parameter> space{
      {.key = "n", .levels = {{"4", 4.0}, {"5", 5.0}, {"9", 9.0}, {"7", 7.0}, {"10", 10.0}}}};
  std::vector<std::string> tried;
  const ShrunkFailure shrunk =
      Shrink(space, {{"5", 5.0}}, {{"9", 9.0}}, [&](const experiment::Theta& theta) {
        tried.push_back(theta[0].text);
        return *theta[0].number == 5.0 ? 0.1 : -0.1;
      });
  CHECK(shrunk.theta[0].text == "7");
  CHECK(tried == std::vector<std::string>{"9", "5", "7"});
}

TEST_CASE("No more trials are spent than may be, and what is claimed of the rest was tried") {
  const std::vector<experiment::Parameter> space{
      {.key = "x", .min = 0.0, .max = 1.0},
      {.key = "n", .levels = {{"1", 1.0}, {"2", 2.0}, {"3", 3.0}, {"4", 4.0}}},
      {.key = "w", .levels = {{"a", {}}, {"b", {}}}}};
  const experiment::Theta nominal{Number(0.0), {"1", 1.0}, {"a", {}}};
  const auto fails = [](const experiment::Theta& theta) {
    return *theta[0].number > 0.42 && *theta[1].number >= 3.0;
  };
  int minimal = 0;
  for (int budget = 1; budget <= 40; ++budget) {
    INFO(budget);
    int runs = 0;
    const ShrunkFailure shrunk = Shrink(space, nominal, {Number(1.0), {"4", 4.0}, {"b", {}}},
                                        [&](const experiment::Theta& theta) {
                                          ++runs;
                                          return fails(theta) ? -0.1 : 0.1;
                                        },
                                        {.max_evaluations = budget});
    CHECK(runs <= budget);
    CHECK(shrunk.evaluations == runs);
    CHECK(fails(shrunk.theta));
    minimal += shrunk.is_minimal;
    if (shrunk.is_minimal) CHECK(shrunk.changed == std::vector<int>{0, 1});
  }
  CHECK(minimal > 0);
}

}  // namespace
}  // namespace rift::sweep
