#include "rift/simulation/body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "rift/geometry/pose2.hpp"

namespace rift::simulation {

void BodyOptions::Check() const {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument(what); };
  if (rim_clearance_m >= wheel_radius_m) {
    refuse(
        fmt::format("rim_clearance_m is {}, but the rim must lie below the axle, wheel_radius_m {}",
                    rim_clearance_m, wheel_radius_m));
  }
  if (std::abs(caster_ahead_m) < 0.005) {
    refuse(
        fmt::format("caster_ahead_m is {}, but the caster must be at least 0.005 m from the axle",
                    caster_ahead_m));
  }
  const double sunk_m = WeightOnWheel_n() / contact_stiffness_n_per_m;
  if (sunk_m > 0.1 * wheel_radius_m) {
    refuse(
        fmt::format("contact_stiffness_n_per_m is {}, so that a wheel sinks in by {} m, but it "
                    "must be at most a tenth of its radius",
                    contact_stiffness_n_per_m, sunk_m));
  }
  const double caster_gap_m = wheel_radius_m - caster_below_m - caster_radius_m;
  if (std::abs(caster_gap_m) > 0.3 * std::abs(caster_ahead_m)) {
    refuse(
        fmt::format("caster_below_m {} and caster_radius_m {} put the ball {} m off the ground, "
                    "but it must reach it within 0.3 of caster_ahead_m",
                    caster_below_m, caster_radius_m, caster_gap_m));
  }
}

double BodyOptions::WheelRadius_m(int side) const {
  const double left_m = 2.0 / (1.0 + right_over_left) * wheel_radius_m;
  return side == 0 ? left_m : right_over_left * left_m;
}

double BodyOptions::WeightOnWheel_n() const {
  const double on_caster = std::clamp(com_ahead_m / caster_ahead_m, 0.0, 1.0);
  return 0.5 * gravity_mps2 * (chassis_mass_kg * (1.0 - on_caster) + 2.0 * wheel_mass_kg);
}

Stance StanceOn(const BodyOptions& body, const Eigen::Vector3d& gravity_in_plane) {
  const double total_kg = body.chassis_mass_kg + 2.0 * body.wheel_mass_kg;
  const double moment =
      (body.com_above_m + body.wheel_radius_m) * body.chassis_mass_kg * gravity_in_plane.x() +
      2.0 * body.wheel_radius_m * body.wheel_mass_kg * gravity_in_plane.x() -
      body.com_ahead_m * body.chassis_mass_kg * gravity_in_plane.z();
  const double caster_n = std::max(0.0, moment / body.caster_ahead_m);
  const double wheel_n = -0.5 * (total_kg * gravity_in_plane.z() + caster_n);
  const double height_m = body.wheel_radius_m - wheel_n / body.contact_stiffness_n_per_m;
  const double caster_height_m = body.caster_radius_m - caster_n / body.contact_stiffness_n_per_m;
  double pitch_rad = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double drop_m = height_m - body.caster_below_m * std::cos(pitch_rad) - caster_height_m;
    pitch_rad = std::asin(std::clamp(drop_m / body.caster_ahead_m, -0.5, 0.5));
  }
  return {height_m, pitch_rad};
}

namespace {

/// Of a robot that gravity turns off its caster, or over it.
std::optional<std::string> TippingWarning(const BodyOptions& body) {
  const double share = body.com_ahead_m / body.caster_ahead_m;
  if (share >= 0.0 && share <= 1.0) return std::nullopt;
  return fmt::format(
      "the simulated robot does not stand on its wheels and its caster but tips {}: its centre of "
      "mass is {:g} m ahead of the axle (simulation.body.com_ahead_m) and its caster {:g} m "
      "(caster_ahead_m, negative: behind); a robot that stands has the first between 0 and the "
      "second",
      share < 0.0 ? "off its caster, onto the edge of its body" : "over its caster",
      body.com_ahead_m, body.caster_ahead_m);
}

/// Of a robot that is tilted because its contacts give way unevenly under its weight.
std::string SinkingWarning(const BodyOptions& body, double pitch_deg) {
  return fmt::format(
      "the simulated robot stands tilted by {:.1f} deg, nose {}: its wheels sink into the floor by "
      "{:.4f} m and its caster by {:.4f} m under its weight of {:.4g} N; "
      "simulation.body.contact_stiffness_n_per_m is {:g}: raise it, or check the masses",
      std::abs(pitch_deg), pitch_deg > 0.0 ? "down" : "up",
      body.WeightOnWheel_n() / body.contact_stiffness_n_per_m,
      body.WeightOnCaster_n() / body.contact_stiffness_n_per_m, body.Weight_n(),
      body.contact_stiffness_n_per_m);
}

}  // namespace

std::optional<std::string> TiltWarning(const BodyOptions& body) {
  if (auto warning = TippingWarning(body)) return warning;
  constexpr double kLevel_deg = 0.5;  // a caster ball 0.3 mm off on the 3pi+
  const double pitch_rad = StanceOn(body, Eigen::Vector3d(0.0, 0.0, -body.gravity_mps2)).pitch_rad;
  const double pitch_deg = geometry::DegFromRad(pitch_rad);
  if (std::abs(pitch_deg) <= kLevel_deg) return std::nullopt;
  const double caster_gap_m = body.wheel_radius_m - body.caster_radius_m - body.caster_below_m;
  const double drop_m = body.caster_ahead_m * std::sin(pitch_rad);
  // What is more to that side: the ball off the floor, or the sinking that is the rest.
  const double side = std::copysign(1.0, drop_m);
  if (side * (drop_m - caster_gap_m) > side * caster_gap_m) return SinkingWarning(body, pitch_deg);
  return fmt::format(
      "the simulated robot stands tilted by {:.1f} deg, nose {}: its caster's ball is {:.4f} m {} "
      "the floor when the robot is level; simulation.body.caster_below_m is {:g}, and {:.4g} "
      "(wheel_radius_m - caster_radius_m) would make it level",
      std::abs(pitch_deg), pitch_deg > 0.0 ? "down" : "up", std::abs(caster_gap_m),
      caster_gap_m > 0.0 ? "above" : "below", body.caster_below_m,
      body.wheel_radius_m - body.caster_radius_m);
}

}  // namespace rift::simulation
