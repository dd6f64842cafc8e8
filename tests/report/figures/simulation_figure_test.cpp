#include "rift/report/figures/figures.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <regex>
#include <stdexcept>

#include "report/png.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;

/// 0.25 m/s down a slope of one in four for 2 s, after which the log starts at 10 s.
SimulatedTrial Downhill() {
  SimulatedTrial trial;
  trial.name = "downhill";
  for (int i = 0; i <= 100; ++i) {
    const double x_m = 0.005 * i;
    trial.truth.poses.push_back(
        {.t_s = 10.0 + 0.02 * i, .x_m = x_m, .y_m = 0.0, .z_m = 0.2 - x_m / 4.0, .yaw_rad = 0.0});
    if (i % 5 == 0) trial.logged.poses.push_back(trial.truth.poses.back());
  }
  trial.logged.channels = {{"power_left", std::vector<double>(21, 0.21)},
                           {"power_right", std::vector<double>(21, 0.19)},
                           {"v", std::vector<double>(21, 0.2)}};
  trial.waypoints = {{"start", {0.0, 0.0}}, {"it's_end", {0.5, 0.0}}};
  trial.areas = {{"slope", 0.1, 9.0, -9.0, 9.0}, {"elsewhere", 5.0, 6.0, 5.0, 6.0}};
  trial.ground_xz_m = {{-0.05, 0.2}, {0.0, 0.184}, {0.5, 0.059}};
  return trial;
}

TEST_CASE("A simulated trial is drawn from above and from the side and over time") {
  const std::string svg = Render(SimulationFigure(Downhill()), FigureFormat::kSvg);
  for (const char* text : {"true path", "logged", "start", "it's_end", "slope", "ground", "axle",
                           "true speed", "left wheel", "right wheel"}) {
    INFO(text);
    CHECK_THAT(svg, Contains(text));
  }
  CHECK_THAT(svg, !Contains("elsewhere"));
}

TEST_CASE("A waypoint far from the path is on the drawing, on either axis") {
  for (const Eigen::Vector2d& far_m : {Eigen::Vector2d(2.0, 0.1), Eigen::Vector2d(0.1, -3.0)}) {
    SimulatedTrial trial = Downhill();
    trial.waypoints.push_back({"far", far_m});
    const std::string plot = SimulationFigure(trial).plot;
    const std::regex ranges(R"(set xrange \[(\S+):(\S+)\]\nset yrange \[(\S+):(\S+)\])");
    std::smatch match;
    REQUIRE(std::regex_search(plot, match, ranges));
    CHECK(std::stod(match[1]) < std::min(0.0, far_m.x()));
    CHECK(std::stod(match[2]) > std::max(0.5, far_m.x()));
    CHECK(std::stod(match[2]) < std::max(0.5, far_m.x()) + 0.5);
    CHECK(std::stod(match[3]) < std::min(0.0, far_m.y()));
    CHECK(std::stod(match[4]) > std::max(0.0, far_m.y()));
  }
}

TEST_CASE("Speed is the length along the slope for each second") {
  const std::string plot = SimulationFigure(Downhill()).plot;
  const std::regex row(R"(\$speed << EOD\n(?:\S+ \S+ \n){50}(\S+) (\S+) \n)");
  std::smatch match;
  REQUIRE(std::regex_search(plot, match, row));
  CHECK(std::stod(match[2]) == Approx(0.25 * std::sqrt(1.0 + 1.0 / 16.0)).epsilon(1e-5));
  CHECK(std::stod(match[1]) > 0.9);
  CHECK(std::stod(match[1]) < 1.1);
}

TEST_CASE("The arrows start where the trial starts and ends and point along the heading") {
  SimulatedTrial trial = Downhill();
  trial.truth.poses.back().yaw_rad = M_PI / 2.0;
  const std::string plot = SimulationFigure(trial).plot;
  CHECK_THAT(plot, Contains("set arrow from 0,0 to 0.05,0 "));
  CHECK_THAT(plot, Contains("set arrow from 0.5,0 to 0.5,0.05 "));
}

