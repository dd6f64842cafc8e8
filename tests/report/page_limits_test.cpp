// Parts of the page at the numbers from which on they show less, and on both sides of them.

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "report/page/parts.hpp"
#include "report/synthetic_sweep.hpp"
#include "rift/sweep/falsify/evidence.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using nlohmann::json;
using Levels = std::vector<experiment::ParameterValue>;

Levels Numbered(int count) {
  Levels levels;
  for (int i = 0; i < count; ++i) levels.push_back(synthetic::Numeric(std::to_string(i)));
  return levels;
}

/// A trial for each pair of values of two parameters.
sweep::SweepResult Pairs(int a, int b) {
  sweep::SweepResult result;
  result.parameters = {{"a", Numbered(a)}, {"b", Numbered(b)}};
  for (const auto& x : result.parameters[0].levels) {
    for (const auto& y : result.parameters[1].levels) {
      result.rows.push_back(synthetic::Row({x, y}, "1", 0.05));
    }
  }
  sweep::Summarise(result);
  return result;
}

TEST_CASE("The filter offers values of up to twelve and settings of up to sixty") {
  const auto offered = [](int a, int b) {
    std::vector<int> counts(3);
    for (const PageView& view : PageViews(Pairs(a, b))) {
      ++counts[view.group == "setting" ? 2 : view.group == "b" ? 1 : 0];
    }
    return counts;  // all trials and values of a, values of b, settings
  };
  CHECK(offered(1, 12) == std::vector{1, 12, 12});
  CHECK(offered(2, 13) == std::vector{3, 0, 26});
  CHECK(offered(5, 12) == std::vector{6, 12, 60});
  CHECK(offered(61, 1) == std::vector{1, 0, 0});
  CHECK(offered(12, 6) == std::vector{13, 6, 0});
}

TEST_CASE("A view has the rows and settings of its value in the order of the whole") {
  const sweep::SweepResult result = synthetic::Grid();
  const std::vector<PageView> views = PageViews(result);
  const auto named = [&](const std::string& query) {
    return *std::find_if(views.begin(), views.end(),
                         [&](const PageView& view) { return view.query == query; });
  };
  CHECK(named("v_max=0.50").rows == std::vector{2, 3, 6, 7, 10, 11, 14, 15, 18, 19, 22, 23});
  CHECK(named("v_max=0.50").settings == std::vector{1, 3, 5, 7, 9, 11});
  CHECK(named("surface=sand_fine&v_min=0.20&v_max=0.30").rows == std::vector{12, 13});
  CHECK(named("v_max=0.50").part->settings[2].noise_floor_m == 0.02);
}

/// A map of so many columns and lines of cells, of two lists of values.
PageChart MapOf(int columns, int lines) {
  sweep::SweepResult result = Pairs(columns, lines);
  sweep::FailingRegion region{.x_parameter = 0, .y_parameter = 1};
  region.cells.resize(static_cast<size_t>(columns * lines));
  return FailureMap(result, region, {});
}

TEST_CASE("A map grows with its lines, turns the names of more than six columns, and has an end") {
  for (const auto& [lines, height] : {std::pair{1, 80}, {2, 128}, {3, 192}, {4, 240}, {9, 240}}) {
    CHECK(MapOf(2, lines).spec["height"] == height);
  }
  CHECK(MapOf(6, 2).spec["axes"][0]["labelAngle"] == 0);
  CHECK(MapOf(7, 2).spec["axes"][0]["labelAngle"] ==
        Template("heat.json")["axes"][0]["labelAngle"]);
  CHECK_FALSE(MapOf(40, 40).spec.is_null());
  CHECK(MapOf(1601, 1).spec.is_null());
  // A line of cells has the height of one; a range stands on a plane.
  sweep::SweepResult line = Pairs(4, 1);
  line.parameters.pop_back();
  for (auto& row : line.rows) row.theta.pop_back();
  sweep::Summarise(line);
  line.rows[2].falsified = true;
  const PageChart chart = FailureMap(line, {}, PageViews(line));
  CHECK(chart.spec["height"] == 80);
  CHECK(chart.title == "Where it fails, by a");
  CHECK(chart.views.size() == 5);
  CHECK(chart.spec["data"][0]["values"].size() == 4);
}

