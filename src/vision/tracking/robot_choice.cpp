#include "robot_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rift::vision {
namespace {

constexpr double kAtRest_m = 0.02;    // a tag within this of where it was has not moved
constexpr double kDroveAway_m = 0.1;  // no tag at rest is ever measured so far off

}  // namespace

double RobotChoice::Reach_m(double since_s) const {
  return options_.reach_m + options_.reach_mps * std::max(0.0, since_s);
}

bool RobotChoice::IsRival(const Eigen::Vector3d& p_in_map) const {
  return std::any_of(rivals_.begin(), rivals_.end(), [&](const Rival& rival) {
    const double off_m = (p_in_map - rival.p_in_map).norm();
    return off_m < kAtRest_m && off_m < (p_in_map - *robot_in_map_).norm();
  });
}

void RobotChoice::Doubt(double t_s, const Eigen::Vector3d& robot_in_map) {
  if (!doubt_since_s_) doubt_in_map_ = robot_in_map;
  doubt_since_s_ = t_s;
}

/// Each is the rival in reach that is nearest, the nearest pair first: a tag that comes into sight
/// beside a rival has not driven there from its place.
void RobotChoice::NoteRivals(double t_s, std::vector<Eigen::Vector3d> seen_in_map) {
  std::vector<Rival> seen;
  for (;;) {
    double least_m = HUGE_VAL;
    std::size_t rival = 0, tag = 0;
    for (std::size_t i = 0; i < rivals_.size(); ++i) {
      for (std::size_t k = 0; k < seen_in_map.size(); ++k) {
        const double off_m = (rivals_[i].p_in_map - seen_in_map[k]).norm();
        if (off_m > Reach_m(t_s - rivals_[i].seen_s) || off_m >= least_m) continue;
        least_m = off_m;
        rival = i;
        tag = k;
      }
    }
    if (!std::isfinite(least_m)) break;
    seen.push_back({rivals_[rival].first_in_map, seen_in_map[tag], t_s});
    rivals_.erase(rivals_.begin() + static_cast<std::ptrdiff_t>(rival));
    seen_in_map.erase(seen_in_map.begin() + static_cast<std::ptrdiff_t>(tag));
  }
  for (const Eigen::Vector3d& p : seen_in_map) seen.push_back({p, p, t_s});
  rivals_.insert(rivals_.end(), seen.begin(), seen.end());
}

/// The candidate in reach that is nearest; several in reach, and one out of reach, are in doubt.
std::optional<std::size_t> RobotChoice::Best(double t_s,
                                             const std::vector<Eigen::Vector3d>& p_in_map) {
  if (!robot_in_map_) {
    if (p_in_map.size() > 1) Doubt(t_s, p_in_map[0]);
    return 0;
  }
  const double reach_m = Reach_m(t_s - robot_s_);
  std::optional<std::size_t> best, beyond;
  int in_reach = 0;
  for (std::size_t i = 0; i < p_in_map.size(); ++i) {
    if (IsRival(p_in_map[i])) continue;
    const double off_m = (p_in_map[i] - *robot_in_map_).norm();
    if (off_m > reach_m) {
      if (!beyond) beyond = i;
      continue;
    }
    ++in_reach;
    if (!best || off_m < (p_in_map[*best] - *robot_in_map_).norm()) best = i;
  }
  if (in_reach > 1) Doubt(t_s, p_in_map[*best]);
  if (best) return best;
  // A rival, once the robot has been away for so long, may be what is left of it after all.
  if (!beyond && t_s - robot_s_ > options_.doubt_s) beyond = 0;
  if (!beyond) return std::nullopt;
  const Eigen::Vector3d left_behind = *robot_in_map_;
  std::erase_if(rivals_, [&](const Rival& rival) {
    return (rival.p_in_map - p_in_map[*beyond]).norm() < kAtRest_m;
  });
  rivals_.push_back({left_behind, left_behind, t_s});
  doubt_since_s_.reset();
  Doubt(t_s, p_in_map[*beyond]);
  return beyond;
}

/// In doubt, the one that drives is the robot: a rival that left its place while the chosen tag
/// rests takes over.
std::optional<std::size_t> RobotChoice::Mover(double t_s,
                                              const std::vector<Eigen::Vector3d>& p_in_map) {
  if (!IsInDoubt() || (*robot_in_map_ - doubt_in_map_).norm() > kAtRest_m) return std::nullopt;
  const auto has_left = [&](const Rival& rival) {
    return rival.seen_s == t_s && (rival.p_in_map - rival.first_in_map).norm() > kDroveAway_m;
  };
  const auto mover = std::find_if(rivals_.begin(), rivals_.end(), has_left);
  if (mover == rivals_.end()) return std::nullopt;
  const auto found = std::find(p_in_map.begin(), p_in_map.end(), mover->p_in_map);
  *mover = {*robot_in_map_, *robot_in_map_, t_s};
  return static_cast<std::size_t>(found - p_in_map.begin());
}

void RobotChoice::Resolve(double t_s) {
  std::erase_if(rivals_, [&](const Rival& rival) { return t_s - rival.seen_s > options_.doubt_s; });
  if (!doubt_since_s_) return;
  const bool drove_away = (*robot_in_map_ - doubt_in_map_).norm() > kDroveAway_m;
  const bool rivals_rest = std::all_of(rivals_.begin(), rivals_.end(), [](const Rival& rival) {
    return (rival.p_in_map - rival.first_in_map).norm() < kAtRest_m;
  });
  if (rivals_.empty() || (drove_away && rivals_rest)) doubt_since_s_.reset();
}

RobotChoice::Verdict RobotChoice::Choose(double t_s, const std::vector<Eigen::Vector3d>& p_in_map,
                                         bool is_whole) {
  if (is_whole && !p_in_map.empty()) tags_ = static_cast<int>(p_in_map.size());
  if (p_in_map.empty()) return {};
  const std::optional<std::size_t> robot = Best(t_s, p_in_map);
  if (!robot) {
    NoteRivals(t_s, p_in_map);
    return {};
  }
  std::vector<Eigen::Vector3d> others = p_in_map;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(*robot));
  NoteRivals(t_s, std::move(others));
  robot_in_map_ = p_in_map[*robot];
  robot_s_ = t_s;
  if (!is_whole) return {robot, IsInDoubt()};
  if (const auto mover = Mover(t_s, p_in_map)) {
    robot_in_map_ = p_in_map[*mover];
    doubt_since_s_.reset();
    return {mover, true};
  }
  Resolve(t_s);
  return {robot, IsInDoubt()};
}

void RobotChoice::Forget() { *this = RobotChoice(options_); }

}  // namespace rift::vision
