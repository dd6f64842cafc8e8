#include <algorithm>

#include "track_picture.hpp"

namespace rift::view {
namespace {

constexpr double kApart_m = 0.02;

Eigen::Vector2d Nearest(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& path) {
  Eigen::Vector2d nearest = path.front();
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector2d leg = path[i] - path[i - 1];
    const double length2 = leg.squaredNorm();
    const double share =
        length2 > 0.0 ? std::clamp((p - path[i - 1]).dot(leg) / length2, 0.0, 1.0) : 0.0;
    const Eigen::Vector2d candidate = path[i - 1] + share * leg;
    if ((candidate - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = candidate;
  }
  return nearest;
}

}  // namespace

std::vector<LateralLine> LateralLines(const std::vector<Eigen::Vector2d>& trail_m,
                                      const std::vector<Eigen::Vector2d>& path_m) {
  std::vector<LateralLine> lines;
  if (path_m.size() < 2) return lines;
  for (const Eigen::Vector2d& p : trail_m) {
    if (!lines.empty() && (p - lines.back().from_m).norm() < kApart_m) continue;
    lines.push_back({p, Nearest(p, path_m)});
  }
  return lines;
}

}  // namespace rift::view
