#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "rift/report/figures/figures.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("Gaps after a fit stand over those before in millimetres, held out logs apart") {
  const std::vector<CalibratedTrial> trials{{"a", false, 0.04, 0.03},
                                            {"b", true, 0.02, 0.1},
                                            {"c", false, 0.05, NAN},
                                            {"d", true, NAN, 0.5}};
  const Figure figure = CalibrationGapFigure(trials);
  CHECK_THAT(figure.plot, Contains("$fitted << EOD\n40 30 \nEOD\n") &&
                              Contains("$held_out << EOD\n20 100 \nEOD\n"));
  // 105 mm, the largest of either axis and a margin, below the round 120.
  CHECK_THAT(figure.plot, Contains("set xrange [0:120]\nset yrange [0:120]\n") &&
                              Contains("set xlabel 'gap of the mean simulated path before (mm)'\n"
                                       "set ylabel 'after the fit (mm)'\n"));
  CHECK(figure.height_px == 360);
  CHECK_THAT(CalibrationGapFigure({{"a", false, 0.2, 0.03}}).plot,
             Contains("set xrange [0:250]") && !Contains("held_out"));
  CHECK_THAT(CalibrationGapFigure({{"a", true, 0.04, 0.03}}).plot, !Contains("$fitted"));
  CHECK_THROWS_WITH(CalibrationGapFigure({trials[2], trials[3]}),
                    "no trial has a gap both before and after the fit");
  CHECK_FALSE(CalibrationFigure("name", {}));
}

/// From the origin to there.
trajectory::Trajectory To(double x_m, double y_m) {
  trajectory::Trajectory path;
  path.poses = {{.t_s = 0.0, .x_m = 0.0, .y_m = 0.0}, {.t_s = 1.0, .x_m = x_m, .y_m = y_m}};
  return path;
}

TEST_CASE("The paths of a fit keep their scale between a low and a high picture") {
  // 400 px across for 1 m, and 120 px for what is below the axes; a label each 16 px at least.
  struct Case {
    double height_m;
    int height_px;
    const char* tics;
  };
  for (const auto& [height_m, height_px, tics] :
       {Case{0.5, 320, "0.05"}, Case{0.1, 216, "0.05"}, Case{2.0, 640, "0.1"}}) {
    for (int which = 0; which < 3; ++which) {
      CalibratedPaths paths{.name = "trial 1", .real = To(0.1, 0.01)};
      paths.before = {To(0.1, 0.02)};
      paths.after = {To(0.1, 0.03), To(0.2, -0.001)};
      (which == 0 ? paths.real : which == 1 ? paths.before[0] : paths.after[1]) = To(1.0, height_m);
      if (which != 2) paths.after.pop_back();
      const Figure figure = CalibrationPathFigure(paths);
      INFO(height_m << " " << which);
      CHECK(figure.height_px == height_px);
      CHECK_THAT(figure.plot, Contains(fmt::format("set ytics {}\n", tics)));
      CHECK_THAT(figure.plot,
                 Contains(fmt::format("0.000000 0.000000\n1.000000 {:.6f}\n\n", height_m)));
    }
  }
}

/// The label that is read at the y axis.
std::string StepOf(const Figure& figure) {
  const size_t begin = figure.plot.find("set ytics ") + 10;
  return figure.plot.substr(begin, figure.plot.find('\n', begin) - begin);
}

TEST_CASE("The labels of a fit's paths are one, two or five times a power of ten apart") {
  // 400 px across: 16 px are 0.016 m of 0.4 m, 0.02 m of 0.5 m, 0.0204 m of 0.51 m and so on.
  for (const auto& [width_m, step] : {std::pair{0.25, "0.01"},
                                      {0.26, "0.02"},
                                      {0.4, "0.02"},
                                      {0.5, "0.02"},
                                      {0.51, "0.05"},
                                      {1.25, "0.05"},
                                      {1.26, "0.1"},
                                      {40.0, "2"}}) {
    INFO(width_m);
    CHECK(StepOf(CalibrationPathFigure({.name = "a", .real = To(width_m, 0.2 * width_m)})) == step);
  }
}

TEST_CASE("The paths of a fit are as high as they are wide, and those of no length a millimetre") {
  CHECK(CalibrationPathFigure({.name = "a", .real = To(1.0, 1.2)}).height_px == 600);
  const Figure still = CalibrationPathFigure({.name = "a", .real = To(0.0, 0.0)});
  CHECK(still.height_px == 520);
  CHECK(StepOf(still) == "5e-05");  // 16 of 400 px
  // Of higher ones the height is the limit: 520 px for 1.6 m, of which 16 are 0.049 m.
  CHECK(StepOf(CalibrationPathFigure({.name = "a", .real = To(1.0, 1.6)})) == "0.05");
  CHECK(StepOf(CalibrationPathFigure({.name = "a", .real = To(1.0, 1.7)})) == "0.1");
}

TEST_CASE("Paths to the left and to the right of the start, or downwards, have the same picture") {
  for (const double x_m : {-1.0, 1.0}) {
    for (const double y_m : {-0.4, 0.4}) {
      const Figure figure = CalibrationPathFigure({.name = "a", .real = To(x_m, y_m)});
      INFO(x_m << " " << y_m);
      CHECK(figure.height_px == 280);
      CHECK(StepOf(figure) == "0.05");
    }
  }
}

TEST_CASE("The paths of a fit are named by their level, if it has one, and by what was held out") {
  sweep::CalibrationReport report;
  report.trials = {{"", "2", "real/a.csv", false, 0.04, 0.03},
                   {"ice", "3", "real/b.csv", false, 0.05, 0.02},
                   {"ice", "4", "real/c.csv", true, 0.05, 0.02}};
  report.shown_real = To(1.0, 0.2);
  using Catch::Matchers::Contains;
  for (const auto& [shown, name] : {std::pair{size_t{0}, "robot, trial 2'"},
                                    {size_t{1}, "robot, ice, trial 3'"},
                                    {size_t{2}, "robot, ice, trial 4 (held out)'"}}) {
    report.shown = shown;
    const auto figure = CalibrationFigure("fit", report);
    REQUIRE(figure);
    CHECK_THAT(figure->plot, Contains(name));
  }
  report.shown_real = {};
  CHECK_THAT(CalibrationFigure("fit", report)->plot, !Contains("robot"));
  // A gap on one side of the fit alone is none to draw.
  for (sweep::CalibrationTrial& trial : report.trials) trial.gap_after_m = NAN;
  CHECK_FALSE(CalibrationFigure("fit", report));
  report.trials[1] = {"ice", "3", "real/b.csv", false, NAN, 0.02};
  CHECK_FALSE(CalibrationFigure("fit", report));
}

}  // namespace
}  // namespace rift::report
