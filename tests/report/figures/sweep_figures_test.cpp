#include "rift/report/figures/figures.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "report/png.hpp"
#include "report/synthetic_sweep.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;

std::vector<std::string> Names(const SweepFigureSet& set) {
  std::vector<std::string> names;
  for (const Figure& figure : set.figures) names.push_back(figure.name);
  return names;
}

const Figure& Named(const SweepFigureSet& set, const std::string& name) {
  const auto found = std::find_if(set.figures.begin(), set.figures.end(),
                                  [&](const Figure& figure) { return figure.name == name; });
  REQUIRE(found != set.figures.end());
  return *found;
}

std::string ReasonFor(const SweepFigureSet& set, const std::string& name) {
  for (const OmittedFigure& omitted : set.omitted) {
    if (omitted.name.rfind(name, 0) == 0) return omitted.reason;
  }
  return "drawn";
}

void CheckAllRender(const SweepFigureSet& set) {
  for (const Figure& figure : set.figures) {
    INFO(figure.name);
    CHECK_THAT(Render(figure, FigureFormat::kSvg), Contains("</svg>"));
    CHECK(PngSize(Render(figure, FigureFormat::kPng)).first == 3 * figure.width_px);
  }
}

TEST_CASE("A grid with a categorical axis gives all figures of the paper") {
  const SweepFigureSet set = SweepFigures(synthetic::Grid(), synthetic::Pair(0.1));
  CHECK(Names(set) == std::vector<std::string>{"fig07_gap_by_setting", "fig08_gap_by_trial",
                                               "fig09_error_along_path", "fig10_gap_heat_map",
                                               "fig11_gap_by_surface", "fig12_failures_by_surface",
                                               "fig13_failures_by_v_min_v_max"});
  CHECK(set.omitted.empty());
  CheckAllRender(set);
}

TEST_CASE("Names stay as they are written") {
  const SweepFigureSet set = SweepFigures(synthetic::Grid());
  for (const char* name : {"fig07_gap_by_setting", "fig08_gap_by_trial", "fig10_gap_heat_map",
                           "fig11_gap_by_surface", "fig12_failures_by_surface"}) {
    INFO(name);
    CHECK_THAT(Render(Named(set, name), FigureFormat::kSvg), Contains("sand_fine"));
  }
}

TEST_CASE("Hostile names are drawn and not obeyed") {
  const std::vector<std::string> names = {"`touch hacked`", "it's \"q\" \\ 100 %d @x $y",
                                          "Straße – über\nzwei\xff"};
  const SweepFigureSet set = SweepFigures(synthetic::Grid(names));
  CheckAllRender(set);
  const std::string svg = Render(Named(set, "fig11_gap_by_surface"), FigureFormat::kSvg);
  CHECK_THAT(svg, Contains("`touch hacked`") && Contains("100 %d @x $y") && Contains("Straße"));
}

TEST_CASE("The heat map shows the mean of each setting and says where there is none") {
  sweep::SweepResult result = synthetic::Grid();
  synthetic::LoseGap(&result.rows[0], "gone");
  sweep::Summarise(result);
  const std::string svg =
      Render(Named(SweepFigures(result), "fig10_gap_heat_map"), FigureFormat::kSvg);
  CHECK_THAT(svg, Contains("0.050") && Contains("0.070") && Contains("no gap"));
  CHECK_THAT(svg, !Contains("<image"));  // cells are vector graphics, not a blurred bitmap
}

TEST_CASE("Failures are counted by level") {
  const SweepFigureSet set = SweepFigures(synthetic::Grid());
  const std::string& plot = Named(set, "fig12_failures_by_surface").plot;
  CHECK_THAT(plot, Contains("$bars << EOD\n0 0 0.7 \n1 0 0.7 \n2 8 0.7 \nEOD"));
}

TEST_CASE("Trials without a gap are marked in every figure that counts trials") {
  const SweepFigureSet set = SweepFigures(synthetic::Grid());
  for (const Figure& figure : set.figures) {
    if (figure.name == "fig10_gap_heat_map") continue;
    INFO(figure.name);
    CHECK_THAT(figure.plot, Contains("'trials without a gap'"));
  }
}

