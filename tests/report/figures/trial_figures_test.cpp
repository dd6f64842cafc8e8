// Figures with a mark for every trial beside data and sizes worked out by hand.

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "report/figures/sweep_plots.hpp"
#include "report/synthetic_sweep.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;

/// One parameter, a value for each name, with trials "1", "2", ... of these gaps (NaN: lost).
sweep::SweepResult Trials(const std::vector<std::string>& names,
                          const std::vector<std::vector<double>>& gaps_m) {
  sweep::SweepResult result;
  result.parameters = {{"terrain.surface", {}}};
  for (size_t i = 0; i < names.size(); ++i) {
    result.parameters[0].levels.push_back(synthetic::Word(names[i]));
    for (size_t k = 0; k < gaps_m[i].size(); ++k) {
      result.rows.push_back(
          synthetic::Row({synthetic::Word(names[i])}, std::to_string(k + 1), gaps_m[i][k]));
      if (std::isnan(gaps_m[i][k])) synthetic::LoseGap(&result.rows.back(), "gone");
    }
  }
  sweep::Summarise(result);
  return result;
}

std::string Tics(const Figure& figure) {
  const size_t begin = figure.plot.find("set ytics (");
  return figure.plot.substr(begin, figure.plot.find('\n', begin) - begin);
}

TEST_CASE("Up to the limit all settings are drawn by the main factor, beyond it the worst") {
  ReportOptions options;
  options.worst_settings = 3;
  const sweep::SweepResult three =
      Trials({"a", "b", "c"}, {{0.01, 0.03}, {0.08, 0.06}, {0.05, 0.05}});
  const Figure all = GapByTrialFigure(three, options);
  CHECK(Tics(all) == "set ytics ('a' 0, 'b' 1, 'c' 2)");
  CHECK_THAT(all.plot, Contains("set xlabel 'gap (m)'\nset xrange [0:0.1]\nset yrange [2.6:-0.6]"));
  CHECK_THAT(all.plot, Contains("$trial_0 << EOD\n0.01 0 \n0.08 1 \n0.05 2 \nEOD") &&
                           Contains("$trial_1 << EOD\n0.03 0 \n0.06 1 \n0.05 2 \nEOD"));
  // From the smallest gap of a setting to its largest; none where they are the same.
  CHECK_THAT(all.plot, Contains("$ranges << EOD\n0.01 0 0.02 0 \n0.06 1 0.02 0 \nEOD"));
  options.worst_settings = 2;
  const Figure worst = GapByTrialFigure(three, options);
  CHECK(Tics(worst) == "set ytics ('b' 0, 'c' 1)");
  CHECK_THAT(worst.plot, Contains("set xlabel 'gap (m), the 2 worst of 3 settings'\n"));
  // One without any gap shows nothing, and is worst for want of knowledge: it gives its place up.
  const Figure lost = GapByTrialFigure(Trials({"a", "b", "c"}, {{0.01}, {NAN}, {0.05}}), options);
  CHECK(Tics(lost) == "set ytics ('c' 0, 'a' 1)");
  CHECK_THAT(lost.plot, Contains("gap (m), the 2 worst of 3 settings, 2 with a gap'"));
  options.worst_settings = 3;
  CHECK_THAT(GapByTrialFigure(Trials({"a", "b"}, {{0.01}, {NAN}}), options).plot,
             Contains("$missing << EOD\n0 1 \nEOD\n") && Contains("set xlabel 'gap (m)'\n"));
}

TEST_CASE("The figure of trials has a line a setting and room for their names") {
  const auto size = [](size_t settings, size_t letters) {
    const std::string name(letters, 'a');
    std::vector<std::string> names;
    for (size_t i = 0; i < settings; ++i) names.push_back(fmt::format("{:0>{}}", i, letters));
    const Figure figure =
        GapByTrialFigure(Trials(names, std::vector<std::vector<double>>(settings, {0.05})), {});
    return std::pair(figure.width_px, figure.height_px);
  };
  CHECK(size(1, 1) == std::pair(480, 201));
  CHECK(size(3, 16) == std::pair(480, 201));
  CHECK(size(4, 17) == std::pair(486, 218));
  CHECK(size(5, 44) == std::pair(648, 235));
  CHECK(size(5, 45) == std::pair(648, 235));  // shortened
}

