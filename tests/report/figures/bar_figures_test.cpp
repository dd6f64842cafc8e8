// Figures of levels and settings beside sizes, labels and data worked out by hand.

#include "report/figures/sweep_plots.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <regex>

#include "report/synthetic_sweep.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;
using sweep::LevelSummary;

std::vector<LevelSummary> Levels(size_t count, size_t letters) {
  const LevelSummary level{
      .level = std::string(letters, 'a'), .n = 5, .told = 7, .mean_gap_m = 0.02, .sd_gap_m = 0.004};
  return std::vector<LevelSummary>(count, level);
}

constexpr ReportOptions kWide{.width_px = 490};

TEST_CASE("Labels of bars lie flat while they fit, slant up to twenty and stand upright above") {
  const auto mean = [](size_t count, size_t letters) {
    return MeanByLevelFigure("name", "surface", Levels(count, letters), 0.06, kWide);
  };
  // Ten labels of five letters take 7 px x 6 x 10 of the 490 - 70 px between the axis' ends.
  const Figure flat = mean(10, 5), slanted = mean(10, 6), most = mean(20, 6), upright = mean(21, 6);
  CHECK_THAT(flat.plot, Contains(R"(set xtics ('aaaaa'."\n".'n = 5' 0, 'aaaaa'."\n".'n = 5' 1,)"));
  CHECK(flat.height_px == 326);
  for (const Figure* figure : {&slanted, &most}) {
    CHECK_THAT(figure->plot, Contains("set xtics rotate by 40 right ('aaaaaa, n = 5' 0, 'aaaaaa,"));
    CHECK(figure->height_px == 326 + 50);  // 4.2 px x (6 + 6)
  }
  CHECK_THAT(upright.plot, Contains("set xtics rotate by 90 right ('aaaaaa' 0, 'aaaaaa' 1,"));
  CHECK(upright.height_px == 326 + 39);                   // 6.5 px x 6
  CHECK_THAT(mean(2, 29).plot, Contains("set xtics ("));  // 7 px x 30 x 2
  CHECK_THAT(mean(2, 30).plot, Contains("set xtics rotate by 40 right ("));
  // A label has at most 34 letters.
  CHECK(mean(21, 34).height_px == 326 + 221);
  CHECK(mean(21, 35).height_px == 326 + 221);
  const Figure failures = FailuresByLevelFigure("name", "surface", Levels(10, 6), kWide);
  CHECK_THAT(failures.plot, Contains("rotate by 40 right ('aaaaaa, of 7' 0,"));
  CHECK(failures.height_px == 294 + 50);
}

TEST_CASE("A bar chart grows by 16 px a bar up to twice the width of a figure") {
  for (const auto& [bars, width_px] :
       {std::pair{1, 490}, {25, 490}, {26, 506}, {55, 970}, {56, 980}, {200, 980}}) {
    INFO(bars);
    const auto levels = Levels(static_cast<size_t>(bars), 1);
    CHECK(MeanByLevelFigure("name", "a", levels, 0.06, kWide).width_px == width_px);
    CHECK(FailuresByLevelFigure("name", "a", levels, kWide).width_px == width_px);
  }
}

