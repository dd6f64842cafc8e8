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

}  // namespace
}  // namespace rift::report