TEST_CASE(
    "An area is drawn as far as it is shown, on each of its sides, and named if it has a name") {
  SimulatedTrial trial = Downhill();
  trial.waypoints = {{"start", {0.0, 0.0}}, {"left", {0.2, 0.3}}, {"right", {0.2, -0.1}}};
  // Seven centimetres around x = 0 to 0.5 and y = -0.1 to 0.3.
  const auto drawn = [&](const geometry::FloorArea& area) {
    trial.areas = {area};
    const std::string plot = SimulationFigure(trial).plot;
    const size_t begin = plot.find("set object rectangle from ");
    if (begin == plot.npos) return std::string("none");
    const size_t from = begin + std::string("set object rectangle from ").size();
    return plot.substr(from, plot.find(" behind", from) - from) +
           (plot.find("set label 'mat' at") == plot.npos ? "" : " mat");
  };
  CHECK(drawn({"mat", 0.1, 0.4, 0.05, 0.2}) == "0.1,0.05 to 0.4,0.2 mat");
  CHECK(drawn({"", 0.1, 0.4, 0.05, 0.2}) == "0.1,0.05 to 0.4,0.2");
  CHECK(drawn({"mat", -9.0, 9.0, -8.0, 8.0}) == "-0.07,-0.17 to 0.57,0.37 mat");
  CHECK(drawn({"mat", 0.3, 9.0, -8.0, 0.2}) == "0.3,-0.17 to 0.57,0.2 mat");
  CHECK(drawn({"mat", -9.0, 0.3, 0.2, 8.0}) == "-0.07,0.2 to 0.3,0.37 mat");
  for (const geometry::FloorArea& outside : {geometry::FloorArea{"mat", 0.58, 9.0, 0.0, 0.1},
                                             {"mat", -9.0, -0.08, 0.0, 0.1},
                                             {"mat", 0.0, 0.1, 0.38, 9.0},
                                             {"mat", 0.0, 0.1, -9.0, -0.18}}) {
    CHECK(drawn(outside) == "none");
  }
}

TEST_CASE("Heights have a tic every 0.05 m, and every 0.1 m where they span more than 0.25 m") {
  const auto side = [](double top_m) {
    SimulatedTrial trial = Downhill();
    trial.ground_xz_m = {{0.0, 0.0}, {0.5, top_m}, {0.6, 5.0}};  // the last is not in the picture
    for (auto& pose : trial.truth.poses) pose.z_m = 0.01;
    const std::string plot = SimulationFigure(trial).plot;
    const size_t begin = plot.find("set yrange", plot.find("set ylabel 'z (m)'"));
    return plot.substr(begin, plot.find('\n', plot.find("set ytics", begin)) - begin);
  };
  // 0.02 m below the ground and a body of 0.06 m above it.
  CHECK(side(0.16) == "set yrange [-0.02:0.22]\nset ytics 0.05");
  CHECK(side(0.18) == "set yrange [-0.02:0.24]\nset ytics 0.1");
}

TEST_CASE("Powers are those of the true path's log, else of the tracker's, left and right apart") {
  SimulatedTrial trial = Downhill();
  trial.truth.channels = {{"power_right", std::vector<double>(101, 0.4)},
                          {"power_left", std::vector<double>(100, 0.3)}};
  const std::string plot = SimulationFigure(trial).plot;
  CHECK_THAT(plot, Contains("$power_left << EOD\n0 0.3 \n0.02 0.3 \n") &&
                       Contains("$power_right << EOD\n0 0.4 \n0.02 0.4 \n"));
  CHECK_THAT(plot, Contains("1.98 0.3 \n2 NaN \nEOD"));  // a value less than poses
  CHECK_THAT(plot, Contains("$power_left using 1:2 with steps lw 1.4 lc rgb '#009E73' title 'left "
                            "wheel'") &&
                       Contains("$power_right using 1:2 with steps lw 1.4 lc rgb '#CC79A7' title "
                                "'right wheel'"));
  trial.truth.channels = {{"power_left", {}}};
  CHECK_THAT(SimulationFigure(trial).plot, Contains("$power_left << EOD\n0 0.21 \n0.1 0.21 \n") &&
                                               Contains("$power_right << EOD\n0 0.19 \n"));
}

TEST_CASE("What is not known is left out") {
  SimulatedTrial trial = Downhill();
  for (auto& pose : trial.truth.poses) pose.z_m = pose.yaw_rad = NAN;
  trial.logged = {};
  trial.waypoints.clear();
  trial.ground_xz_m.clear();
  const Figure figure = SimulationFigure(trial);
  CHECK(figure.height_px < SimulationFigure(Downhill()).height_px);
  const std::string svg = Render(figure, FigureFormat::kSvg);
  CHECK_THAT(svg, Contains("true path") && Contains("true speed"));
  CHECK_THAT(svg, !Contains("axle") && !Contains("logged") && !Contains("wheel"));
}

TEST_CASE("A robot that never moved still has a figure") {
  SimulatedTrial trial = Downhill();
  trial.logged.poses = {trial.truth.poses.front()};
  trial.waypoints.clear();
  for (auto& pose : trial.truth.poses) pose.x_m = pose.y_m = pose.z_m = 0.0;
  const Figure figure = SimulationFigure(trial);
  CHECK(PngSize(Render(figure, FigureFormat::kPng)) ==
        std::pair(3 * figure.width_px, 3 * figure.height_px));
}

TEST_CASE("A simulated trial without a path is refused") {
  CHECK_THROWS_AS(SimulationFigure({}), std::invalid_argument);
}