TEST_CASE("Means of levels are bars, whiskers and crosses at their level's place") {
  const std::vector<LevelSummary> levels{
      {.level = "a", .n = 3, .mean_gap_m = 0.02, .sd_gap_m = 0.005},
      {.level = "b", .not_ok = 1},
      {.level = "c", .n = 4, .mean_gap_m = 0.081, .sd_gap_m = 0.03},
      {.level = "d", .n = 1, .mean_gap_m = 0.05},
      {.level = "e", .n = 2, .mean_gap_m = 0.04, .sd_gap_m = 0.0}};
  const Figure figure = MeanByLevelFigure("name", "surface", levels, 0.06, {});
  CHECK(figure.name == "name");
  CHECK(figure.title == "Mean Sim-to-Real gap by surface");
  CHECK_THAT(figure.plot,
             Contains("$bars << EOD\n0 0.02 0.7 \n2 0.081 0.7 \n3 0.05 0.7 \n4 0.04 0.7 \nEOD\n") &&
                 Contains("$whiskers << EOD\n0 0.02 0.005 \n2 0.081 0.03 \nEOD\n") &&
                 Contains("$missing << EOD\n1 \nEOD\n"));
  // 1.03 x (0.081 + 0.03) is below the round 0.12, of which 9 % is where the numbers stand.
  CHECK_THAT(figure.plot, Contains("set xrange [-0.6:4.6]\nset yrange [0:0.12]\n") &&
                              Contains("$missing using 1:(0.03 * 0.12) with") &&
                              Contains("$bars using 1:(0.0108):(sprintf('%.3f', $2))") &&
                              Contains("0.06 with lines"));
  // A threshold that no mean reaches ends the axis; without scatter and losses their series go.
  const Figure bare = MeanByLevelFigure("name", "surface", {levels[3], levels[4]}, 0.3, {});
  CHECK_THAT(bare.plot, Contains("set xrange [-0.6:1.6]\nset yrange [0:0.4]\n") &&
                            !Contains("whiskers") && !Contains("missing"));
  CHECK_THAT(MeanByLevelFigure("n", "a", Levels(12, 1), 0.06, {}).plot, Contains("sprintf"));
  CHECK_THAT(MeanByLevelFigure("n", "a", Levels(13, 1), 0.06, {}).plot, !Contains("sprintf"));
}

TEST_CASE("Failures are of the trials that fail or do not, some of them without a gap") {
  // Of seven trials two arrived within the threshold, one beyond it, three fell and one was lost.
  const LevelSummary level{.level = "a", .n = 3, .failures = 4, .told = 6, .not_ok = 4};
  const Figure figure = FailuresByLevelFigure("name", "surface", {level}, {});
  CHECK(figure.title == "Trials that fail by surface");
  CHECK_THAT(figure.plot, Contains("$bars << EOD\n0 4 0.7 \nEOD\n") && Contains(".'of 6' 0)") &&
                              Contains("set ylabel 'trials that fail'\n"));
}

TEST_CASE("Failures of levels are counted on an axis of about five steps") {
  for (const auto& [most, end, step] : {std::tuple{0, "1.15", 1},
                                        {1, "1.15", 1},
                                        {5, "5.75", 1},
                                        {6, "6.9", 2},
                                        {10, "11.5", 2},
                                        {11, "12.65", 3}}) {
    std::vector<LevelSummary> levels = Levels(3, 1);
    levels[1].failures = most;
    levels[2].not_ok = 1;
    const Figure figure = FailuresByLevelFigure("name", "surface", levels, {});
    INFO(most);
    CHECK_THAT(figure.plot,
               Contains(fmt::format("$bars << EOD\n0 0 0.7 \n1 {} 0.7 \n2 0 0.7 \nEOD\n"
                                    "$missing << EOD\n2 \nEOD\n",
                                    most)));
    CHECK_THAT(figure.plot, Contains(fmt::format("set xrange [-0.6:2.6]\nset yrange [0:{}]\n"
                                                 "set ytics {}\n",
                                                 end, step)));
    CHECK_THAT(figure.plot,
               Contains(fmt::format("set label '{0}' at 1,{0} center offset 0,0.6\n", most)));
    CHECK_THAT(figure.plot, Contains(fmt::format("using 1:(0.03 * {}) with", end)));
  }
  CHECK_THAT(FailuresByLevelFigure("n", "a", Levels(40, 1), {}).plot, Contains("set label"));
  CHECK_THAT(FailuresByLevelFigure("n", "a", Levels(41, 1), {}).plot, !Contains("set label"));
}

