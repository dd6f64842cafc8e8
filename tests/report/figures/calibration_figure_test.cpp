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

}  // namespace
}  // namespace rift::report
