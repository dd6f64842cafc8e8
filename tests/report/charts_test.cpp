// Charts of the page where a share is smoothed, a trial tells nothing or a threshold is zero.

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "report/page/parts.hpp"
#include "rift/experiment/words.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sweep/falsify/evidence.hpp"
#include "synthetic_sweep.hpp"

namespace rift::report {
namespace {

using nlohmann::json;

json Signal(const PageChart& chart, const std::string& name) {
  for (const json& signal : chart.spec["signals"]) {
    if (signal["name"] == name) return signal["value"];
  }
  return "there is no such signal";
}

/// A list of two surfaces beside a range of friction, two trials each.
sweep::SweepResult Mixed() {
  sweep::SweepResult result;
  result.parameters = {{"terrain.surface", {synthetic::Word("ice"), synthetic::Word("rock")}},
                       {"friction", {}, 0.2, 0.8}};
  for (int i = 0; i < 4; ++i) {
    result.rows.push_back(synthetic::Row({result.parameters[0].levels[static_cast<size_t>(i % 2)],
                                          synthetic::Numeric(std::to_string(0.3 + 0.1 * i))},
                                         "1", 0.05 + 0.01 * i));
  }
  sweep::Summarise(result);
  return result;
}

sweep::FailingRegion Smoothed(int nearest) {
  sweep::FailingRegion region{
      .x_parameter = 0, .y_parameter = 1, .is_smoothed = true, .nearest = nearest};
  region.cells = {{.x = "ice", .y = "0.2 to 0.5", .share = 0.1256, .trials = 3},
                  {.x = "rock", .y = "0.2 to 0.5", .share = 1.0, .trials = 5},
                  {.x = "rock", .y = "0.5 to 0.8"}};
  return region;
}

TEST_CASE("A smoothed share leads to no rows, is told to a tenth of a per cent and of how many") {
  const sweep::SweepResult result = Mixed();
  const PageChart chart = FailureMap(result, Smoothed(5), {});
  CHECK(chart.title == "Where it fails, by surface and friction");
  CHECK(chart.sentence ==
        "Share of failing runs in per cent, the mean of the 5 settings nearest to each patch, the "
        "other parameters being what those settings had.");
  CHECK(FailureMap(result, Smoothed(1), {}).sentence ==
        "Share of failing runs in per cent, of the setting nearest to each patch, the other "
        "parameters being what that setting had.");
  const json& cells = chart.spec["data"][0]["values"];
  REQUIRE(cells.size() == 3);
  CHECK(cells[0]["value"] == 12.6);
  CHECK(cells[0]["trials"] == 3);
  CHECK(cells[1]["value"] == 100.0);
  CHECK(cells[2]["value"].is_null());
  for (const json& cell : cells) CHECK(cell["query"] == "");
  CHECK(cells[2]["tip"] == json({{"surface", "rock"}, {"friction", "0.5 to 0.8"}}));
  CHECK(chart.spec["height"] == 230);  // of a range, however few its patches
  CHECK(Signal(chart, "x_title") == "surface");
  CHECK(Signal(chart, "y_title") == "friction");
  CHECK(Signal(chart, "range") == json({0, 100}));
  CHECK(Signal(chart, "middle") == 60.0);
  CHECK(Signal(chart, "low_is_dark") == false);
  CHECK(Signal(chart, "legend_title") == "runs that fail (%)");

  sweep::FailingRegion counted = Smoothed(0);
  counted.is_smoothed = false;
  const PageChart exact = FailureMap(result, counted, {});
  CHECK(exact.spec["data"][0]["values"][1]["query"] == "surface=rock&friction=0.2%20to%200.5");
  CHECK(exact.sentence ==
        "Share of runs that fail in per cent, over all values of the other parameters; crosses "
        "were not tried.");
}

TEST_CASE("A trial that tells nothing has no dot, and one that never arrived has no gap at it") {
  sweep::SweepResult result = synthetic::Continuous(5);
  synthetic::LoseGap(&result.rows[1], "gone");
  sweep::TrialRow& fell = result.rows[3];
  fell.status = sweep::TrialStatus::kFell;
  fell.comparison = {};
  fell.falsified = true;
  const sweep::FailingRegion region{.x_parameter = 1, .y_parameter = 0, .cells = {{}}};
  const PageChart chart = FailureMap(result, region, {});
  const json& dots = chart.spec["data"][1]["values"];
  REQUIRE(dots.size() == 4);
  CHECK(dots[0]["row"] == 1);
  CHECK(dots[1]["row"] == 3);
  CHECK(dots[2]["row"] == 4);
  CHECK(dots[2]["tip"] == json({{"row", "4"}, {"gap", "none"}}));
  CHECK(dots[2]["falsified"] == true);
  // 0.02 m and nine tenths of 0.06 m.
  CHECK(dots[3]["tip"] == json({{"row", "5"}, {"gap", "0.0740 m"}}));
  CHECK(dots[0]["falsified"] == false);
  CHECK(dots[0]["tip"]["gap"] == "0.0260 m");
  CHECK(dots[0]["x"] == *result.rows[0].theta[1].number);
  CHECK(dots[0]["y"] == *result.rows[0].theta[0].number);
  CHECK(Signal(chart, "x_title") == experiment::LabelOf("delay_s"));
  CHECK(Signal(chart, "y_title") == "friction");
  CHECK(chart.title == "Where it fails, by delay_s and friction");
}

TEST_CASE("With a threshold of zero the histogram has thirty bins to its end, all above it") {
  sweep::SweepResult result = synthetic::Continuous(10);
  result.gap.threshold_m = 0.0;
  for (auto& row : result.rows) row.comparison.gap_m = 0.295;
  result.rows[0].comparison.gap_m = 0.0101;
  const PageChart chart = GapHistogram(result, {});
  const json& bins = chart.spec["data"][0]["values"];
  REQUIRE(bins.size() == 31);
  CHECK(bins[0]["to"].get<double>() == Approx(0.01));
  CHECK(bins[1]["count"] == 1);
  CHECK(bins[29]["count"] == 9);
  for (const json& bin : bins) CHECK(bin["colour"] == "#D55E00");
  CHECK(bins[1]["tip"]["gap"] == "0.0100 to 0.0200 m");
  CHECK(chart.title == "How large the gaps are");
  CHECK(chart.sentence ==
        "Number of trials by gap in metres; orange is above the threshold (dashed).");
  CHECK(Signal(chart, "x_title") == "gap (m)");
}

TEST_CASE("Of more than twenty thousand trials the page filters nothing") {
  for (const int trials : {20'000, 20'001}) {
    sweep::SweepResult result;
    result.parameters = {{"a", {synthetic::Word("x"), synthetic::Word("y")}}};
    result.rows.reserve(static_cast<size_t>(trials));
    for (int i = 0; i < trials; ++i) {
      result.rows.push_back(
          synthetic::Row({result.parameters[0].levels[static_cast<size_t>(i % 2)]}, "1", 0.05));
    }
    sweep::Summarise(result);
    CHECK(PageViews(result).size() == (trials > 20'000 ? 1U : 3U));
  }
}

TEST_CASE("A reference that is alone stands for all where none is known, of two neither does") {
  sweep::SweepResult result = synthetic::Continuous(3);
  PageEvidence evidence;
  const auto references = [&] {
    return PagePaths(result, evidence, PageViews(result), {})["views"][0]["references"];
  };
  CHECK(references().empty());
  evidence.references.push_back({"robot", sweep::EvenPath(synthetic::Path(0.0), {})});
  CHECK(references() == json::array({0}));
  evidence.references.push_back({"other", sweep::EvenPath(synthetic::Path(0.1), {})});
  CHECK(references().empty());
  evidence.reference_of_row = {-1, 1, 1};
  CHECK(references() == json::array({1}));
}

TEST_CASE("A page shows paths where it has some, and what it cannot tell is marked unknown") {
  const std::string heading = "<h2>Paths</h2>";
  sweep::SweepResult result = synthetic::Grid();
  CHECK(RenderPage(result).find(heading) == std::string::npos);
  const PageEvidence evidence{.references = {{"robot", sweep::EvenPath(synthetic::Path(0.0), {})}}};
  CHECK(RenderPage(result, {}, evidence).find(heading) != std::string::npos);
  result.rows[5].evidence.path_m = sweep::EvenPath(synthetic::Path(0.1), {});
  const std::string page = RenderPage(result);
  CHECK(page.find(heading) != std::string::npos);
  CHECK(page.find(R"(<p class="headline fail")") != std::string::npos);
  for (auto& row : result.rows) synthetic::LoseGap(&row, "gone");
  sweep::Summarise(result);
  CHECK(RenderPage(result).find(R"(<p class="headline unknown")") != std::string::npos);
}

TEST_CASE("The filter is there where it offers more than all trials") {
  const std::string choice = R"(<select id="view">)";
  CHECK(RenderPage(synthetic::Grid()).find(choice) != std::string::npos);
  sweep::SweepResult result = synthetic::Continuous(4);
  result.parameters.pop_back();
  for (auto& row : result.rows) row.theta.pop_back();
  sweep::Summarise(result);
  REQUIRE(PageViews(result).size() == 1);
  CHECK(RenderPage(result).find(choice) == std::string::npos);
}

TEST_CASE("Without references a view has no band, and without its path no worst run") {
  sweep::SweepResult result;
  result.parameters = {{"a", {synthetic::Word("x")}}};
  for (int i = 0; i < 9; ++i) {
    result.rows.push_back(
        synthetic::Row(result.parameters[0].levels, std::to_string(i), 0.01 + 0.001 * i));
    if (i < 8) result.rows.back().evidence.path_m = sweep::EvenPath(synthetic::Path(0.01 * i), {});
  }
  sweep::Summarise(result);
  PageEvidence evidence;
  const auto view = [&] { return PagePaths(result, evidence, PageViews(result), {})["views"][0]; };
  CHECK_FALSE(view().contains("band"));
  CHECK_FALSE(view().contains("worst"));  // the ninth, whose path is not there
  CHECK(view()["drawn_of"] == 8);
  CHECK(view()["lines"] == json({1, 2, 3, 4, 5, 6, 7, 8}));
  evidence.worst_path_m = sweep::EvenPath(synthetic::Path(0.2), {});
  CHECK(view()["worst"] == 9);
  CHECK(view()["drawn_of"] == 9);
  evidence.references = {{"robot", sweep::EvenPath(synthetic::Path(0.0), {})}};
  CHECK(view()["band_of"] == 9);
}

}  // namespace
}  // namespace rift::report
