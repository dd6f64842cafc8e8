#include "blocks.hpp"

#include <algorithm>
#include <cmath>

namespace rift::simulation {
namespace {

using Eigen::Vector3d;

constexpr int kMostRounds = 80;
constexpr double kSettled_m = 1e-10;
constexpr double kInside_m = 1e-7;

Vector3d NearestOfBlock(const Block& block, const Vector3d& p) {
  return p.cwiseMax(block.low).cwiseMin(block.high);
}

Vector3d NearestOfDisc(const SweptDisc& disc, const Vector3d& p) {
  const Vector3d out = p - disc.centre;
  const Vector3d in_plane = out - disc.axis.dot(out) * disc.axis;
  const double length = in_plane.norm();
  const double share = length > disc.radius_m ? disc.radius_m / length : 1.0;
  return disc.centre + share * in_plane;
}

/// The point of the disc nearest to the block. Projecting from one convex body to the other and
/// back is gradient descent on half the squared distance; momentum with restarts [O'Donoghue and
/// Candes 2015] makes it fast where the two are nearly parallel.
Vector3d NearestOfDiscTo(const Block& block, const SweptDisc& disc) {
  Vector3d q = NearestOfDisc(disc, NearestOfBlock(block, disc.centre)), ahead = q;
  if (disc.radius_m == 0.0) return q;
  double weight = 1.0;
  for (int round = 0; round < kMostRounds; ++round) {
    const Vector3d next = NearestOfDisc(disc, NearestOfBlock(block, ahead)), moved = next - q;
    if ((ahead - next).dot(moved) > 0.0) weight = 1.0;
    const double next_weight = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * weight * weight));
    ahead = next + (weight - 1.0) / next_weight * moved;
    weight = next_weight;
    q = next;
    if (moved.squaredNorm() < kSettled_m * kSettled_m) break;
  }
  return q;
}

Vector3d LowestPoint(const SweptDisc& disc) {
  const Vector3d down = disc.axis.z() * disc.axis - Vector3d::UnitZ();
  const double length = down.norm();
  const Vector3d edge = length > 1e-9 ? Vector3d(disc.radius_m / length * down) : Vector3d::Zero();
  return disc.centre + edge - disc.sweep_m * Vector3d::UnitZ();
}

}  // namespace

ContactPoint BlockContact(const SweptDisc& disc, const Block& block) {
  const Vector3d q = NearestOfDiscTo(block, disc), p = NearestOfBlock(block, q);
  const double distance_m = (q - p).norm();
  if (distance_m > kInside_m) {
    const Vector3d normal = (q - p) / distance_m;
    return {q - disc.sweep_m * normal, normal, disc.sweep_m - distance_m};
  }
  // The disc itself is in the block, which contact forces never let happen: up and out.
  const Vector3d lowest = LowestPoint(disc);
  return {lowest, Vector3d::UnitZ(), block.high.z() - lowest.z()};
}

void BumpContacts(const Terrain& terrain, const SweptDisc& disc, double margin_m,
                  std::vector<ContactPoint>& contacts) {
  const Vector3d lowest = LowestPoint(disc);
  if (lowest.z() < margin_m && terrain.IsOnTable(lowest.x(), lowest.y())) {
    contacts.push_back({lowest, Vector3d::UnitZ(), -lowest.z()});
  }
  const SurfaceOptions& surface = terrain.Surface();
  if (lowest.z() > surface.bump_height_m + margin_m) return;
  const double half_m = 0.5 * surface.bump_size_m, pitch_m = surface.bump_pitch_m;
  const double reach_m = half_m + disc.radius_m + disc.sweep_m + margin_m;
  const auto first = [&](double p_m) { return std::ceil((p_m - reach_m) / pitch_m); };
  const auto last = [&](double p_m) { return std::floor((p_m + reach_m) / pitch_m); };
  for (double i = first(disc.centre.x()); i <= last(disc.centre.x()); ++i) {
    for (double j = first(disc.centre.y()); j <= last(disc.centre.y()); ++j) {
      const Vector3d low(i * pitch_m - half_m, j * pitch_m - half_m, 0.0);
      if (!terrain.IsOnTable(low.x() + half_m, low.y() + half_m)) continue;
      const Vector3d size(surface.bump_size_m, surface.bump_size_m, surface.bump_height_m);
      const ContactPoint contact = BlockContact(disc, {low, low + size});
      if (contact.depth_m > -margin_m) contacts.push_back(contact);
    }
  }
}

}  // namespace rift::simulation
