#include "path_offset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rift::view {
namespace {

struct OnPath {
  Eigen::Vector2d p_m;
  Eigen::Vector2d along_m;  ///< the leg on which it lies
};

OnPath Nearest(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& path) {
  OnPath nearest{path.front(), path[1] - path[0]};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector2d leg = path[i] - path[i - 1];
    const double length2 = leg.squaredNorm();
    const double share =
        length2 > 0.0 ? std::clamp((p - path[i - 1]).dot(leg) / length2, 0.0, 1.0) : 0.0;
    const Eigen::Vector2d candidate = path[i - 1] + share * leg;
    if ((candidate - p).squaredNorm() < (nearest.p_m - p).squaredNorm()) nearest = {candidate, leg};
  }
  return nearest;
}

}  // namespace

Eigen::Vector2d NearestOnPath(const Eigen::Vector2d& p_m,
                              const std::vector<Eigen::Vector2d>& path_m) {
  return Nearest(p_m, path_m).p_m;
}

double PathOffset_m(const Eigen::Vector2d& p_m, const std::vector<Eigen::Vector2d>& path_m) {
  if (path_m.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const OnPath nearest = Nearest(p_m, path_m);
  const Eigen::Vector2d off = p_m - nearest.p_m;
  const double left = nearest.along_m.x() * off.y() - nearest.along_m.y() * off.x();
  return std::copysign(off.norm(), left);
}

std::string OffsetText(double offset_m) {
  if (!std::isfinite(offset_m)) return "-";
  return fmt::format("{:.1f} mm {}", 1e3 * std::abs(offset_m), offset_m < 0.0 ? "right" : "left");
}

}  // namespace rift::view