TEST_CASE("Names in maps and charts are cut to 32 letters, and links keep them whole") {
  const std::string fits(32, 'x'), longer(33, 'x'),
      cut = std::string(16, 'x') + "…" + std::string(15, 'x');
  sweep::SweepResult result = Pairs(1, 1);
  sweep::FailingRegion region{.x_parameter = 0, .y_parameter = 1, .cells = {{}, {}}};
  region.cells[0].x = region.cells[1].y = fits;
  region.cells[0].y = region.cells[1].x = longer;
  const json cells = FailureMap(result, region, {}).spec["data"][0]["values"];
  CHECK(cells[0]["column"] == fits);
  CHECK(cells[0]["line"] == cut);
  CHECK(cells[1]["column"] == cut);
  CHECK(cells[1]["line"] == fits);
  CHECK(cells[1]["query"] == "a=" + longer + "&b=" + fits);
  CHECK(cells[1]["tip"]["a"] == longer);
  sweep::Explanation explanation;
  for (const std::string& name : {fits, longer}) {
    explanation.effects.parameters.push_back({.name = name});
    explanation.effects.parameters.back().share = 0.5;
  }
  const json bars = WhyCharts(explanation).at(0).spec["data"][0]["values"];
  CHECK(bars[0]["label"] == fits);
  CHECK(bars[1]["label"] == cut);
}

TEST_CASE("Values and parameters whose cut names are alike have places of their own") {
  const std::string begin(20, 'x'), end(20, 'y');
  const Levels levels{synthetic::Word(begin + "A" + end), synthetic::Word(begin + "B" + end),
                      synthetic::Word(begin + "C" + end)};
  sweep::SweepResult result;
  result.parameters = {{"a", levels}};
  for (const auto& level : levels) result.rows.push_back(synthetic::Row({level}, "1", 0.05));
  sweep::Summarise(result);
  std::set<std::string> columns, labels;
  const json cells = FailureMap(result, {}, {}).spec["data"][0]["values"];
  for (const json& cell : cells) columns.insert(cell["column"]);
  CHECK(columns.size() == 3);
  sweep::Explanation explanation;
  for (const auto& level : levels) {
    explanation.effects.parameters.push_back({.name = level.text});
    explanation.effects.parameters.back().share = 0.5;
  }
  const json bars = WhyCharts(explanation).at(0).spec["data"][0]["values"];
  for (const json& bar : bars) {
    labels.insert(bar["label"]);
    CHECK(bar["tip"]["what"].get<std::string>().size() == 41);
  }
  CHECK(labels.size() == 3);
}

TEST_CASE("A plane shows up to fifteen hundred trials, and of more a sample in their order") {
  for (const auto& [trials, dots] :
       {std::pair{1499, 1499}, {1500, 1500}, {1501, 1500}, {3002, 1500}}) {
    sweep::SweepResult result = synthetic::Continuous(trials);
    sweep::FailingRegion region{.x_parameter = 0, .y_parameter = 1, .cells = {{}}};
    region.cells[0].share = 0.125;
    region.cells[0].x_high = 0.3;
    const PageChart chart = FailureMap(result, region, {});
    const json& shown = chart.spec["data"][1]["values"];
    INFO(trials);
    REQUIRE(shown.size() == static_cast<size_t>(dots));
    for (size_t i = 1; i < shown.size(); ++i) CHECK(shown[i]["row"] > shown[i - 1]["row"]);
    CHECK(shown.back()["row"] > trials - 30);
    const size_t row = shown[7]["row"];
    CHECK(shown[7]["x"] == *result.rows[row - 1].theta[0].number);
    CHECK(shown[7]["y"] == *result.rows[row - 1].theta[1].number);
    CHECK(shown[7]["query"] == fmt::format(".row={}", row));
    CHECK(chart.spec["data"][0]["values"][0]["value"] == 12.5);
    CHECK(chart.spec["data"][0]["values"][0]["x2"] == 0.3);
    CHECK(chart.spec["height"] == 230);
  }
}

TEST_CASE("A side of the plane that is even in the logarithm is drawn so") {
  sweep::SweepResult result = synthetic::Continuous(3);
  const sweep::FailingRegion region{.x_parameter = 0, .y_parameter = 1, .cells = {{}}};
  const auto kinds = [&] {
    const json scales = FailureMap(result, region, {}).spec["scales"];
    return scales[0]["type"].get<std::string>() + " " + scales[1]["type"].get<std::string>();
  };
  CHECK(kinds() == "linear linear");
  result.parameters[1].is_logarithmic = true;
  CHECK(kinds() == "linear log");
  std::swap(result.parameters[0].is_logarithmic, result.parameters[1].is_logarithmic);
  CHECK(kinds() == "log linear");
}