TEST_CASE("A single axis has no combinations to group by") {
  sweep::SweepResult result = synthetic::Grid();
  result.parameters.resize(1);
  for (auto& row : result.rows) row.theta.resize(1);
  sweep::Summarise(result);
  const SweepFigureSet set = SweepFigures(result);
  CHECK_THAT(ReasonFor(set, "fig07"), Contains("one parameter only"));
  CHECK_THAT(ReasonFor(set, "fig10"), Contains("one parameter only"));
  CHECK_THAT(ReasonFor(set, "fig13"), Contains("one parameter only"));
  CheckAllRender(set);
}

TEST_CASE("A single level and a single trial still make figures") {
  sweep::SweepResult result = synthetic::Grid({"ice"});
  result.rows.resize(1);
  for (auto& parameter : result.parameters) parameter.levels.resize(1);
  sweep::Summarise(result);
  CheckAllRender(SweepFigures(result));
}

TEST_CASE("Forty levels are drawn as long as the bars can be told apart") {
  std::vector<std::string> surfaces;
  for (int i = 0; i < 40; ++i) surfaces.push_back("surface number " + std::to_string(i));
  const SweepFigureSet set = SweepFigures(synthetic::Grid(surfaces));
  CHECK_THAT(ReasonFor(set, "fig07"), Contains("160 bars"));
  CHECK_THAT(Named(set, "fig08_gap_by_trial").plot, Contains("the 40 worst of 160 settings"));
  CheckAllRender(set);
}

TEST_CASE("A figure is left out from one bar or cell more than its limit on, with its number") {
  // Three surfaces beside four combinations of the other parameters.
  const sweep::SweepResult result = synthetic::Grid();
  const auto reason = [&](const std::string& name, const ReportOptions& options) {
    return ReasonFor(SweepFigures(result, {}, options), name);
  };
  CHECK(reason("fig07", {.max_bars = 12}) == "drawn");
  CHECK(reason("fig07", {.max_bars = 11}) ==
        "12 bars in 4 colours cannot be told apart: see figure 10");
  CHECK(reason("fig10", {.max_cells = 12}) == "drawn");
  CHECK(reason("fig10", {.max_cells = 11}) == "12 cells are too many to read");
  for (const char* name : {"fig11", "fig12"}) {
    CHECK(reason(name, {.max_bars = 3}) == "drawn");
    CHECK(reason(name, {.max_bars = 2}) == "3 bars are too many to read");
  }
  CHECK(reason("fig13", {.max_bars = 4}) == "drawn");
  CHECK(reason("fig13", {.max_bars = 3}) == "4 bars are too many to read");
  CHECK(reason("fig09", {}) == "the paths of the worst trial are not at hand");
  // Twelve series have a colour each.
  for (const int series : {12, 13}) {
    sweep::SweepResult many = synthetic::Grid({"ice", "rock"});
    many.parameters.resize(2);
    many.parameters[1].levels.clear();
    many.rows.clear();
    for (int i = 0; i < series; ++i) {
      many.parameters[1].levels.push_back(synthetic::Numeric(std::to_string(i)));
      for (const auto& surface : many.parameters[0].levels) {
        many.rows.push_back(synthetic::Row({surface, many.parameters[1].levels[i]}, "1", 0.05));
      }
    }
    sweep::Summarise(many);
    const SweepFigureSet set = SweepFigures(many);
    CHECK_THAT(ReasonFor(set, "fig07"),
               series == 12 ? Contains("drawn") : Contains("26 bars in 13 colours"));
  }
}

TEST_CASE("Parameters' names are file names of letters, digits and dashes") {
  sweep::SweepResult result = synthetic::Grid();
  result.parameters.resize(1);
  for (auto& row : result.rows) row.theta.resize(1);
  for (const auto& [key, part] :
       {std::pair{"terrain.(a) b-2  c)", "a_b-2_c"}, {"_x_", "x"}, {"?!", "parameter"}}) {
    result.parameters[0].key = key;
    sweep::Summarise(result);
    const std::vector<std::string> names = Names(SweepFigures(result));
    REQUIRE(names.size() == 3);
    CHECK(names[1] == std::string("fig11_gap_by_") + part);
    CHECK(names[2] == std::string("fig12_failures_by_") + part);
  }
}

