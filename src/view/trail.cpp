#include "trail.hpp"

#include <algorithm>

#include "path_offset.hpp"

namespace rift::view {
namespace {

constexpr double kStep_m = 0.002;
constexpr double kApart_m = 0.02;  // the lines to the path

void AddBeside(const Eigen::Vector2d& p_m, const std::vector<Eigen::Vector2d>& path_m,
               BesidePath& beside) {
  const Eigen::Vector2d nearest_m = NearestOnPath(p_m, path_m);
  beside.largest_m = std::max(beside.largest_m, (nearest_m - p_m).norm());
  std::vector<LateralLine>& lines = beside.lines;
  const bool is_apart = lines.empty() || (p_m - lines.back().from_m).norm() >= kApart_m;
  if (is_apart) lines.push_back({p_m, nearest_m});
}

void DropOldest(SceneRobot& robot) {
  std::vector<LateralLine>& lines = robot.beside.lines;
  const bool has_line = !lines.empty() && lines.front().from_m == robot.trail_m.front();
  if (has_line) lines.erase(lines.begin());
  robot.trail_m.erase(robot.trail_m.begin());
}

}  // namespace

void ExtendTrail(const Eigen::Vector2d& p_m, const std::vector<Eigen::Vector2d>& path_m,
                 SceneRobot& robot) {
  std::vector<Eigen::Vector2d>& trail_m = robot.trail_m;
  if (!trail_m.empty() && (p_m - trail_m.back()).norm() <= kStep_m) return;
  trail_m.push_back(p_m);
  if (path_m.size() > 1) AddBeside(p_m, path_m, robot.beside);
  if (trail_m.size() > kTrailLength) DropOldest(robot);
}

void ClearTrail(SceneRobot& robot) {
  robot.trail_m.clear();
  robot.beside = {};
}

}  // namespace rift::view