TEST_CASE("The bins of the histogram count every gap once and part at the threshold") {
  std::mt19937_64 random(5);
  for (const double threshold_m : {0.06, 0.045, 0.0013, 0.3}) {
    for (const double largest_m : {0.02, 0.0951, 0.4}) {
      sweep::SweepResult result = synthetic::Continuous(60);
      result.gap.threshold_m = threshold_m;
      for (auto& row : result.rows) {
        row.comparison.gap_m = std::uniform_real_distribution<>(0.0, largest_m)(random);
      }
      result.rows[3].comparison.gap_m = largest_m;
      result.rows[4].comparison.gap_m = threshold_m;  // holds
      result.rows[5].comparison.gap_m = 0.0;
      synthetic::LoseGap(&result.rows[6], "gone");
      const PageChart chart = GapHistogram(result, PageViews(result));
      const json& bins = chart.spec["data"][0]["values"];
      long below = 0, above = 0, all = 0, edges = 0;
      const double width_m = bins[0]["to"];
      INFO(threshold_m << " " << largest_m << " " << width_m);
      for (size_t i = 0; i < bins.size(); ++i) {
        const double from_m = bins[i]["from"], to_m = bins[i]["to"];
        CHECK(from_m == Approx(width_m * static_cast<double>(i)).margin(1e-12));
        CHECK(to_m - from_m == Approx(width_m));
        edges += std::abs(from_m - threshold_m) < 1e-9;
        const long count = bins[i]["count"];
        all += count;
        (bins[i]["colour"] == "#D55E00" ? above : below) += count;
        CHECK(count == std::count_if(result.rows.begin(), result.rows.end(), [&](const auto& row) {
                const double gap_m = row.comparison.gap_m;
                return (gap_m > from_m + 1e-11 && gap_m <= to_m + 1e-11) ||
                       (i == 0 && gap_m == 0.0);
              }));
        CHECK(chart.views[0][i][0] == count);
      }
      CHECK(all == 59);
      CHECK(edges == 1);
      CHECK(above == std::count_if(result.rows.begin(), result.rows.end(), [&](const auto& row) {
              return row.comparison.gap_m > threshold_m;
            }));
      CHECK(bins.back()["to"].get<double>() >= std::max(largest_m, threshold_m));
      CHECK(bins.size() >= 15);
    }
  }
}

TEST_CASE("One gap that is far beyond the others makes no bins without end") {
  sweep::SweepResult result = synthetic::Continuous(60);
  result.rows[7].comparison.gap_m = 59.9;  // the thousandth bin ends at 60 m
  sweep::Summarise(result);
  CHECK_THAT(GapHistogram(result, PageViews(result)).sentence, !Contains("last bar"));
  for (const double gap_m : {60.1, 600.0}) {
    result.rows[8].comparison.gap_m = gap_m;
    sweep::Summarise(result);
    const PageChart chart = GapHistogram(result, PageViews(result));
    const json& bins = chart.spec["data"][0]["values"];
    INFO(gap_m);
    REQUIRE(bins.size() == 1000);
    CHECK(bins.back()["count"] == 1);
    CHECK(bins[998]["count"] == 1);
    CHECK(chart.views[0].back()[0] == 1);
    CHECK(bins.back()["tip"]["gap"] == "above 59.9400 m");
    CHECK(bins[998]["tip"]["gap"] == "59.8800 to 59.9400 m");
    CHECK_THAT(chart.sentence, EndsWith("The last bar is of all gaps above 59.94 m."));
  }
}

/// So many trials of one setting with paths, the last `lost` of them without a gap.
json Paths(int trials, int lost, int references) {
  sweep::SweepResult result;
  result.parameters = {{"a", Numbered(1)}};
  PageEvidence evidence;
  for (int i = 0; i < trials; ++i) {
    result.rows.push_back(synthetic::Row(result.parameters[0].levels, std::to_string(i), 0.05));
    if (i >= trials - lost) synthetic::LoseGap(&result.rows.back(), "gone");
    result.rows.back().evidence.path_m = sweep::EvenPath(synthetic::Path(0.001 * i), {});
    evidence.reference_of_row.push_back(i % references);
  }
  for (int i = 0; i < references; ++i) {
    evidence.references.push_back({"robot", sweep::EvenPath(synthetic::Path(0.0), {})});
  }
  sweep::Summarise(result);
  return PagePaths(result, evidence, PageViews(result), {})["views"][0];
}