TEST_CASE("Names of files have an end, however many and long the names of parameters are") {
  sweep::SweepResult result = synthetic::Grid();
  result.parameters[0].key = "terrain." + std::string(300, 's');
  result.parameters[1].key = "control." + std::string(79, 'v');
  const std::vector<std::string> names = Names(SweepFigures(result));
  REQUIRE(names.size() == 6);
  CHECK(names[3] == "fig11_gap_by_" + std::string(80, 's'));
  CHECK(names[4] == "fig12_failures_by_" + std::string(80, 's'));
  CHECK(names[5] == "fig13_failures_by_other_parameters");
}

TEST_CASE("Parameters whose names are one name of a file have a figure each") {
  sweep::SweepResult result = synthetic::Continuous(5);
  result.parameters[0].key = "摩擦";
  result.parameters[1].key = "质量";
  CHECK(Names(SweepFigures(result)) == std::vector<std::string>{"fig08_gap_by_trial",
                                                                "gap_over_parameter",
                                                                "gap_over_parameter_2"});
}

TEST_CASE("Continuous axes give scatter plots instead of bars") {
  const SweepFigureSet set = SweepFigures(synthetic::Continuous(200));
  CHECK(Names(set) ==
        std::vector<std::string>{"fig08_gap_by_trial", "gap_over_friction", "gap_over_delay_s"});
  for (const char* name : {"fig07", "fig10", "fig11", "fig12", "fig13"}) {
    CHECK_THAT(ReasonFor(set, name), Contains("friction is continuous"));
  }
  CheckAllRender(set);
}

TEST_CASE("A range of few whole numbers gives bars in their order, one of many says how many") {
  sweep::SweepResult result;
  result.parameters = {{.key = "n", .min = 1.0, .max = 3.0, .is_integer = true},
                       {.key = "k", .levels = {synthetic::Numeric("5"), synthetic::Numeric("6")}}};
  for (const char* n : {"3", "1", "2"}) {
    for (const auto& k : result.parameters[1].levels) {
      result.rows.push_back(synthetic::Row({synthetic::Numeric(n), k}, "1", 0.05));
    }
  }
  sweep::Summarise(result);
  const SweepFigureSet set = SweepFigures(result);
  CHECK(Names(set) == std::vector<std::string>{"fig07_gap_by_setting", "fig08_gap_by_trial",
                                               "fig10_gap_heat_map", "fig11_gap_by_n",
                                               "fig12_failures_by_n", "fig13_failures_by_k",
                                               "gap_over_n"});
  const std::vector<sweep::LevelSummary> levels = sweep::SummariseBy(result, {0});
  REQUIRE(levels.size() == 3);
  CHECK((levels[0].level == "1" && levels[1].level == "2" && levels[2].level == "3"));
  CheckAllRender(set);
  result.parameters[0].max = 13.0;
  const SweepFigureSet many = SweepFigures(result);
  CHECK(ReasonFor(many, "fig10") == "n has more than 12 whole numbers: see the figure over it");
  CHECK(Names(many) == std::vector<std::string>{"fig08_gap_by_trial", "gap_over_n"});
}

