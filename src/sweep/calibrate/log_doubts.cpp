#include "log_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "rift/statistics/descriptive.hpp"

namespace rift::sweep {
namespace {

using trajectory::StampedPose;

constexpr double kBetweenRows = 2.0;  // of the reach radius: a robot is nearest between two rows

double Nearest_m(const trajectory::Trajectory& log, const control::Waypoint& waypoint) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const StampedPose& pose : log.poses) {
    nearest_m = std::min(nearest_m, std::hypot(pose.x_m - waypoint.x_m, pose.y_m - waypoint.y_m));
  }
  return nearest_m;
}

/// About the first waypoint that the log misses; the start is where somebody put the robot down.
std::optional<std::string> MissText(const LogOfTask& one) {
  for (size_t i = 1; i < one.waypoints.size(); ++i) {
    const control::Waypoint& waypoint = one.waypoints[i];
    const double nearest_m = Nearest_m(*one.log, waypoint);
    if (nearest_m <= kBetweenRows * one.reach_radius_m) continue;
    return fmt::format(
        "it comes no nearer than {:.3f} m to the waypoint at x {:g} m, y {:g} m, which counts as "
        "reached within {:g} m (control.reach_radius_m): a log of another task, in another frame "
        "or cut short, and the fit drives this task",
        nearest_m, waypoint.x_m, waypoint.y_m, one.reach_radius_m);
  }
  return std::nullopt;
}

bool AreCopies(const LogOfTask& a, const LogOfTask& b) {
  return std::equal(a.log->poses.begin(), a.log->poses.end(), b.log->poses.begin(),
                    b.log->poses.end(), [](const StampedPose& p, const StampedPose& q) {
                      return p.t_s == q.t_s && p.x_m == q.x_m && p.y_m == q.y_m;
                    });
}

// The published trials of a surface lie within 0.11 of their median, two of another speed 0.2 and
// 0.27 below.
constexpr double kOtherSpeed = 0.14;
constexpr size_t kFewestOfGroup = 5;

/// Median way ratio of the logs of a group; none when too few are known.
std::optional<double> UsualWayRatio(const std::vector<LogOfTask>& logs, const std::string& group) {
  std::vector<double> ratios;
  for (const LogOfTask& log : logs) {
    if (log.group == group && !std::isnan(log.way_ratio)) ratios.push_back(log.way_ratio);
  }
  if (ratios.size() < kFewestOfGroup) return std::nullopt;
  return statistics::Median(std::move(ratios));
}

std::optional<std::string> SpeedText(const LogOfTask& one, std::optional<double> usual) {
  if (!usual || !(*usual > 0.0) || !(std::abs(one.way_ratio / *usual - 1.0) > kOtherSpeed)) {
    return std::nullopt;
  }
  return fmt::format(
      "under the commands of its setting the simulator drives {:.2f} times as far as this log, and "
      "{:.2f} times as the other logs of {}: it was driven with other speeds than its name says, "
      "or with another battery; leave it out, or mend its setting",
      one.way_ratio, *usual, one.group.empty() ? "the fit" : one.group);
}

/// One kind of doubt: its first log, and how many there are.
struct Kind {
  std::string source, text;
  size_t logs = 0;

  void Add(const std::string& of, const std::string& doubt) {
    if (logs++ == 0) source = of, text = doubt;
  }
  void SayTo(std::vector<std::string>& doubts) const {
    if (logs == 0) return;
    const std::string more = fmt::format(" (and {} more log{})", logs - 1, logs == 2 ? "" : "s");
    doubts.push_back(source + (logs > 1 ? more : "") + ": " + text);
  }
};

}  // namespace

std::vector<std::string> DoubtsOfLogs(const std::vector<LogOfTask>& logs) {
  Kind misses, copies, speeds;
  for (auto one = logs.begin(); one != logs.end(); ++one) {
    if (const auto miss = MissText(*one)) misses.Add(one->source, *miss);
    if (const auto speed = SpeedText(*one, UsualWayRatio(logs, one->group))) {
      speeds.Add(one->source, *speed);
    }
    const auto first = std::find_if(logs.begin(), one,
                                    [&](const LogOfTask& other) { return AreCopies(other, *one); });
    if (first == one) continue;
    copies.Add(one->source, fmt::format("it has the rows of {}: one drive that counts as two "
                                        "makes the intervals too narrow",
                                        first->source));
  }
  std::vector<std::string> doubts;
  for (const Kind& kind : {misses, copies, speeds}) kind.SayTo(doubts);
  return doubts;
}

}  // namespace rift::sweep
