#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "report/synthetic_sweep.hpp"
#include "rift/report/figures/setting_grid.hpp"
#include "rift/report/json/fields.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sweep/explain/worst_trial.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;
using nlohmann::json;

TEST_CASE("Combinations whose values hold commas are all in the summary and in the map") {
  using synthetic::Word;
  sweep::SweepResult result;
  result.parameters = {{"m", {Word("x")}},
                       {"a", {Word("oil"), Word("oil, wet")}},
                       {"b", {Word("dry"), Word("wet, dry")}}};
  for (const auto& a : result.parameters[1].levels) {
    for (const auto& b : result.parameters[2].levels) {
      result.rows.push_back(synthetic::Row({Word("x"), a, b}, "1", 0.05));
    }
  }
  sweep::Summarise(result);
  CHECK(json::parse(SummaryJson(result))["by"]["[a, b]"].size() == 4);
  const SettingGrid grid = LayOut(result);
  REQUIRE(grid.cells.size() == 1);
  REQUIRE(grid.cells[0].size() == 4);
  for (const sweep::SettingResult* setting : grid.cells[0]) CHECK(setting != nullptr);
}

TEST_CASE("A row of table.csv is read back as it was written, quotes and line breaks included") {
  sweep::SweepResult result = synthetic::Grid();
  result.rows[1].reason = "no file \"real 2.csv\",\nand no other";
  const TableRow row = TableRowOf(TableCsv(result), "2", "table.csv");
  CHECK(row.at("surface") == "ice");
  CHECK(row.at("v_min") == "0.15");
  CHECK(row.at("status") == "missing");
  CHECK(row.at("gap_m").empty());
  CHECK(row.at("reason") == result.rows[1].reason);
}

TEST_CASE("A row that table.csv does not have is refused with the ids that it has") {
  const std::string table = TableCsv(synthetic::Grid());
  CHECK_THROWS_WITH(TableRowOf(table, "25", "DIR/table.csv"),
                    Contains("DIR/table.csv has no row with id 25: its ids are 1 to 24"));
}

TEST_CASE("A damaged table.csv is refused with what is wrong and what to do") {
  const std::string name = "DIR/table.csv", table = TableCsv(synthetic::Grid());
  REQUIRE(TableRows(table).size() == 24);
  const auto check = [&](const std::string& old, const std::string& other,
                         const std::string& says) {
    std::string damaged = table;
    damaged.replace(damaged.find(old), old.size(), other);
    INFO(says);
    const std::string refused = "table.csv: " + says + ": no sweep writes that; give the command";
    CHECK_THROWS_WITH(TableRows(damaged), Contains(refused));
    CHECK_THROWS_WITH(TableRowOf(damaged, "24", name), Contains(refused));
    CHECK_THROWS_WITH(WorstIdOf(damaged, name, 0.06), Contains(refused));
  };
  check("gap_m", "gab_m", "its header does not name the column gap_m once");
  check(",status", ",trial", "its header does not name the column trial once");
  check(",ok,", ",ox,", "status of row 1 is 'ox'");
  check(",missing,", ",,", "status of row 2 is ''");
  check("false,ok", "fal,ok", "falsified of row 1 is 'fal'");
  check("false,ok", ",ok", "falsified of row 1 is ''");  // it would count as one that holds
  check(",,missing", ",false,missing", "falsified of row 2 is 'false'");
  const std::string gap_m = TableRows(table)[0].at("gap_m");
  for (const std::string other : {"", "nan", "inf", "-7"}) {
    check("," + gap_m + ",", "," + other + ",", "gap_m of row 1 is '" + other + "'");
  }
  check(",0.75,", ",nan,", "u of row 1 is 'nan'");
  check(",1\n", ",x\n", "id of row 1 is 'x'");
  check(",1\n", ",01\n", "id of row 1 is '01'");
  const size_t first = table.find('\n') + 1, second = table.find('\n', first) + 1;
  const std::string row = table.substr(first, second - first);
  check(row, "", "id of row 1 is '2'");
  check(row, row + row, "id of row 2 is '1'");
  check(",1\n", "1\n", "row 1 has 22 cells, and the header 23");
  for (size_t length = 0; length < table.size(); ++length) {
    if (length > 0 && table[length - 1] == '\n') continue;  // a row less is none that is damaged
    CHECK_THROWS_WITH(TableRows(table.substr(0, length)), Contains("is cut short"));
  }
}

