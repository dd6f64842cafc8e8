#include "rift/report/figures/figures.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <regex>

#include <fmt/format.h>

#include "report/png.hpp"
#include "report/synthetic_sweep.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("Logged targets become waypoints in the order they were driven to") {
  const auto waypoints_m = LoggedWaypoints(synthetic::Path(0.1));
  REQUIRE(waypoints_m.size() == 2);
  CHECK(waypoints_m[0].x() == 0.5);
  CHECK(waypoints_m[1].x() == 1.0);
}

TEST_CASE("A log without targets has no waypoints") {
  trajectory::Trajectory path = synthetic::Path(0.1);
  for (auto& pose : path.poses) pose.target_x_m = pose.target_y_m = NAN;
  CHECK(LoggedWaypoints(path).empty());
}

TEST_CASE("The overlay keeps one scale on both axes and joins the two points of the gap") {
  const ComparedPair pair = synthetic::Pair(0.1);
  const Figure figure = OverlayFigure({pair});
  CHECK_THAT(figure.plot, Contains("set size ratio -1") && Contains("'waypoints'"));
  const std::regex joined(R"(\$largest << EOD\n(\S+) (\S+) \n(\S+) (\S+) \nEOD)");
  std::smatch match;
  REQUIRE(std::regex_search(figure.plot, match, joined));
  const double dx_m = std::stod(match[1]) - std::stod(match[3]);
  const double dy_m = std::stod(match[2]) - std::stod(match[4]);
  CHECK(std::hypot(dx_m, dy_m) == Approx(pair.comparison.gap_m).epsilon(1e-5));
}

TEST_CASE("The overlay of paths in space says that it is seen from above") {
  ComparedPair pair = synthetic::Pair(0.1);
  CHECK_THAT(OverlayFigure({pair}).plot, !Contains("seen from above"));
  pair.is_in_space = true;
  CHECK_THAT(OverlayFigure({pair}).plot, Contains("x (m), seen from above"));
}

TEST_CASE("The labels of a fit's paths do not lie on each other, whatever the paths' size") {
  for (const double size_m : {0.02, 0.3, 2.5, 40.0, 3000.0}) {
    for (const double height : {0.1, 1.0, 8.0}) {
      CalibratedPaths paths{.name = "trial 1"};
      paths.real.poses = {{.t_s = 0.0, .x_m = 0.0, .y_m = 0.0},
                          {.t_s = 1.0, .x_m = size_m, .y_m = height * size_m}};
      paths.before = {paths.real};
      const Figure figure = CalibrationPathFigure(paths);
      std::smatch match;
      REQUIRE(std::regex_search(figure.plot, match, std::regex(R"(set ytics (\S+))")));
      const double labels = height * size_m / std::stod(match[1]);
      INFO(size_m << " m, " << height << ": " << match[1] << " m in " << figure.height_px << " px");
      CHECK(labels * 14.0 < figure.height_px);  // as high as a label
      CHECK(labels >= 0.4);
    }
  }
}

TEST_CASE("The error figure marks the maximum and the threshold") {
  const ComparedPair pair = synthetic::Pair(0.1);
  const std::string svg = Render(ErrorFigure({pair}, {}), FigureFormat::kSvg);
  CHECK_THAT(svg, Contains("threshold 0.06 m"));
  CHECK_THAT(svg, Contains(fmt::format("gap {:.4f} m at u = {:.2f}", pair.comparison.gap_m,
                                       pair.comparison.gap_u)));
}

TEST_CASE("What is left out at the start is drawn but shaded and does not count") {
  gap::GapOptions gap;
  gap.skip_start = 0.5;
  const ComparedPair pair =
      ComparePair("sim", synthetic::Path(0.0), "real", synthetic::Path(0.1), gap);
  CHECK(pair.profile.u.front() == 0.0);
  CHECK_THAT(ErrorFigure({pair}, gap).plot, Contains("'left out'"));
  CHECK_THAT(ErrorFigure({pair}, {}).plot, !Contains("'left out'"));
  CHECK(ErrorCdfFigure({pair}, gap).plot != ErrorCdfFigure({pair}, {}).plot);
}

TEST_CASE("Several real paths give several curves named after them") {
  const std::vector<ComparedPair> pairs = {synthetic::Pair(0.05, "real_1"),
                                           synthetic::Pair(0.1, "it's \"two\" & 50 % `date`")};
  for (const Figure& figure : GapFigures(pairs, {})) {
    const std::string svg = Render(figure, FigureFormat::kSvg);
    INFO(figure.name);
    CHECK_THAT(svg, Contains("real_1"));
    CHECK_THAT(svg, Contains("it's") && Contains("two") && Contains("&amp; 50 % `date`"));
    CHECK(PngSize(Render(figure, FigureFormat::kPng)).first == 3 * figure.width_px);
  }
}

