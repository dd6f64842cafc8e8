#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "report/synthetic_sweep.hpp"
#include "rift/report/json/fields.hpp"
#include "rift/report/json/json.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;
using nlohmann::json;

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

}  // namespace
}  // namespace rift::report