TEST_CASE("A series without a single gap keeps its name, its colour and its crosses") {
  sweep::SweepResult result = synthetic::Grid();
  for (sweep::TrialRow& row : result.rows) {
    if (row.theta[1].text == "0.15" && row.theta[2].text == "0.30") synthetic::LoseGap(&row, "");
  }
  sweep::Summarise(result);
  const SettingGrid grid = LayOut(result);
  const Figure figure = GapBySettingFigure(result, grid, {});
  CHECK_THAT(figure.plot, Contains("keyentry with boxes lc rgb '#0072B2' title 'v_min 0.15, "
                                   "v_max 0.30'") &&
                              !Contains("bars_0"));
  // Four bars of 0.21 around each of the three surfaces: the first at i - 1.5 x 0.21.
  CHECK_THAT(figure.plot,
             Contains("$missing << EOD\n-0.315 \n0.685 \n1.685 \nEOD\n") &&
                 Contains("$bars_1 << EOD\n-0.105 0.03 0.1932 \n0.895 0.05 0.1932 \n"
                          "1.895 0.07 0.1932 \nEOD\n") &&
                 Contains("$trials << EOD\n-0.105 0.026 \n-0.105 0.034 \n0.895 0.046 \n"));
}

TEST_CASE("A setting that was not tried leaves its place free and the others where they are") {
  sweep::SweepResult result = synthetic::Grid();
  std::erase_if(result.rows, [](const sweep::TrialRow& row) {
    return row.theta[0].text == "sand_fine" && row.theta[1].text == "0.15" &&
           row.theta[2].text == "0.50";
  });
  sweep::Summarise(result);
  CHECK_THAT(GapBySettingFigure(result, LayOut(result), {}).plot,
             Contains("$bars_1 << EOD\n-0.105 0.03 0.1932 \n1.895 0.07 0.1932 \nEOD\n"));
}

/// Mean gaps by row and column; NaN: no gap, 0: no such setting.
struct Map {
  explicit Map(const std::vector<std::vector<double>>& means_m, size_t letters = 1) {
    grid.main_name = "main";
    grid.others_name = "others";
    for (const auto& row : means_m) settings.emplace_back(row.size());
    for (size_t i = 0; i < means_m.size(); ++i) {
      grid.mains.push_back({.level = fmt::format("m{}", i)});
      grid.cells.emplace_back();
      for (size_t j = 0; j < means_m[i].size(); ++j) {
        settings[i][j].mean_gap_m = means_m[i][j];
        grid.cells[i].push_back(means_m[i][j] == 0.0 ? nullptr : &settings[i][j]);
      }
    }
    for (size_t j = 0; j < means_m[0].size(); ++j) {
      grid.others.push_back({.level = std::string(letters, 'a')});
    }
  }

  std::vector<std::vector<sweep::SettingResult>> settings;
  SettingGrid grid;
};

Figure MapOf(size_t columns, size_t rows, size_t letters) {
  const Map map(std::vector(rows, std::vector<double>(columns, 0.05)), letters);
  return HeatMapFigure({}, map.grid, {});
}

TEST_CASE("A heat map's cells have the colours of its range and numbers that can be read on them") {
  const Map map({{0.02, 0.0795, 0.0805}, {NAN, 0.0, 0.12}});
  const std::string plot = HeatMapFigure({}, map.grid, {}).plot;
  CHECK_THAT(plot, Contains("$cells << EOD\n0 0 0.02 \n1 0 0.0795 \n2 0 0.0805 \n2 1 0.12 \nEOD"));
  // White numbers below six tenths of the range, black ones above.
  CHECK_THAT(plot, Contains("$on_dark << EOD\n0 0 0.02 \n1 0 0.0795 \nEOD") &&
                       Contains("$on_light << EOD\n2 0 0.0805 \n2 1 0.12 \nEOD") &&
                       Contains("$on_dark using 1:2:(sprintf('%.3f', $3)) with labels center "
                                "textcolor rgb '#FFFFFF'") &&
                       Contains("$on_light using 1:2:(sprintf('%.3f', $3)) with labels center "
                                "textcolor rgb '#000000'"));
  CHECK_THAT(plot,
             Contains("rectangle center 0,1 size 1,1") && Contains("set label 'no gap' at 0,1 ") &&
                 Contains("rectangle center 1,1 size 1,1") && Contains("set label '' at 1,1 "));
  CHECK_THAT(plot, Contains("set cbrange [0.02:0.12]\n") &&
                       Contains("set xlabel 'others'\nset ylabel 'main'\n") &&
                       Contains("set xrange [-0.5:2.5]\nset yrange [1.5:-0.5]\n"));
  CHECK_THAT(MapOf(2, 1, 1).plot, Contains("set cbrange [0.05:0.050001]\n"));
}