TEST_CASE("The error distribution ends at a share of one hundred percent") {
  const Figure figure = ErrorCdfFigure({synthetic::Pair(0.1)}, {});
  CHECK_THAT(figure.plot, Contains(" 100 \nEOD"));
}

double AxisEndOf(const Figure& figure, const std::string& axis) {
  const std::string begin = "set " + axis + "range [0:";
  const std::size_t at = figure.plot.find(begin);
  REQUIRE(at != std::string::npos);
  return std::stod(figure.plot.substr(at + begin.size()));
}

TEST_CASE("Axes of errors end beyond the largest error and the threshold, by less than as much") {
  for (const double amplitude_m : {0.01, 0.05, 0.0951, 0.0999, 0.1, 0.19, 0.3, 0.499}) {
    const ComparedPair pair = synthetic::Pair(amplitude_m);
    const double largest_m = std::max(pair.comparison.gap_m, gap::GapOptions{}.threshold_m);
    INFO("gap " << pair.comparison.gap_m);
    for (const double end_m :
         {AxisEndOf(ErrorFigure({pair}, {}), "y"), AxisEndOf(ErrorCdfFigure({pair}, {}), "x")}) {
      CHECK(end_m >= 1.05 * largest_m);
      CHECK(end_m < 2.0 * 1.05 * largest_m);
    }
  }
}

TEST_CASE(
    "The overlay covers paths and waypoints with a margin and is never flatter than a quarter") {
  const auto drawn = [](const std::vector<Eigen::Vector2d>& waypoints_m, int width_px = 480) {
    ComparedPair pair = synthetic::Pair(0.0);
    pair.waypoints_m = waypoints_m;
    const Figure figure = OverlayFigure({pair}, {.width_px = width_px});
    const size_t begin = figure.plot.find("set xrange");
    return fmt::format("{}, {} px", figure.plot.substr(begin, figure.plot.find("\nplot") - begin),
                       figure.height_px);
  };
  // The path goes from x = 0 to 1: 6 % of the longer side on each side, and 400 px for 1.12 m.
  CHECK(drawn({}) == "set xrange [-0.06:1.06]\nset yrange [-0.185:0.185], 242 px");
  CHECK(drawn({{0.5, 0.6}}) == "set xrange [-0.06:1.06]\nset yrange [-0.06:0.66], 367 px");
  CHECK(drawn({{0.5, -0.6}}) == "set xrange [-0.06:1.06]\nset yrange [-0.66:0.06], 367 px");
  CHECK(drawn({{-1.0, 0.0}}) == "set xrange [-1.12:1.12]\nset yrange [-0.37:0.37], 242 px");
  CHECK(drawn({{2.0, 0.0}}) == "set xrange [-0.12:2.12]\nset yrange [-0.37:0.37], 242 px");
  CHECK(drawn({{0.0, 4.0}}) == "set xrange [-0.24:1.24]\nset yrange [-0.24:4.24], 640 px");
  CHECK(drawn({}, 240) == "set xrange [-0.06:1.06]\nset yrange [-0.185:0.185], 220 px");
}

TEST_CASE("A curve of many samples is thinned to about a thousand and keeps its last one") {
  for (const auto& [samples, points, second] :
       {std::tuple{999, 999, 1}, {1999, 1999, 1}, {2000, 1001, 2}, {2501, 1251, 2}}) {
    gap::GapOptions gap;
    gap.samples = samples;
    const ComparedPair pair =
        ComparePair("sim", synthetic::Path(0.0), "real", synthetic::Path(0.1), gap);
    REQUIRE(pair.profile.u.size() == static_cast<size_t>(samples));
    const std::string plot = ErrorFigure({pair}, gap).plot;
    const std::string head = "$error_0 << EOD\n";
    const std::string rows =
        plot.substr(plot.find(head) + head.size(), plot.find("EOD\n$maxima") - head.size());
    INFO(samples);
    CHECK(std::count(rows.begin(), rows.end(), '\n') == points);
    CHECK(rows.find(fmt::format("\n{:.7g} ", pair.profile.u[static_cast<size_t>(second)])) ==
          rows.find('\n'));
    CHECK_THAT(rows, Contains("\n1 "));
  }
}