TEST_CASE(
    "Up to eight trials of a setting have a shape and a colour each, in a key of two columns") {
  const auto drawn = [](size_t trials) {
    std::vector<double> gaps_m;
    for (size_t i = 0; i < trials; ++i) gaps_m.push_back(0.01 * static_cast<double>(i + 1));
    return GapByTrialFigure(Trials({"a"}, {gaps_m}), {}).plot;
  };
  for (const auto& [trials, lines] : {std::pair{1, 3}, {2, 4}, {3, 4}, {8, 7}, {9, 7}, {12, 7}}) {
    CHECK_THAT(drawn(static_cast<size_t>(trials)),
               Contains(fmt::format("set tmargin {}\n", lines)));
  }
  const std::string eight = drawn(8), nine = drawn(9);
  const std::vector<std::pair<int, const char*>> styles{
      {7, "#0072B2"},  {5, "#E69F00"}, {9, "#009E73"}, {11, "#CC79A7"},
      {13, "#56B4E9"}, {6, "#D55E00"}, {4, "#F0E442"}, {8, "#999999"}};
  for (size_t i = 0; i < styles.size(); ++i) {
    CHECK_THAT(eight, Contains(fmt::format("$trial_{} using 1:2 with points pt {} ps 0.6 lc rgb "
                                           "'{}' title 'trial {}'",
                                           i, styles[i].first, styles[i].second, i + 1)));
    CHECK_THAT(nine, Contains(fmt::format("$trial_{} using 1:2 with points pt 7 ps 0.6 lc rgb "
                                          "'#0072B2' notitle",
                                          i)));
  }
  // "2" comes before "10".
  CHECK_THAT(drawn(12),
             Contains("$trial_1 << EOD\n0.02 0 \nEOD") && Contains("$trial_9 << EOD\n0.1 0 \nEOD"));
}

/// The rows of a data block.
std::vector<std::vector<double>> Rows(const std::string& plot, const std::string& name) {
  const std::string head = "$" + name + " << EOD\n";
  std::istringstream block(plot.substr(plot.find(head) + head.size()));
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(block, line) && line != "EOD";) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (double cell = 0.0; cells >> cell;) rows.back().push_back(cell);
  }
  return rows;
}

TEST_CASE("More trials than can be told apart are fifty bins of their quantiles") {
  // The gap rises evenly from 0.02 to 0.08 m over friction 0.2 to 0.8: 0.0012 m a bin.
  ReportOptions options;
  options.max_points = 4999;
  const sweep::SweepResult result = synthetic::Continuous(5000);
  const std::string plot = GapOverParameterFigure("name", result, 0, options).plot;
  const auto bins = Rows(plot, "bins");
  REQUIRE(bins.size() == 50);
  for (size_t i = 0; i < bins.size(); ++i) {
    const double from = static_cast<double>(i);
    INFO(i);
    REQUIRE(bins[i].size() == 5);
    CHECK(bins[i][0] == Approx(0.2 + 0.012 * (from + 0.5)));
    CHECK(bins[i][1] == Approx(0.02 + 0.0012 * (from + 0.05)).margin(2e-5));
    CHECK(bins[i][2] == Approx(0.02 + 0.0012 * (from + 0.5)).margin(2e-5));
    CHECK(bins[i][3] == Approx(0.02 + 0.0012 * (from + 0.95)).margin(2e-5));
    CHECK(bins[i][4] == Approx(0.02 + 0.0012 * (from + 1.0)).margin(2e-5));
  }
  // A hundred trials a bin: 5 % are 4.95 steps of 0.012 mm behind its first one.
  for (size_t i = 0; i < bins.size(); ++i) {
    const double first = 100.0 * static_cast<double>(i) + 0.5;
    CHECK(bins[i][1] == Approx(0.02 + 0.06 * (first + 4.95) / 5000.0).margin(5e-8).epsilon(0.0));
    CHECK(bins[i][3] == Approx(0.02 + 0.06 * (first + 94.05) / 5000.0).margin(5e-8).epsilon(0.0));
  }
  // Two per cent of the range stay free on either side.
  CHECK_THAT(plot, Contains("set xrange [0.188:0.812]\nset yrange [0:0.1]\n") &&
                       Contains("$bins using 1:2:4 with filledcurves") &&
                       Contains("$bins using 1:3 with lines") &&
                       Contains("$bins using 1:5 with points") &&
                       Contains("0.06 with lines lw 1.2 dt 2"));
  options.max_points = 5000;
  CHECK(Rows(GapOverParameterFigure("name", result, 0, options).plot, "pass").size() +
            Rows(GapOverParameterFigure("name", result, 0, options).plot, "fail").size() ==
        5000);
}

