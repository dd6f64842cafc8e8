#include "sweep/calibrate/log_doubts.hpp"

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

namespace rift::sweep {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

const std::vector<control::Waypoint> kWaypoints{
    {"start", 0.0, 0.0, 0.0, false}, {"middle", 0.3, 0.1, {}, true}, {"end", 0.6, 0.1, {}, true}};

trajectory::Trajectory LogOf(const std::vector<Eigen::Vector2d>& positions_m) {
  trajectory::Trajectory log;
  for (const Eigen::Vector2d& p : positions_m) {
    const double t_s = 0.1 * static_cast<double>(log.poses.size());
    log.poses.push_back({.t_s = t_s, .x_m = p.x(), .y_m = p.y()});
  }
  return log;
}

LogOfTask Of(const std::string& source, const trajectory::Trajectory& log) {
  return {source, &log, kWaypoints, 0.05};
}

TEST_CASE("Logs that pass every waypoint within twice the reach radius are not doubted") {
  const trajectory::Trajectory one = LogOf({{0.0, 0.0}, {0.3, 0.199}, {0.501, 0.1}}),
                               far_start = LogOf({{5.0, 5.0}, {0.3, 0.1}, {0.6, 0.1}});
  CHECK(DoubtsOfLogs({Of("a", one), Of("b", far_start)}).empty());
  LogOfTask program = Of("p", far_start);
  program.waypoints.clear();
  CHECK(DoubtsOfLogs({program}).empty());
}

TEST_CASE("The first log that misses a waypoint is named with it, and how many more do") {
  const trajectory::Trajectory good = LogOf({{0.0, 0.0}, {0.3, 0.1}, {0.6, 0.1}}),
                               cut = LogOf({{0.0, 0.0}, {0.3, 0.1}, {0.4, 0.1}}),
                               mirrored = LogOf({{0.0, 0.0}, {0.3, -0.1}, {0.6, -0.1}});
  const auto one = DoubtsOfLogs({Of("good.csv", good), Of("cut.csv", cut)});
  REQUIRE(one.size() == 1);
  CHECK_THAT(one[0], StartsWith("cut.csv: it comes no nearer than 0.200 m to the waypoint at x "
                                "0.6 m, y 0.1 m, which counts as reached within 0.05 m"));
  const auto two = DoubtsOfLogs({Of("mirror.csv", mirrored), Of("cut.csv", cut)});
  REQUIRE(two.size() == 1);
  CHECK_THAT(two[0], StartsWith("mirror.csv (and 1 more log): ") && Contains("x 0.3 m, y 0.1 m"));
}

TEST_CASE("A log with the rows of another one is named with it") {
  const trajectory::Trajectory log = LogOf({{0.0, 0.0}, {0.3, 0.1}, {0.6, 0.1}});
  trajectory::Trajectory later = log;
  later.poses.back().t_s += 0.01;
  CHECK(DoubtsOfLogs({Of("a.csv", log), Of("b.csv", later)}).empty());
  for (double trajectory::StampedPose::*of :
       {&trajectory::StampedPose::x_m, &trajectory::StampedPose::y_m}) {
    trajectory::Trajectory beside = log;
    beside.poses.back().*of += 0.01;
    CHECK(DoubtsOfLogs({Of("a.csv", log), Of("b.csv", beside)}).empty());
  }
  trajectory::Trajectory longer = log;  // whose first rows are those of the other
  longer.poses.push_back({.t_s = 0.3, .x_m = 0.65, .y_m = 0.1});
  CHECK(DoubtsOfLogs({Of("a.csv", log), Of("b.csv", longer)}).empty());
  CHECK(DoubtsOfLogs({Of("a.csv", longer), Of("b.csv", log)}).empty());
  const auto doubts = DoubtsOfLogs({Of("a.csv", log), Of("b.csv", later), Of("c.csv", log)});
  REQUIRE(doubts.size() == 1);
  CHECK_THAT(doubts[0], StartsWith("c.csv: it has the rows of a.csv"));
  const auto more =
      DoubtsOfLogs({Of("a.csv", log), Of("b.csv", log), Of("c.csv", log), Of("d.csv", log)});
  REQUIRE(more.size() == 1);
  CHECK_THAT(more[0], StartsWith("b.csv (and 2 more logs): it has the rows of a.csv"));
  const trajectory::Trajectory cut = LogOf({{0.0, 0.0}, {0.3, 0.1}});
  const auto both = DoubtsOfLogs({Of("a.csv", log), Of("b.csv", log), Of("c.csv", cut)});
  REQUIRE(both.size() == 2);
  CHECK_THAT(both[0], StartsWith("c.csv: it comes no nearer than"));
  CHECK_THAT(both[1], StartsWith("b.csv: it has the rows of a.csv"));
}

TEST_CASE("A waypoint is missed from twice the reach radius on, to any side, and told whole") {
  for (const double side : {-1.0, 1.0}) {
    const trajectory::Trajectory within =
                                     LogOf({{0.0, 0.0}, {0.3 + 0.099 * side, 0.1}, {0.6, 0.1}}),
                                 beyond =
                                     LogOf({{0.0, 0.0}, {0.3 + 0.101 * side, 0.1}, {0.6, 0.1}}),
                                 above = LogOf({{0.0, 0.0}, {0.3, 0.1}, {0.6, 0.1 + 0.101 * side}});
    CHECK(DoubtsOfLogs({Of("a", within)}).empty());
    CHECK(DoubtsOfLogs({Of("a", beyond)}).size() == 1);
    CHECK(DoubtsOfLogs({Of("a", above)}).size() == 1);
  }
  const trajectory::Trajectory log = LogOf({{0.0, 0.0}, {0.42, 0.26}, {0.6, 0.1}});
  LogOfTask one = Of("a.csv", log);
  one.reach_radius_m = 0.07;
  CHECK(DoubtsOfLogs({one, one}) ==
        std::vector<std::string>{
            "a.csv (and 1 more log): it comes no nearer than 0.200 m to the waypoint at x 0.3 m, y "
            "0.1 m, which counts as reached within 0.07 m (control.reach_radius_m): a log of "
            "another task, in another frame or cut short, and the fit drives this task",
            "a.csv: it has the rows of a.csv: one drive that counts as two makes the intervals too "
            "narrow"});
}

TEST_CASE("A log that was driven with another speed than those of its group is named with it") {
  std::vector<trajectory::Trajectory> paths;
  for (int i = 0; i < 6; ++i) {
    paths.push_back(LogOf({{0.0, 0.0}, {0.3, 0.1 + 0.001 * i}, {0.6, 0.1}}));
  }
  std::vector<LogOfTask> logs;
  for (int i = 0; i < 6; ++i) {
    logs.push_back(Of(std::string(1, static_cast<char>('a' + i)) + ".csv", paths[i]));
    logs.back().group = "ground";
    logs.back().way_ratio = 1.1 + 0.01 * i;
  }
  CHECK(DoubtsOfLogs(logs).empty());
  logs[2].way_ratio = 0.8;
  const auto doubts = DoubtsOfLogs(logs);
  REQUIRE(doubts.size() == 1);
  CHECK_THAT(doubts[0], StartsWith("c.csv: under the commands of its setting the simulator drives "
                                   "0.80 times as far as this log, and 1.12 times as the other "
                                   "logs of ground: "));
  logs[4].way_ratio = 1.4;
  CHECK_THAT(DoubtsOfLogs(logs)[0], StartsWith("c.csv (and 1 more log): "));
  logs[4].way_ratio =
      NAN;  // not known: it is not judged, and too few are left to say what is usual
  logs[5].group = "parchment";
  CHECK(DoubtsOfLogs(logs).empty());
}

}  // namespace
}  // namespace rift::sweep