TEST_CASE("The worst row of a table.csv is that of the sweep which wrote it") {
  sweep::SweepResult result;
  result.parameters = {{"case", {}}};
  const auto add = [&](double gap_m, double way_gap_m) {
    result.rows.push_back(synthetic::Row({synthetic::Word("x")}, "1", gap_m));
    result.rows.back().way_gap_m = way_gap_m;
    result.rows.back().falsified = result.rows.back().CountedGap_m() > result.gap.threshold_m;
  };
  add(0.26, 0.01);  // stops short of the goal, which is no failure
  add(0.07, 0.069);
  add(0.201, 0.2);
  const auto worst = [&] {
    const std::string id = WorstIdOf(TableCsv(result), "table.csv", result.gap.threshold_m);
    CHECK(id == std::to_string(*sweep::WorstTrialOf(result) + 1));
    return id;
  };
  CHECK(worst() == "3");
  for (const double left_m : {0.13, 0.15, gap::kNotComputed}) {
    add(0.0, 0.0);
    sweep::TrialRow& lost = result.rows.back();
    lost.comparison = {};
    lost.status = sweep::TrialStatus::kTimedOut;
    lost.falsified = true;
    lost.way_gap_m = gap::kNotComputed;
    lost.left_m = left_m;
    CHECK(worst() == (left_m == 0.15 ? "5" : left_m == 0.13 ? "3" : "5"));
  }
  result.gap.threshold_m = 0.3;
  for (sweep::TrialRow& row : result.rows) row.falsified = !row.IsOk();
  CHECK(worst() == "6");  // how far it had to go is not known: twice the threshold
}

TEST_CASE("Values of a range of few whole numbers have a summary each, in their order") {
  sweep::SweepResult result;
  result.parameters = {{.key = "n", .min = 1.0, .max = 12.0, .is_integer = true},
                       {.key = "k", .levels = {synthetic::Word("a")}}};
  for (const char* n : {"10", "2", "1", "10"}) {
    result.rows.push_back(synthetic::Row({synthetic::Numeric(n), synthetic::Word("a")}, "1", 0.05));
  }
  sweep::Summarise(result);
  using Ordered = nlohmann::ordered_json;
  const auto by = [&] { return Ordered::parse(SummaryJson(result))["by"]; };
  REQUIRE(by().contains("n"));
  std::vector<std::string> values;
  const Ordered by_n = by()["n"];
  for (const auto& [value, level] : by_n.items()) values.push_back(value);
  CHECK(values == std::vector<std::string>{"1", "2", "10"});
  CHECK(by_n["10"]["n"] == 2);
  result.parameters[0].max = 13.0;
  CHECK_FALSE(by().contains("n"));
}

TEST_CASE("A number of a damaged table.csv is never read in part") {
  const std::string table = TableCsv(synthetic::Grid());
  const size_t gap_begin = table.find(TableRows(table)[0].at("gap_m"));
  for (const char c : {'x', '-', ' ', '\0', '\xff'}) {
    std::string damaged = table;
    damaged[gap_begin + 2] = c;
    CHECK_THROWS_WITH(TableRows(damaged), Contains("gap_m of row 1 is '0."));
  }
}

TEST_CASE("A table without the column of a parameter is not that of its experiment") {
  TableRow row = TableRowOf(TableCsv(synthetic::Grid()), "1", "table.csv");
  experiment::Experiment experiment;
  experiment.space.parameters = synthetic::Grid().parameters;
  row["seed"] = "18446744073709551615";
  row["trial"] = "7 b";
  const sweep::TrialRequest request = RequestOf(experiment, row, "a/table.csv");
  CHECK(request.seed == 18446744073709551615U);
  CHECK(request.trial == "7 b");
  CHECK(request.theta == synthetic::Grid().rows[0].theta);
  row["seed"].clear();
  CHECK(RequestOf(experiment, row, "a/table.csv").seed == 0U);
  row.erase("v_max");
  CHECK_THROWS_WITH(RequestOf(experiment, row, "a/table.csv"),
                    Catch::StartsWith("a/table.csv has no column v_max"));
}

