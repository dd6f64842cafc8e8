#include "contacts.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "block_contacts.hpp"

namespace rift::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSegments = 24;
constexpr int kBisections = 12;  // finds the edge of a block to a micrometre
constexpr int kRimPoints = 8;

std::optional<ContactPoint> IfDeep(const Vector3d& point, const Vector3d& normal, double depth_m) {
  if (depth_m <= 0.0) return std::nullopt;
  return ContactPoint{point, normal, depth_m};
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

std::optional<ContactPoint> DiscContactPoint(const Terrain& terrain, const Vector3d& centre,
                                             const Vector3d& along, double radius_m,
                                             double half_width_m) {
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

constexpr double kRimRoundness_m = 0.0005;
constexpr double kStanding_mps = 1e-9;

constexpr double kTippedOver_rad = 1.05;
constexpr double kThroughFloor_m = 0.012;
constexpr double kFallen_m = 0.5;

std::string At(const char* what, const Vector3d& place_m) {
  return fmt::format("{} at ({:.3f}, {:.3f}) m", what, place_m.x(), place_m.y());
}

/// The unit vector in the ground nearest to `axis`.
Vector3d Across(const Vector3d& normal, const Vector3d& axis) {
  const Vector3d across = axis - axis.dot(normal) * normal;
  const double length = across.norm();
  return length > 1e-6 ? Vector3d(across / length) : Vector3d(normal.unitOrthogonal());
}

/// Coulomb friction of a body that slides on the ground. Along the motion it is mu times the load.
/// Across it, mu load v / |v| turns with the motion, hence grows by mu load / |v| for each m/s of
/// speed across: to a first order the limit is reached at a creep of |v|.
GroundContact Sliding(const ContactPoint& at, double mu, const WorldState& state, double load_n) {
  const Vector3d v = state.velocity_mps + state.spin_rad_s.cross(at.point - state.position_m);
  const Vector3d in_ground = v - v.dot(at.normal) * at.normal;
  const double speed_mps = in_ground.norm();
  const Vector3d direction = speed_mps > kStanding_mps
                                 ? Vector3d(in_ground / speed_mps)
                                 : Across(at.normal, state.world_from_robot.col(0));
  return {at, mu, direction, 0.0, speed_mps, load_n};
}

/// Calls `add` with each contact of the edge with the blocks around it. False without blocks: the
/// ground is then known by its height alone.
template <typename Add>
bool AddContactsWithBlocks(const ContactScene& scene, const RoundEdge& edge, const Add& add) {
  const double reach_m = edge.radius_m + edge.roundness_m + scene.margin_m;
  const auto blocks = scene.terrain.BlocksNear(edge.centre.x(), edge.centre.y(), reach_m);
  if (!blocks) return false;
  for (const ContactPoint& at : ContactsWithBlocks(*blocks, edge, scene.margin_m)) add(at);
  return true;
}

bool IsFinite(const WorldState& state) {
  return state.position_m.allFinite() && state.velocity_mps.allFinite() &&
         state.world_from_robot.allFinite() &&
         std::isfinite(state.wheel_rate_rad_s[0] + state.wheel_rate_rad_s[1]);
}

}  // namespace

std::optional<ContactPoint> WheelContactPoint(const Terrain& terrain, const Vector3d& centre,
                                              const Vector3d& axle, double radius_m,
                                              double width_m) {
  if (const auto plane = terrain.PlaneNear(centre.x(), centre.y(), radius_m)) {
    const Vector3d point = centre + radius_m * Lowest(axle, plane->normal);
    return IfDeep(point, plane->normal, plane->normal.dot(plane->point - point));
  }
  const Vector3d along = axle.cross(Vector3d::UnitZ()).stableNormalized();
  return DiscContactPoint(terrain, centre, along, radius_m, 0.5 * width_m);
}

std::optional<ContactPoint> BallContactPoint(const Terrain& terrain, const Vector3d& centre,
                                             const Vector3d& forward, double radius_m) {
  if (const auto plane = terrain.PlaneNear(centre.x(), centre.y(), radius_m)) {
    const Vector3d point = centre - radius_m * plane->normal;
    return IfDeep(point, plane->normal, plane->normal.dot(plane->point - point));
  }
  const Vector3d along = Vector3d(forward.x(), forward.y(), 0.0).stableNormalized();
  const Vector3d aside(-along.y(), along.x(), 0.0);
  const auto lengthwise = DiscContactPoint(terrain, centre, along, radius_m, 0.0);
  const auto crosswise = DiscContactPoint(terrain, centre, aside, radius_m, 0.0);
  if (!lengthwise || !crosswise) return lengthwise ? lengthwise : crosswise;
  return lengthwise->depth_m > crosswise->depth_m ? lengthwise : crosswise;
}

std::optional<ContactPoint> RimContactPoint(const Terrain& terrain, const Vector3d& centre,
                                            const Vector3d& forward, const Vector3d& up,
                                            double radius_m) {
  if (const auto plane = terrain.PlaneNear(centre.x(), centre.y(), radius_m)) {
    const Vector3d point = centre + radius_m * Lowest(up, plane->normal);
    return IfDeep(point, plane->normal, plane->normal.dot(plane->point - point));
  }
  std::optional<ContactPoint> deepest;
  const Vector3d left = up.cross(forward);
  for (int i = 0; i < kRimPoints; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kRimPoints;
    const Vector3d point =
        centre + radius_m * (std::cos(angle_rad) * forward + std::sin(angle_rad) * left);
    const double depth_m = terrain.HeightAt(point.x(), point.y()) - point.z();
    if (depth_m <= (deepest ? deepest->depth_m : 0.0)) continue;
    const Vector3d normal =
        terrain.IsStepped() ? Vector3d(Vector3d::UnitZ()) : terrain.NormalAt(point.x(), point.y());
    deepest = ContactPoint{point, normal, depth_m};
  }
  return deepest;
}

void AddWheelContacts(const ContactScene& scene, int side, const Vector3d& centre,
                      std::vector<GroundContact>& contacts) {
  const BodyOptions& body = scene.body;
  const Vector3d axle = scene.state.world_from_robot.col(1);
  const double radius_m = body.WheelRadius_m(side);
  const double rolling_mps = scene.state.wheel_rate_rad_s[side] * radius_m;
  const double rim_mps = std::abs(rolling_mps), uneven_mps = scene.uneven[side] * rolling_mps;
  const auto add = [&](const ContactPoint& at) {
    const Grip grip = scene.terrain.GripAt(at.point.x(), at.point.y());
    const double creep_mps = grip.slip * rim_mps;
    contacts.push_back({at, grip.mu, Across(at.normal, axle), creep_mps, creep_mps,
                        body.WeightOnWheel_n(), uneven_mps});
  };
  const double roundness_m = 0.5 * std::min(body.wheel_width_m, radius_m);
  const RoundEdge tyre{centre, axle, radius_m - roundness_m, roundness_m};
  if (AddContactsWithBlocks(scene, tyre, add)) return;
  const auto contact = WheelContactPoint(scene.terrain, centre, axle, radius_m, body.wheel_width_m);
  if (contact) add(*contact);
}

void AddCasterContacts(const ContactScene& scene, std::vector<GroundContact>& contacts) {
  const BodyOptions& body = scene.body;
  const WorldState& state = scene.state;
  const Vector3d caster =
      state.position_m +
      state.world_from_robot * Vector3d(body.caster_ahead_m, 0.0, -body.caster_below_m);
  const auto add = [&](const ContactPoint& at) {
    const Grip grip = scene.terrain.GripAt(at.point.x(), at.point.y());
    contacts.push_back(
        Sliding(at, grip.caster_factor * body.caster_mu, state, body.WeightOnCaster_n()));
  };
  const RoundEdge ball{caster, Vector3d::UnitY(), 0.0, body.caster_radius_m};
  if (AddContactsWithBlocks(scene, ball, add)) return;
  const auto contact =
      BallContactPoint(scene.terrain, caster, state.world_from_robot.col(0), body.caster_radius_m);
  if (contact) add(*contact);
}

void AddRimContacts(const ContactScene& scene, std::vector<GroundContact>& contacts) {
  const BodyOptions& body = scene.body;
  const WorldState& state = scene.state;
  const Vector3d up = state.world_from_robot.col(2);
  const Vector3d rim = state.position_m - (body.wheel_radius_m - body.rim_clearance_m) * up;
  const auto add = [&](const ContactPoint& at) {
    contacts.push_back(Sliding(at, body.rim_mu, state, body.Weight_n()));
  };
  const RoundEdge edge{rim + kRimRoundness_m * up, up, body.chassis_radius_m - kRimRoundness_m,
                       kRimRoundness_m};
  if (AddContactsWithBlocks(scene, edge, add)) return;
  const Vector3d forward = state.world_from_robot.col(0);
  const auto contact = RimContactPoint(scene.terrain, rim, forward, up, body.chassis_radius_m);
  if (contact) add(*contact);
}

std::optional<std::string> FaultOf(const WorldState& state, const Terrain& terrain) {
  if (!IsFinite(state)) return "the simulated motion is no longer finite";
  const Vector3d& p = state.position_m;
  const double ground_m = terrain.HeightAt(p.x(), p.y());
  if (!std::isfinite(ground_m) || p.z() >= ground_m - kThroughFloor_m) return std::nullopt;
  return At("sank through the floor", p);
}

std::optional<std::string> FallOf(const WorldState& state, const Terrain& terrain) {
  const Vector3d& p = state.position_m;
  if (p.z() < -kFallen_m && !std::isfinite(terrain.HeightAt(p.x(), p.y()))) {
    return At("fell off the table", p);
  }
  if (state.world_from_robot(2, 2) < std::cos(kTippedOver_rad)) return At("tipped over", p);
  return std::nullopt;
}

}  // namespace rift::simulation