TEST_CASE(
    "A view draws thirty lines, a band of eight paths and nine references, not more or less") {
  CHECK(Paths(30, 0, 1)["lines"].size() == 30);
  const json lines = Paths(62, 0, 1)["lines"];
  CHECK(lines.size() == 30);
  CHECK(std::is_sorted(lines.begin(), lines.end()));
  // Of two settings in turn both are drawn.
  const auto odd = std::count_if(lines.begin(), lines.end(),
                                 [](const json& row) { return row.get<int>() % 2 == 1; });
  CHECK(odd > 8);
  CHECK(odd < 22);
  CHECK(Paths(31, 0, 1)["lines"].size() == 30);
  CHECK(Paths(62, 0, 1)["drawn_of"] == 62);
  CHECK_FALSE(Paths(7, 0, 1).contains("band"));
  CHECK(Paths(8, 0, 1)["band_of"] == 8);
  CHECK_FALSE(Paths(9, 2, 1).contains("band"));
  CHECK(Paths(12, 0, 9)["references"].size() == 9);
  CHECK(Paths(12, 0, 10)["references"] == json({0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST_CASE("Tables that hold all say so, and shorter ones hold the worst") {
  const sweep::SweepResult result = synthetic::Grid();
  const auto notes = [&](int rows) {
    return std::pair(TrialsTable(result, "", {.table_rows = rows}).note,
                     SettingsTable(result, {.table_rows = rows}).note);
  };
  CHECK_THAT(notes(24).first, Contains("All 24 trials. Click"));
  CHECK_THAT(notes(23).first, Contains("The worst 23 of 24 trials; table.csv holds all."));
  CHECK_THAT(notes(12).second, Contains("All 12 settings, the worst first. Click"));
  CHECK_THAT(notes(11).second, Contains("The worst 11 of 12 settings"));
  CHECK(TrialsTable(result, "", {.table_rows = 24}).data["complete"] == true);
  CHECK(TrialsTable(result, "", {.table_rows = 23}).data["complete"] == false);
  // The row without a gap first, then falling gaps.
  const json rows = TrialsTable(result, "", {.table_rows = 3}).data["rows"];
  CHECK(rows.size() == 3);
  CHECK(rows[0][0] == 2);
  CHECK(rows[1][0] == 18);
  CHECK(rows[2][0] == 20);
}

TEST_CASE("Charts of causes are as high as their bars and have twelve effects at most") {
  sweep::Explanation explanation;
  for (int i = 0; i < 13; ++i) {
    sweep::ParameterEffect effect{.name = fmt::format("p{}", i)};
    effect.share = i == 1 ? NAN : 0.25;
    effect.share_low = 0.125;
    effect.share_high = 0.5;
    explanation.effects.parameters.push_back(effect);
  }
  json values = WhyCharts(explanation).at(0).spec["data"][0]["values"];
  CHECK(values.size() == 12);
  CHECK(values[1]["label"] == "p2");
  CHECK(values[0]["value"] == 25.0);
  CHECK(values[0]["low"] == 12.5);
  CHECK(values[0]["high"] == 50.0);
  CHECK(values[0]["tip"]["share"] == "25.0 %");
  CHECK(values[0]["tip"]["95 % interval"] == "12 to 50 %");
  CHECK(WhyCharts(explanation)[0].spec["height"] == 28 * 12);
  explanation.effects.parameters.push_back(explanation.effects.parameters[0]);
  CHECK(WhyCharts(explanation)[0].spec["data"][0]["values"].size() == 12);
  CHECK(WhyCharts(explanation).size() == 1);  // nothing is known of the gap's parts
  explanation.effects.parameters.resize(1);
  CHECK(WhyCharts(explanation)[0].spec["height"] == 28);
  CHECK(WhyCharts({}).empty());
}

TEST_CASE("Every trial without a gap is named up to five hundred") {
  for (const int lost : {0, 500, 501, 502}) {
    sweep::SweepResult result;
    result.parameters = {{"a", Numbered(1)}};
    for (int i = 0; i < lost + 1; ++i) {
      result.rows.push_back(synthetic::Row(result.parameters[0].levels, std::to_string(i), 0.05));
      if (i > 0) synthetic::LoseGap(&result.rows.back(), fmt::format("lost {};", i));
    }
    sweep::Summarise(result);
    const std::string page = RenderPage(result, {}, {});
    const std::string words = page.substr(0, page.find("<script"));
    CHECK((words.find("lost 500;") != words.npos) == (lost >= 500));
    CHECK(words.find("lost 501;") == words.npos);
    const std::string more = fmt::format("and {} more, all of them in table.csv", lost - 500);
    CHECK((words.find(more) != words.npos) == (lost > 500));
  }
}

}  // namespace
}  // namespace rift::report