TEST_CASE("A scatter plot of very many trials shows their range") {
  const SweepFigureSet set = SweepFigures(synthetic::Continuous(6000));
  const Figure& figure = Named(set, "gap_over_friction");
  CHECK_THAT(figure.plot, Contains("'median'") && Contains("'5 to 95 %'"));
  CHECK(figure.plot.size() < 10'000);
  CheckAllRender(set);
}

TEST_CASE("A sweep without a single gap draws nothing and says why") {
  sweep::SweepResult result = synthetic::Grid();
  for (auto& row : result.rows) synthetic::LoseGap(&row, "gone");
  sweep::Summarise(result);
  const SweepFigureSet set = SweepFigures(result);
  CHECK(set.figures.empty());
  CHECK(set.omitted.size() == 7);
  CHECK(ReasonFor(set, "fig08") == "no trial has a gap");
}

TEST_CASE("The worst row is the largest gap among those that have one") {
  sweep::SweepResult result = synthetic::Grid();
  CHECK(WorstRow(result) == 17);
  for (auto& row : result.rows) synthetic::LoseGap(&row, "gone");
  CHECK(WorstRow(result) == std::nullopt);
}

TEST_CASE("A list of values beside a range has its own bars, and what needs both has none") {
  sweep::SweepResult result;
  result.parameters = {{"friction", {}, 0.2, 0.8},
                       {"terrain.surface", {synthetic::Word("ice"), synthetic::Word("rock")}}};
  for (int i = 0; i < 8; ++i) {
    result.rows.push_back(synthetic::Row({synthetic::Numeric(std::to_string(0.25 + 0.06 * i)),
                                          result.parameters[1].levels[static_cast<size_t>(i % 2)]},
                                         "1", 0.03 + 0.005 * i));
  }
  sweep::Summarise(result);
  const SweepFigureSet set = SweepFigures(result);
  CHECK(Names(set) == std::vector<std::string>{"fig08_gap_by_trial", "fig11_gap_by_surface",
                                               "fig12_failures_by_surface", "gap_over_friction"});
  const std::string reason = "friction is continuous, so no two settings share a value of it";
  for (const char* name : {"fig07", "fig10", "fig13"}) CHECK(ReasonFor(set, name) == reason);
}

/// One parameter of so many values beside one of so many others, a trial for each pair.
sweep::SweepResult Values(int mains, int others) {
  sweep::SweepResult result;
  result.parameters = {{"a", {}}, {"b", {}}};
  if (others == 0) result.parameters.pop_back();
  for (int i = 0; i < mains; ++i) {
    result.parameters[0].levels.push_back(synthetic::Word("w" + std::to_string(i)));
  }
  for (int k = 0; k < others; ++k) {
    result.parameters[1].levels.push_back(synthetic::Numeric(std::to_string(k)));
  }
  for (const auto& a : result.parameters[0].levels) {
    for (int k = 0; k < std::max(others, 1); ++k) {
      experiment::Theta theta{a};
      if (others > 0) theta.push_back(result.parameters[1].levels[static_cast<size_t>(k)]);
      result.rows.push_back(synthetic::Row(theta, "1", 0.05));
    }
  }
  sweep::Summarise(result);
  return result;
}

TEST_CASE("Without other options bars go up to 120, cells to 1600 and dots to 5000") {
  CHECK(ReasonFor(SweepFigures(Values(120, 0)), "fig11") == "drawn");
  CHECK(ReasonFor(SweepFigures(Values(121, 0)), "fig11") == "121 bars are too many to read");
  CHECK(ReasonFor(SweepFigures(Values(40, 40)), "fig10") == "drawn");
  CHECK(ReasonFor(SweepFigures(Values(41, 40)), "fig10") == "1640 cells are too many to read");
  const auto over = [](int trials) {
    return Named(SweepFigures(synthetic::Continuous(trials)), "gap_over_friction").plot;
  };
  CHECK_THAT(over(5000), !Contains("'median'"));
  CHECK_THAT(over(5001), Contains("'median'"));
}

TEST_CASE("Three parameters of one file name are numbered from the second on") {
  sweep::SweepResult result = synthetic::Continuous(4);
  result.parameters.push_back({"c", {}, 0.0, 1.0});
  for (auto& row : result.rows) row.theta.push_back(synthetic::Numeric("0.5"));
  for (size_t i = 0; i < 3; ++i) result.parameters[i].key = std::string(i + 1, '?');
  sweep::Summarise(result);
  CHECK(Names(SweepFigures(result)) ==
        std::vector<std::string>{"fig08_gap_by_trial", "gap_over_parameter", "gap_over_parameter_2",
                                 "gap_over_parameter_3"});
}

}  // namespace
}  // namespace rift::report