TEST_CASE("Of several pairs the one with the largest gap is marked, and each has its own colour") {
  std::vector<ComparedPair> pairs;
  for (const double bulge_m : {0.05, 0.12, 0.08}) {
    pairs.push_back(synthetic::Pair(bulge_m, fmt::format("real of {}", bulge_m)));
  }
  for (const Figure& figure : {OverlayFigure(pairs), ErrorFigure(pairs, {})}) {
    CHECK_THAT(figure.plot, Contains(fmt::format("gap {:.4f} m", pairs[1].comparison.gap_m)));
    for (const auto& [colour, bulge] :
         {std::pair{"#0072B2", "0.05"}, {"#009E73", "0.12"}, {"#CC79A7", "0.08"}}) {
      CHECK_THAT(figure.plot, Contains(fmt::format("lines lw 1.8 lc rgb '{}' title 'real of {}'",
                                                   colour, bulge)));
    }
  }
  // With that of the simulator seven paths have the eight colours; more are shades.
  const auto last_colour = [](size_t count) {
    const std::vector<ComparedPair> many(count, synthetic::Pair(0.1));
    const std::string plot = OverlayFigure(many).plot;
    const size_t at = plot.find(fmt::format("$real_path_{} using", count - 1));
    return plot.substr(plot.find('#', at), 7);
  };
  CHECK(last_colour(1) == "#0072B2");
  CHECK(last_colour(7) == "#999999");
  CHECK(last_colour(8) == "#FDE725");
  // A name of more than 36 letters is cut in its middle.
  pairs.resize(1);
  for (const size_t letters : {36, 37}) {
    pairs[0].real = pairs[0].sim = std::string(letters, 'x');
    const std::string cut = std::string(18, 'x') + "…" + std::string(17, 'x');
    CHECK_THAT(OverlayFigure(pairs).plot,
               Contains("title '" + (letters == 36 ? std::string(36, 'x') : cut) + "'"));
  }
}

TEST_CASE("No pair is refused") { CHECK_THROWS_AS(OverlayFigure({}), std::invalid_argument); }

TEST_CASE("A place that a robot drives to again is a waypoint again") {
  trajectory::Trajectory path;
  for (const double x_m : {0.5, 0.5, 1.0, 1.0, 0.5}) {
    path.poses.push_back({.x_m = 0.0, .y_m = 0.0, .target_x_m = x_m, .target_y_m = 0.25});
  }
  path.poses.push_back({.x_m = 0.0, .y_m = 0.0, .target_x_m = 0.5, .target_y_m = -0.25});
  path.poses.push_back({.x_m = 0.0, .y_m = 0.0, .target_x_m = 0.5, .target_y_m = NAN});
  using Points = std::vector<Eigen::Vector2d>;
  CHECK(LoggedWaypoints(path) == Points{{0.5, 0.25}, {1.0, 0.25}, {0.5, 0.25}, {0.5, -0.25}});
}

TEST_CASE("Waypoints are those of the real log, or where it has none of the simulated one") {
  trajectory::Trajectory sim = synthetic::Path(0.0), real = synthetic::Path(0.1);
  for (auto& pose : sim.poses) pose.target_x_m = 3.0;
  CHECK(ComparePair("a", sim, "b", real, {}).waypoints_m.front().x() == 0.5);
  for (auto& pose : real.poses) pose.target_x_m = NAN;
  CHECK(ComparePair("a", sim, "b", real, {}).waypoints_m.front().x() == 3.0);
  CHECK_FALSE(ComparePair("a", sim, "b", real, {}).is_in_space);
  for (auto* path : {&sim, &real}) {
    for (auto& pose : path->poses) pose.z_m = 0.0;
  }
  const ComparedPair pair = ComparePair("a", sim, "b", real, {.dimension = gap::Dimension::kXyz});
  CHECK(pair.is_in_space);
  CHECK((pair.sim == "a" && pair.real == "b"));
}

/// Of five points, 0.25 of the way apart.
ComparedPair FivePoints(const std::vector<double>& errors_m) {
  ComparedPair pair{.sim = "sim", .real = "real"};
  for (size_t i = 0; i < 5; ++i) {
    pair.profile.u.push_back(0.25 * static_cast<double>(i));
    pair.profile.error_m.push_back(errors_m[i]);
    pair.profile.sim_m.emplace_back(0.0, 0.0);
    pair.profile.real_m.emplace_back(0.0, 0.0);
  }
  return pair;
}

TEST_CASE("The distribution of errors is of the samples from the share left out on, in order") {
  const ComparedPair pair = FivePoints({0.09, 0.08, 0.01, 0.05, 0.02});
  const auto rows = [&](double skip_start) {
    const std::string plot = ErrorCdfFigure({pair}, {.skip_start = skip_start}).plot;
    const std::string head = "$cdf_0 << EOD\n";
    const size_t begin = plot.find(head) + head.size();
    return plot.substr(begin, plot.find("EOD", begin) - begin);
  };
  CHECK(rows(0.0) == "0.01 20 \n0.02 40 \n0.05 60 \n0.08 80 \n0.09 100 \n");
  CHECK(rows(0.25) == "0.01 25 \n0.02 50 \n0.05 75 \n0.08 100 \n");
  CHECK(rows(0.26) == "0.01 33.33333 \n0.02 66.66667 \n0.05 100 \n");
}

TEST_CASE("Paths of robots that stand at one place are drawn in a millimetre around it") {
  const Figure figure = OverlayFigure({FivePoints({0.0, 0.0, 0.0, 0.0, 0.0})});
  CHECK_THAT(figure.plot, Contains("set xrange [-0.000185:0.000185]\n"
                                   "set yrange [-0.000185:0.000185]\n"));
  CHECK(figure.height_px == 510);
}

}  // namespace
}  // namespace rift::report
