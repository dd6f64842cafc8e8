#include "contacts.hpp"

#include <cmath>

namespace rift::simulation {
namespace {

using Eigen::Vector3d;

/// Both wheels hold the same sideways freedom; this much give keeps the two solvable, and lets the
/// robot creep by less than a micrometre a second on a slope.
constexpr double kLeastSlip_mps_per_n = 1e-6;

}  // namespace

std::optional<GroundContact> WheelContact(const BodyOptions& body, const Terrain& terrain,
                                          const WorldState& state, int side, const Vector3d& centre,
                                          double wheel_load_n) {
  const Vector3d axle = state.world_from_robot.col(1);
  const auto touch = TouchWheel(terrain, centre, axle, body.wheel_radius_m, body.wheel_width_m);
  if (!touch) return std::nullopt;
  const Grip grip = terrain.GripAt(touch->point.x(), touch->point.y());
  const Vector3d sideways = (axle - axle.dot(touch->normal) * touch->normal).normalized();
  const double rim_mps = std::abs(state.wheel_rate_rad_s[side]) * body.wheel_radius_m;
  const double creep =
      grip.slip > 0.0 && grip.mu > 0.0 ? grip.slip * rim_mps / (grip.mu * wheel_load_n) : 0.0;
  return GroundContact{*touch, grip.mu, sideways, kLeastSlip_mps_per_n + creep};
}

std::optional<GroundContact> CasterContact(const BodyOptions& body, const Terrain& terrain,
                                           const WorldState& state) {
  const Vector3d caster =
      state.position_m +
      state.world_from_robot * Vector3d(body.caster_ahead_m, 0.0, -body.caster_below_m);
  const auto touch =
      TouchBall(terrain, caster, state.world_from_robot.col(0), body.caster_radius_m);
  if (!touch) return std::nullopt;
  const Grip grip = terrain.GripAt(touch->point.x(), touch->point.y());
  return GroundContact{*touch, grip.caster_factor * body.caster_mu};
}

std::optional<GroundContact> RimContact(const BodyOptions& body, const Terrain& terrain,
                                        const WorldState& state) {
  const Vector3d up = state.world_from_robot.col(2);
  const Vector3d rim = state.position_m - (body.wheel_radius_m - body.rim_clearance_m) * up;
  const auto touch = TouchRim(terrain, rim, up, body.chassis_radius_m);
  if (!touch) return std::nullopt;
  return GroundContact{*touch, body.rim_mu};
}

}  // namespace rift::simulation