TEST_CASE("A setting has the same keys in every JSON document of a sweep") {
  const sweep::SweepResult result = synthetic::Grid();
  const json expected = {{"surface", "ice"}, {"v_min", 0.15}, {"v_max", 0.3}};
  CHECK(json(ThetaJson(result.parameters, result.rows[0].theta)) == expected);
  CHECK(json::parse(SummaryJson(result))["settings"][0]["theta"] == expected);
  sweep::ShrunkRow shrunk{.id = 24, .nominal = result.rows[0].theta};
  shrunk.shrunk.theta = result.rows.back().theta;
  shrunk.rows = {result.rows.back(), result.rows.back()};
  const json document = json::parse(ShrunkJson(result, shrunk, "DIR/shrunk"));
  CHECK(document["nominal"] == expected);
  CHECK(document["failing"]["theta"]["surface"] == "rock");
}

TEST_CASE("A number that was not computed is null in JSON") {
  CHECK(NumberOrNull(std::nan("")).is_null());
  CHECK(NumberOrNull(0.25) == 0.25);
}

TEST_CASE("A combination that holds a range has no summary of its own, nor a table") {
  using synthetic::Numeric;
  using synthetic::Word;
  sweep::SweepResult result;
  result.parameters = {{"surface", {Word("ice"), Word("mud")}},
                       {"v", {Numeric("0.1"), Numeric("0.2")}},
                       {"friction", {}, 0.2, 0.8}};
  for (int i = 0; i < 4; ++i) {
    result.rows.push_back(synthetic::Row({result.parameters[0].levels[static_cast<size_t>(i % 2)],
                                          result.parameters[1].levels[static_cast<size_t>(i / 2)],
                                          Numeric(std::to_string(0.3 + 0.1 * i))},
                                         "1", 0.05));
  }
  sweep::Summarise(result);
  const json summary = json::parse(SummaryJson(result));
  CHECK(summary["by"].size() == 2);
  CHECK(summary["by"].contains("surface"));
  CHECK(summary["by"].contains("v"));
  const std::string head = "  mean_gap_m  failures  trials  without_gap\n";
  CHECK_THAT(SweepText(result), Contains("\nsurface" + head) && !Contains("[v, friction]"));
  result.parameters[2] = {"friction", {}};
  for (const auto& row : result.rows) result.parameters[2].levels.push_back(row.theta[2]);
  CHECK(json::parse(SummaryJson(result))["by"].contains("[v, friction]"));
  CHECK_THAT(SweepText(result), Contains("\n[v, friction]"));
}

TEST_CASE("Without a gap nothing is said of what makes it, and of no parameter nothing is split") {
  sweep::SweepResult result = synthetic::Grid();
  CHECK(json::parse(SummaryJson(result)).contains("attribution"));
  for (auto& row : result.rows) synthetic::LoseGap(&row, "gone");
  sweep::Summarise(result);
  CHECK_FALSE(json::parse(SummaryJson(result)).contains("attribution"));
  result.parameters.clear();
  for (auto& row : result.rows) row.theta.clear();
  sweep::Summarise(result);
  CHECK(json::parse(SummaryJson(result))["by"].empty());
}

TEST_CASE("A gap at its threshold does not falsify a trial, one above it does") {
  gap::GapResult result;
  result.options.threshold_m = 0.25;
  result.trials.resize(3);
  result.trials[0].comparison.gap_m = 0.25;
  result.trials[1].comparison.gap_m = 0.250001;
  result.trials[2].comparison.gap_m = 0.125;
  const json trials = json::parse(GapJson(result))["trials"];
  CHECK(trials[0]["falsified"] == false);
  CHECK(trials[1]["falsified"] == true);
  CHECK(trials[2]["falsified"] == false);
}

}  // namespace
}  // namespace rift::report
