// The paths of the page beside points and times that are chosen.

#include <catch2/catch.hpp>
#include <cmath>

#include "report/page/parts.hpp"
#include "report/synthetic_sweep.hpp"

namespace rift::report {
namespace {

using nlohmann::json;
using Points = std::vector<Eigen::Vector2f>;

/// Eight runs beside one reference, each of five points, 1 mm further to the left than the last.
struct Runs {
  Runs() {
    result.parameters = {{"a", {synthetic::Numeric("1")}}};
    for (int i = 0; i < 8; ++i) {
      sweep::TrialRow row =
          synthetic::Row(result.parameters[0].levels, std::to_string(i + 1), 0.05);
      const float y_m = 0.001F * static_cast<float>(i);
      row.evidence.path_m = {{0, y_m}, {1, y_m}, {1, y_m}, {1, y_m}, {2, y_m}};
      result.rows.push_back(row);
    }
    evidence.reference_of_row.assign(8, 0);
    evidence.references = {{"robot", {{0, 0}, {1, 0}, {1, 0}, {1, 0}, {2, 0}}}};
    sweep::Summarise(result);
  }
  json Paths() const { return PagePaths(result, evidence, PageViews(result), {}); }

  sweep::SweepResult result;
  PageEvidence evidence;
};

TEST_CASE("A band has no width where its axis stands still, and goes on behind it") {
  const json band = Runs().Paths()["views"][0]["band"];
  REQUIRE(band.size() == 16);  // four points up the left side and down the right one
  // In units of 0.2 mm: 95 % of 0 to 7 mm are 6.65 mm, 5 % are 0.35 mm.
  long x = 0, y = 0;
  std::vector<std::pair<long, long>> points;
  for (size_t i = 0; i < band.size(); i += 2) {
    x += band[i].get<long>();
    y += band[i + 1].get<long>();
    points.emplace_back(x, y);
  }
  const std::vector<std::pair<long, long>> expected{{0, 33},    {5000, 33}, {5000, 33}, {10000, 33},
                                                    {10000, 2}, {5000, 2},  {5000, 2},  {0, 2}};
  CHECK(points == expected);
}

TEST_CASE("Paths and times are written as steps of whole units, times only where all are known") {
  Runs runs;
  runs.evidence.references[0].times_s = {0.0F, 0.5F, 1.25F};
  runs.evidence.references.push_back({"other", {{0.1F, -0.2F}, {0.3F, 0.2F}}, {0.0F, NAN}});
  runs.evidence.references.push_back({"third", {{0, 0}}});
  const json references = runs.Paths()["references"];
  CHECK(references[0]["t"] == json({500, 750}));
  CHECK(references[1]["t"].empty());
  CHECK(references[1]["d"] == json({500, -1000, 1000, 2000}));
  CHECK(references[2]["t"].empty());
  CHECK(references[2]["name"] == "third");
}

TEST_CASE("A run's path says whether it fails, against what, and where its gap is") {
  Runs runs;
  runs.result.rows[1].comparison.gap_u = 0.123456;
  runs.result.rows[1].falsified = true;
  runs.result.rows[2].status = sweep::TrialStatus::kFell;
  runs.evidence.reference_of_row.resize(7);  // nothing is known of the last
  runs.evidence.reference_of_row[0] = -1;
  const json rows = runs.Paths()["rows"];
  REQUIRE(rows.size() == 8);
  CHECK(rows["2"]["u"] == 0.1235);
  CHECK(rows["2"]["fails"] == true);
  CHECK(rows["1"]["fails"] == false);
  CHECK(rows["2"]["text"] == "a 1, trial 2: gap 0.0500 m");
  CHECK(rows["3"]["text"] == "a 1, trial 3: did not arrive (fell)");
  CHECK(rows["3"]["u"].is_null());
  CHECK(rows["1"]["reference"] == -1);
  CHECK(rows["2"]["reference"] == 0);
  CHECK(rows["8"]["reference"] == -1);
}

TEST_CASE("A band leaves out a twentieth of the runs on either side of it") {
  Runs runs;
  for (size_t i = 0; i < 8; ++i) {
    for (Eigen::Vector2f& point : runs.result.rows[i].evidence.path_m) {
      point.y() = 0.012F * static_cast<float>(i);
    }
  }
  const json band = runs.Paths()["views"][0]["band"];
  // In units of 0.2 mm: 95 % of 0 to 84 mm are 79.8 mm, 5 % are 4.2 mm.
  CHECK(band[1] == 399);
  CHECK(band[9].get<long>() == 21 - 399);
  CHECK(runs.Paths()["views"][0]["band_of"] == 8);
}

}  // namespace
}  // namespace rift::report
