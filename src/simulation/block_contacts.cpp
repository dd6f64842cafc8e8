#include "block_contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace rift::simulation {
namespace {

using Eigen::Vector3d;

constexpr int kSamples = 24;     // of the circle, to find the part nearest to a block
constexpr int kBisections = 54;  // from there to the last digits, so that mirror images agree

/// Distance to the surface, negative inside, and the unit normal there.
struct Nearest {
  double distance_m = 0.0;
  Vector3d normal = Vector3d::UnitZ();
};

/// Of a block, which stands on the floor: its lower side is no surface.
Nearest NearestOf(const Block& block, const Vector3d& p) {
  const double ahead_m = p.x() - block.x_m, left_m = p.y() - block.y_m;
  const Vector3d beyond(std::abs(ahead_m) - block.half_size_m, std::abs(left_m) - block.half_size_m,
                        p.z() - block.height_m);
  const Vector3d side(std::copysign(1.0, ahead_m), std::copysign(1.0, left_m), 1.0);
  const Vector3d outside = beyond.cwiseMax(0.0);
  if (const double distance_m = outside.norm(); distance_m > 0.0) {
    return {distance_m, outside.cwiseProduct(side) / distance_m};
  }
  Eigen::Index face = 0;
  const double distance_m = beyond.maxCoeff(&face);
  return {distance_m, side[face] * Vector3d::Unit(face)};
}

class Circle {
 public:
  explicit Circle(const RoundEdge& edge) : centre_(edge.centre), radius_m_(edge.radius_m) {
    const Vector3d down = edge.axis * edge.axis.z() - Vector3d::UnitZ();
    down_ = down.norm() > 1e-9 ? Vector3d(down.normalized()) : Vector3d(edge.axis.unitOrthogonal());
    along_ = edge.axis.cross(down_);
  }

  /// From the lowest point on.
  Vector3d At(double angle_rad) const {
    return centre_ + radius_m_ * (std::cos(angle_rad) * down_ + std::sin(angle_rad) * along_);
  }
  /// Sense of the change of the distance to a surface with this normal.
  double Slope(double angle_rad, const Vector3d& normal) const {
    return normal.dot(std::cos(angle_rad) * along_ - std::sin(angle_rad) * down_);
  }

 private:
  Vector3d centre_, down_, along_;
  double radius_m_;
};

/// The angle of the point nearest to the block.
double NearestAngle(const Circle& circle, const Block& block) {
  constexpr double kSample_rad = 2.0 * std::numbers::pi / kSamples;
  double nearest_rad = 0.0, nearest_m = NearestOf(block, circle.At(0.0)).distance_m;
  for (int i = 1; i < kSamples; ++i) {  // 0, 1, -1, 2, -2: no side comes first in a mirror image
    const double angle_rad = kSample_rad * (i % 2 == 1 ? (i + 1) / 2 : -i / 2);
    const double distance_m = NearestOf(block, circle.At(angle_rad)).distance_m;
    if (distance_m < nearest_m) nearest_m = distance_m, nearest_rad = angle_rad;
  }
  double low_rad = nearest_rad - kSample_rad, high_rad = nearest_rad + kSample_rad;
  for (int i = 0; i < kBisections; ++i) {
    const double middle_rad = 0.5 * (low_rad + high_rad);
    const Nearest nearest = NearestOf(block, circle.At(middle_rad));
    (circle.Slope(middle_rad, nearest.normal) > 0.0 ? high_rad : low_rad) = middle_rad;
  }
  return 0.5 * (low_rad + high_rad);
}

}  // namespace

std::vector<ContactPoint> ContactsWithBlocks(const std::vector<Block>& blocks,
                                             const RoundEdge& edge, double margin_m) {
  const Circle circle(edge);
  const double reach_m = edge.radius_m + edge.roundness_m + margin_m;
  std::vector<ContactPoint> contacts;
  const auto add = [&](const Vector3d& on_circle, const Nearest& nearest) {
    const double depth_m = edge.roundness_m - nearest.distance_m;
    if (depth_m <= -margin_m) return;
    contacts.push_back({on_circle - edge.roundness_m * nearest.normal, nearest.normal, depth_m});
  };
  const Vector3d lowest = circle.At(0.0);
  add(lowest, {lowest.z(), Vector3d::UnitZ()});
  const double above_m = lowest.z() - edge.roundness_m - margin_m;
  for (const Block& block : blocks) {
    if (above_m >= block.height_m || NearestOf(block, edge.centre).distance_m >= reach_m) continue;
    const Vector3d on_circle =
        edge.radius_m > 0.0 ? circle.At(NearestAngle(circle, block)) : edge.centre;
    add(on_circle, NearestOf(block, on_circle));
  }
  return contacts;
}

}  // namespace rift::simulation
