#include "touch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace rift::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSegments = 24;
constexpr int kBisections = 12;  // finds the edge of a block to a micrometre
constexpr int kRimPoints = 8;

std::optional<Touch> IfDeep(const Vector3d& point, const Vector3d& normal, double depth_m) {
  if (depth_m <= 0.0) return std::nullopt;
  return Touch{point, normal, depth_m};
}

/// The ground cut by a vertical plane through a disc's centre: heights over the distance s along
/// `along`, both relative to the centre. The disc is as wide as the wheel, so the highest counts.
class Profile {
 public:
  Profile(const Terrain& terrain, const Vector3d& centre, const Vector3d& along, double radius_m,
          double half_width_m)
      : terrain_(terrain),
        centre_(centre),
        along_(along),
        aside_(half_width_m * Vector3d(-along.y(), along.x(), 0.0)),
        wide_(half_width_m > 0.0),
        radius_m_(radius_m) {}

  /// The point of the ground nearest to the centre, as (s, height).
  Vector2d Nearest() const {
    Vector2d nearest(0.0, -std::numeric_limits<double>::infinity());
    double s = -radius_m_, height = HeightAt(s);
    for (int i = 1; i <= kSegments; ++i) {
      const double next_s = radius_m_ * (2.0 * i / kSegments - 1.0), next_height = HeightAt(next_s);
      if (std::max(height, next_height) > -radius_m_) {
        NearestOfSegment({s, height}, {next_s, next_height}, nearest);
      }
      s = next_s;
      height = next_height;
    }
    return nearest;
  }

 private:
  double HeightAt(double s) const {
    const Vector3d p = centre_ + s * along_;
    double height = terrain_.HeightAt(p.x(), p.y());
    if (wide_) {
      height = std::max({height, terrain_.HeightAt(p.x() + aside_.x(), p.y() + aside_.y()),
                         terrain_.HeightAt(p.x() - aside_.x(), p.y() - aside_.y())});
    }
    return std::max(height - centre_.z(), -10.0 * radius_m_);  // beyond a table: deep, but finite
  }

  void NearestOfSegment(const Vector2d& from, const Vector2d& to, Vector2d& nearest) const {
    const bool step = std::abs(to.y() - from.y()) > 2.0 * (to.x() - from.x());
    if (!step) return KeepNearer(from, to, nearest);
    double low = from.x(), high = to.x();
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high), height = HeightAt(middle);
      const bool still_from = std::abs(height - from.y()) < std::abs(height - to.y());
      (still_from ? low : high) = middle;
    }
    KeepNearer(from, {low, from.y()}, nearest);
    KeepNearer({high, to.y()}, to, nearest);
  }

  static void KeepNearer(const Vector2d& from, const Vector2d& to, Vector2d& nearest) {
    const Vector2d span = to - from;
    const double share =
        span.squaredNorm() > 0.0 ? std::clamp(-from.dot(span) / span.squaredNorm(), 0.0, 1.0) : 0.0;
    const Vector2d candidate = from + share * span;
    if (candidate.squaredNorm() < nearest.squaredNorm()) nearest = candidate;
  }

  const Terrain& terrain_;
  const Vector3d& centre_;
  const Vector3d& along_;
  const Vector3d aside_;
  const bool wide_;
  const double radius_m_;
};

std::optional<Touch> TouchDisc(const Terrain& terrain, const Vector3d& centre,
                               const Vector3d& along, double radius_m, double half_width_m) {
  const Profile profile(terrain, centre, along, radius_m, half_width_m);
  const Vector2d nearest = profile.Nearest();
  const double distance_m = nearest.norm();
  if (distance_m >= radius_m) return std::nullopt;
  const Vector3d ground = centre + nearest.x() * along + nearest.y() * Vector3d::UnitZ();
  Vector3d normal = distance_m > 0.0 ? Vector3d((centre - ground) / distance_m) : Vector3d::UnitZ();
  if (!terrain.IsStepped()) {  // the profile does not see how the ground leans sideways
    const Vector3d aside(-along.y(), along.x(), 0.0);
    normal = (normal + terrain.NormalAt(ground.x(), ground.y()).dot(aside) * aside).normalized();
  }
  return IfDeep(centre - radius_m * normal, normal, radius_m - distance_m);
}

Vector3d Lowest(const Vector3d& axis, const Vector3d& normal) {
  const Vector3d down = axis * axis.dot(normal) - normal;
  const double length = down.norm();
  return length > 1e-9 ? Vector3d(down / length) : Vector3d(axis.unitOrthogonal());
}

}  // namespace

std::optional<Touch> TouchWheel(const Terrain& terrain, const Vector3d& centre,
                                const Vector3d& axle, double radius_m, double width_m) {
  if (const auto plane = terrain.PlaneNear(centre.x(), centre.y(), radius_m)) {
    const Vector3d point = centre + radius_m * Lowest(axle, plane->normal);
    return IfDeep(point, plane->normal, plane->normal.dot(plane->point - point));
  }
  const Vector3d along = axle.cross(Vector3d::UnitZ()).stableNormalized();
  return TouchDisc(terrain, centre, along, radius_m, 0.5 * width_m);
}

std::optional<Touch> TouchBall(const Terrain& terrain, const Vector3d& centre,
                               const Vector3d& forward, double radius_m) {
  if (const auto plane = terrain.PlaneNear(centre.x(), centre.y(), radius_m)) {
    const Vector3d point = centre - radius_m * plane->normal;
    return IfDeep(point, plane->normal, plane->normal.dot(plane->point - point));
  }
  const Vector3d along = Vector3d(forward.x(), forward.y(), 0.0).stableNormalized();
  const Vector3d aside(-along.y(), along.x(), 0.0);
  const auto lengthwise = TouchDisc(terrain, centre, along, radius_m, 0.0);
  const auto crosswise = TouchDisc(terrain, centre, aside, radius_m, 0.0);
  if (!lengthwise || !crosswise) return lengthwise ? lengthwise : crosswise;
  return lengthwise->depth_m > crosswise->depth_m ? lengthwise : crosswise;
}

std::optional<Touch> TouchRim(const Terrain& terrain, const Vector3d& centre, const Vector3d& up,
                              double radius_m) {
  if (const auto plane = terrain.PlaneNear(centre.x(), centre.y(), radius_m)) {
    const Vector3d point = centre + radius_m * Lowest(up, plane->normal);
    return IfDeep(point, plane->normal, plane->normal.dot(plane->point - point));
  }
  std::optional<Touch> deepest;
  const Vector3d forward = up.unitOrthogonal(), left = up.cross(forward);
  for (int i = 0; i < kRimPoints; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kRimPoints;
    const Vector3d point =
        centre + radius_m * (std::cos(angle_rad) * forward + std::sin(angle_rad) * left);
    const double depth_m = terrain.HeightAt(point.x(), point.y()) - point.z();
    if (depth_m <= (deepest ? deepest->depth_m : 0.0)) continue;
    const Vector3d normal =
        terrain.IsStepped() ? Vector3d(Vector3d::UnitZ()) : terrain.NormalAt(point.x(), point.y());
    deepest = Touch{point, normal, depth_m};
  }
  return deepest;
}

}  // namespace rift::simulation