TEST_CASE("A cell of a heat map that some trial of has no gap has a cross that can be seen on it") {
  Map map({{0.02, 0.03}, {NAN, 0.12}});
  sweep::SweepResult result;
  result.rows.resize(2);
  result.rows[1].status = sweep::TrialStatus::kTimedOut;
  result.rows[0].comparison.gap_m = 0.02;
  const Figure without = HeatMapFigure(result, map.grid, {});
  CHECK_THAT(without.plot, !Contains("missing"));
  map.settings[0][0].rows = map.settings[1][0].rows = map.settings[1][1].rows = {0, 1};
  map.settings[0][1].rows = {0};
  const Figure with = HeatMapFigure(result, map.grid, {});
  CHECK_THAT(with.plot,
             Contains("$missing_on_dark << EOD\n0.42 -0.32 \nEOD") &&
                 Contains("$missing_on_light << EOD\n1.42 0.68 \nEOD") &&
                 Contains("keyentry with points pt 2 ps 0.5 lw 1.4 lc rgb '#000000' title "
                          "'trials without a gap'"));
  CHECK(with.height_px == without.height_px + 20);
}

TEST_CASE("Slanted labels of bars and of a heat map have room at the left") {
  const auto failures = [](size_t letters) {
    return FailuresByLevelFigure("name", "surface", Levels(6, letters), kWide).plot;
  };
  CHECK_THAT(failures(10), Contains("rotate by 40 right") && !Contains("lmargin"));
  CHECK_THAT(failures(30), Contains("set lmargin at screen 0."));
  CHECK_THAT(MapOf(4, 1, 34).plot, Contains("rotate by 40 right") && Contains("lmargin at screen"));
  CHECK_THAT(MapOf(4, 1, 2).plot, !Contains("lmargin"));
}

/// What gnuplot paints in full colour, in the order of the cells.
struct Painted {
  std::string colour;
  double left_px;
};
using Rows = std::vector<std::vector<double>>;
std::vector<Painted> CellsOf(const Rows& means_m) {
  const Map map(means_m);
  const std::string svg = Render(HeatMapFigure({}, map.grid, {}), FigureFormat::kSvg);
  const std::regex polygon(R"(<polygon fill = 'rgb\(([^)]*)\)' points = '([0-9.]+),)");
  std::vector<Painted> cells;
  for (std::sregex_iterator found(svg.begin(), svg.end(), polygon), end; found != end; ++found) {
    const bool is_hole = (*found)[1] == "230, 230, 230";
    if (!is_hole) cells.push_back({(*found)[1], std::stod((*found)[2])});
  }
  return cells;
}

TEST_CASE("A heat map paints each of its cells in its place, whichever others there are") {
  const std::vector<Painted> cells = CellsOf(Rows{{0.02, 0.0, 0.08}, {NAN, 0.05, 0.12}});
  REQUIRE(cells.size() == 4);
  CHECK(cells[0].colour == " 68,   1,  84");
  CHECK(cells[3].colour == "253, 231,  37");
  CHECK(cells[1].left_px == cells[3].left_px);
  CHECK(cells[1].left_px - cells[0].left_px ==
        Approx(2.0 * (cells[2].left_px - cells[0].left_px)).margin(0.1));
  // Two cells in either line look like a grid, of other columns.
  const std::vector<Painted> odd = CellsOf(Rows{{0.02, 0.05, 0.0}, {0.03, NAN, 0.12}});
  REQUIRE(odd.size() == 4);
  CHECK(odd[0].left_px == odd[2].left_px);
  CHECK(odd[3].left_px - odd[0].left_px ==
        Approx(2.0 * (odd[1].left_px - odd[0].left_px)).margin(0.1));
  CHECK(CellsOf(Rows{{0.02, 0.05, 0.08}}).size() == 3);
  CHECK(CellsOf(Rows{{0.02}, {0.05}}).size() == 2);
  CHECK(CellsOf(Rows{{0.05}}).size() == 1);
}