/// The lines that begin so.
std::vector<std::string> LinesOf(const std::string& plot, const std::string& begin) {
  std::vector<std::string> lines;
  for (size_t at = plot.find(begin); at != plot.npos; at = plot.find(begin, at + 1)) {
    lines.push_back(plot.substr(at, plot.find('\n', at) - at));
  }
  return lines;
}

/// Along x without heights, powers, waypoints and log.
SimulatedTrial Bare(const std::vector<double>& x_m, double step_s) {
  SimulatedTrial trial;
  trial.name = "bare";
  for (size_t i = 0; i < x_m.size(); ++i) {
    trial.truth.poses.push_back({.t_s = 4.0 + step_s * static_cast<double>(i),
                                 .x_m = x_m[i],
                                 .y_m = 0.0,
                                 .z_m = NAN,
                                 .yaw_rad = 0.0});
  }
  return trial;
}

TEST_CASE("Speed is told in the middle of a window of 0.06 s, of what was driven in it") {
  // x = t^2 at every 32nd of a second: over two steps the speed is that of their middle.
  std::vector<double> x_m;
  for (int i = 0; i <= 5; ++i) x_m.push_back(i * i / 1024.0);
  const std::string plot = SimulationFigure(Bare(x_m, 1.0 / 32.0)).plot;
  CHECK_THAT(plot, Contains("$speed << EOD\n0.015625 0.03125 \n0.03125 0.0625 \n0.0625 0.125 \n"
                            "0.09375 0.1875 \n0.125 0.25 \nEOD\n"));
  CHECK_THAT(plot, Contains("set xlabel 'time since the start (s)'\nset ylabel 'speed (m/s)'\n"
                            "set xrange [0:0.15625]\nset yrange [0:*]\n"));
}

TEST_CASE("Poses nearly as far apart as the window of speeds are taken two by two") {
  const std::string plot = SimulationFigure(Bare({0.0, 0.1, 0.2, 0.3}, 0.0575)).plot;
  CHECK_THAT(plot, Contains("\n0.0575 1.73913 \n0.115 1.73913 \n"));
}

TEST_CASE("Names of waypoints are cut to sixteen letters") {
  SimulatedTrial trial = Downhill();
  trial.waypoints = {{std::string(16, 'a'), {0.0, 0.0}}, {std::string(17, 'b'), {0.5, 0.0}}};
  const std::string plot = SimulationFigure(trial).plot;
  CHECK_THAT(plot, Contains("set label '" + std::string(16, 'a') + "' at 0,0 center") &&
                       Contains("set label 'bbbbbbbb…bbbbbbb' at 0.5,0 center"));
}

TEST_CASE("A robot that stands is drawn on twenty centimetres, one that drives to its margins") {
  const Figure still = SimulationFigure(Bare({0.0, 0.0}, 1.0));
  CHECK(LinesOf(still.plot, "set xrange")[0] == "set xrange [-0.1:0.1]");
  CHECK(LinesOf(still.plot, "set yrange")[0] == "set yrange [-0.07:0.07]");
  // 400 px for 0.2 m, 0.7 times as high, and 95 px around; 192 px of speeds.
  CHECK(still.height_px == 280 + 95 + 192);
  SimulatedTrial aside = Bare({0.0, 0.0}, 1.0);
  aside.truth.poses[1].y_m = 0.1;
  CHECK(SimulationFigure(aside).height_px == 480 + 95 + 192);
  // 0.3 of its 10.14 m.
  SimulatedTrial wide = Bare({0.0, 10.0}, 1.0);
  CHECK(LinesOf(SimulationFigure(wide).plot, "set yrange")[0] == "set yrange [-1.521:1.521]");
  wide.truth.poses[1].y_m = 4.0;
  CHECK(SimulationFigure(wide).height_px == 258 + 192);
  for (auto& pose : wide.truth.poses) pose.z_m = 0.0;
  CHECK(SimulationFigure(wide).height_px == 258 + 110 + 192);  // a side view of 98 px at least
  SimulatedTrial tall = Bare({0.0, 0.0}, 1.0);
  tall.truth.poses[1].y_m = 3.0;
  CHECK(SimulationFigure(tall).height_px == 700 + 192);
}

TEST_CASE("Of the ground no more is drawn than what lies between the ends of the picture") {
  SimulatedTrial trial = Downhill();
  for (auto& pose : trial.truth.poses) pose.z_m = 0.02;
  trial.ground_xz_m = {{-0.08, -3.0}, {-0.06, 0.0}, {0.56, 0.01}, {0.58, 5.0}};
  const std::string plot = SimulationFigure(trial).plot;
  CHECK_THAT(plot, Contains("$ground << EOD\n-0.06 0 \n0.56 0.01 \nEOD\n"));
  CHECK_THAT(plot, Contains("$ground using 1:2:(-0.02) with filledcurves"));
  CHECK(LinesOf(plot, "set yrange")[1] == "set yrange [-0.02:0.08]");
}

}  // namespace
}  // namespace rift::report