TEST_CASE("A trial is drawn at its gap and told to fail by what it counts with") {
  sweep::SweepResult result = synthetic::Continuous(2);
  for (sweep::TrialRow& row : result.rows) row.comparison.gap_m = 0.07;  // above the 0.06 m
  result.rows[0].falsified = true;
  result.rows[1].falsified = false;  // its gap on the way is smaller
  const std::string plot = GapOverParameterFigure("name", result, 0, {}).plot;
  REQUIRE(Rows(plot, "pass").size() == 1);
  CHECK(Rows(plot, "pass").front()[1] == 0.07);
  CHECK_THAT(plot, Contains("title 'holds'") && Contains("title 'fails'") && !Contains("gap up"));
}

TEST_CASE("A value at the end of its range is in the last bin and a trial without a gap in none") {
  sweep::SweepResult result = synthetic::Continuous(60);
  ReportOptions options;
  options.max_points = 10;
  result.rows[0].theta[0] = experiment::NumberValue(0.8);
  result.rows[0].comparison.gap_m = 0.5;
  result.rows[1].theta[0] = experiment::NumberValue(0.2);
  result.rows[1].comparison.gap_m = 0.4;
  result.rows[0].falsified = result.rows[1].falsified = true;
  synthetic::LoseGap(&result.rows[59], "gone");
  const Figure figure = GapOverParameterFigure("name", result, 0, options);
  const auto bins = Rows(figure.plot, "bins");
  CHECK(bins.back()[4] == Approx(0.5));
  CHECK(bins.front()[4] == Approx(0.4));
  CHECK(figure.width_px == 480);
  CHECK(figure.height_px == 320);
  options.max_points = 100;
  const std::string plot = GapOverParameterFigure("name", result, 0, options).plot;
  CHECK(Rows(plot, "missing") == std::vector<std::vector<double>>{{0.795, 0.0}});
  CHECK(Rows(plot, "pass").size() == 38);
  CHECK(Rows(plot, "fail").size() == 21);
}

TEST_CASE("A value that is no number has no place on a scatter plot, a high threshold ends it") {
  sweep::SweepResult result = synthetic::Continuous(6);
  result.rows[2].theta[0] = synthetic::Word("default");
  result.gap.threshold_m = 0.3;
  for (auto& row : result.rows) row.falsified = false;
  const Figure figure = GapOverParameterFigure("name", result, 0, {});
  CHECK(Rows(figure.plot, "pass").size() == 5);
  CHECK_THAT(figure.plot, !Contains("NaN") && Contains("set xlabel 'friction'\n"
                                                       "set ylabel 'gap (m)'\n"
                                                       "set xrange [0.188:0.812]\n"
                                                       "set yrange [0:0.4]\n"));
  CHECK(figure.title == "Sim-to-Real gap over friction");
  ReportOptions options;
  options.max_points = 5;
  CHECK(Rows(GapOverParameterFigure("name", result, 0, options).plot, "bins").size() == 5);
}

TEST_CASE("Names of trials are cut to twenty letters in the legend") {
  sweep::SweepResult result = Trials({"a"}, {{0.01, 0.02}});
  result.rows[0].trial = std::string(20, 'x');
  result.rows[1].trial = std::string(21, 'y');
  const std::string plot = GapByTrialFigure(result, {}).plot;
  CHECK_THAT(plot, Contains("title 'trial xxxxxxxxxxxxxxxxxxxx'") &&
                       Contains("title 'trial yyyyyyyyyy…yyyyyyyyy'"));
}

}  // namespace
}  // namespace rift::report