TEST_CASE("A heat map is as large as its cells need, and slants names that do not fit") {
  const auto size = [](const Figure& figure) {
    return std::pair(figure.width_px, figure.height_px);
  };
  CHECK(size(MapOf(5, 1, 1)) == std::pair(480, 140));
  CHECK(size(MapOf(6, 2, 1)) == std::pair(526, 170));
  CHECK(size(MapOf(22, 1, 1)) == std::pair(1422, 140));
  CHECK(size(MapOf(23, 1, 1)) == std::pair(1440, 140));
  // 56 px are seven letters of 7 px and one between two names.
  CHECK(size(MapOf(10, 1, 7)) == std::pair(750, 140));
  CHECK(size(MapOf(10, 1, 8)) == std::pair(750, 140 + 40));
  CHECK(size(MapOf(10, 1, 40)) == std::pair(750, 140 + 170));
  CHECK_THAT(MapOf(10, 1, 7).plot, Contains("set xtics scale 0 ("));
  CHECK_THAT(MapOf(10, 1, 8).plot, Contains("set xtics rotate by 40 right scale 0 ("));
  CHECK_THAT(MapOf(5, 1, 7).plot, Contains("set xtics scale 0 ("));  // 58 px
  CHECK_THAT(MapOf(5, 1, 8).plot, Contains("set xtics rotate by 40 right scale 0 ("));
  // A number needs 40 px, of the 1250 beside the labels.
  CHECK_THAT(MapOf(31, 1, 1).plot, Contains("sprintf"));
  CHECK_THAT(MapOf(32, 1, 1).plot, !Contains("sprintf"));
}

TEST_CASE("The margin of slanted labels is their length less the way to their tic") {
  const auto margin = [](const Figure& figure) {
    const size_t begin = figure.plot.find("set lmargin");
    if (begin == figure.plot.npos) return std::string("none");
    return figure.plot.substr(begin, figure.plot.find('\n', begin) - begin);
  };
  const auto failures = [&](size_t letters) {
    return margin(FailuresByLevelFigure("name", "surface", Levels(6, letters), kWide));
  };
  // "..., of 7" adds six letters and the gap before the axis one, of 5.4 px each. The first tic of
  // six is at a tenth of the 475 px left of the right margin: (199.8 - 47.5) / 0.9 px of 490.
  CHECK(failures(30) == "set lmargin at screen 0.3454");
  CHECK(failures(11) == "set lmargin at screen 0.1127");
  CHECK(failures(10) == "none");  // 49.2 of 55 px
  // In a heat map it is at an eighth of the 380 px of four columns, and names of two letters take
  // 45 + 14 px.
  CHECK(margin(MapOf(4, 1, 34)) == "set lmargin at screen 0.3369");
  CHECK(margin(MapOf(4, 1, 18)) == "set lmargin at screen 0.1312");
  CHECK(margin(MapOf(4, 1, 17)) == "none");
}

TEST_CASE("Bars of settings end at a threshold that no trial reaches and grow with their number") {
  sweep::SweepResult result =
      synthetic::Grid({"ice", "mud", "rock", "sand", "felt", "cork", "tile"});
  result.gap.threshold_m = 0.31;
  const Figure figure = GapBySettingFigure(result, LayOut(result), {});
  CHECK(figure.width_px == 90 + 16 * 28);
  CHECK(figure.height_px == 360);
  CHECK(figure.title == "Sim-to-Real gap by surface and v_min, v_max");
  CHECK_THAT(figure.plot, Contains("set ylabel 'mean gap (m)'\nset xrange [-0.6:6.6]\n"
                                   "set yrange [0:0.4]\n"));
  // 0.154 m is the largest gap of a trial.
  result.gap.threshold_m = 0.06;
  CHECK_THAT(GapBySettingFigure(result, LayOut(result), {}).plot, Contains("set yrange [0:0.2]\n"));
}

}  // namespace
}  // namespace rift::report
