#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace rift::simulation {

/// The robot as rigid bodies. Its frame: x forward, y left, z up, origin in the middle of the axle.
struct BodyOptions {
  double chassis_mass_kg = 0.158;
  double chassis_radius_m = 0.0484;
  double chassis_height_m = 0.0266;
  double com_ahead_m = -0.008;
  double com_above_m = 0.0;
  double wheel_mass_kg = 0.0032;
  double wheel_radius_m = 0.016;
  double right_over_left = 1.0;
  double wheel_width_m = 0.0068;
  double track_m = 0.083;
  double caster_ahead_m = -0.0404;
  double caster_below_m = 0.0096;
  double caster_radius_m = 0.00635;
  double caster_mu = 0.0;
  double rim_clearance_m = 0.005;
  double rim_mu = 0.3;
  double contact_stiffness_n_per_m = 25000.0;
  double contact_damping_ns_per_m = 90.0;
  double gravity_mps2 = 9.81;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("chassis_mass_kg", self.chassis_mass_kg, 0.01, 10.0,
          "everything but the wheels, in kg (authors' world)");
    field("chassis_radius_m", self.chassis_radius_m, 0.01, 0.5,
          "cylinder that gives the inertia and the rim, in m (authors' world)");
    field("chassis_height_m", self.chassis_height_m, 0.001, 0.5,
          "height of that cylinder in m (authors' world)");
    field("com_ahead_m", self.com_ahead_m, -0.2, 0.2,
          "centre of mass ahead of the axle in m (estimate: a fifth of the weight on the caster)");
    field("com_above_m", self.com_above_m, -0.05, 0.2,
          "centre of mass above the axle in m (authors' world: at its height)");
    field("wheel_mass_kg", self.wheel_mass_kg, 1e-4, 1.0, "one wheel in kg (Pololu 32x7 mm wheel)");
    field("wheel_radius_m", self.wheel_radius_m, 0.002, 0.2,
          "in m (authors' world; Pololu: 32 mm)");
    field("right_over_left", self.right_over_left, 0.9, 1.1,
          "radius of the right wheel over that of the left one, wheel_radius_m being their mean");
    field("wheel_width_m", self.wheel_width_m, 0.0005, 0.1, "in m (Pololu wheel)");
    field("track_m", self.track_m, 0.01, 1.0,
          "between the wheel centres in m (authors' world: 0.083; others: 0.0845 to 0.085)");
    field("caster_ahead_m", self.caster_ahead_m, -0.5, 0.5,
          "caster ball ahead of the axle in m (authors' world: 0.0404 from it)");
    field("caster_below_m", self.caster_below_m, 0.0, 0.2,
          "centre of the ball below the axle in m (authors' world)");
    field("caster_radius_m", self.caster_radius_m, 0.0005, 0.2, "in m (authors' world)");
    field("caster_mu", self.caster_mu, 0.0, 5.0, "friction of the ball on the ground, no unit");
    field("rim_clearance_m", self.rim_clearance_m, 0.0, 0.1,
          "lower edge of the chassis above the ground in m (the robot crosses blocks of 4 mm)");
    field("rim_mu", self.rim_mu, 0.0, 5.0, "friction of that edge on the ground (plastic)");
    field("contact_stiffness_n_per_m", self.contact_stiffness_n_per_m, 100.0, 1e7,
          "of each contact in N/m (the robot sinks in by 0.02 mm)");
    field("contact_damping_ns_per_m", self.contact_damping_ns_per_m, 0.1, 1e5,
          "of each contact in N s/m (critical)");
    field("gravity_mps2", self.gravity_mps2, 0.1, 30.0, "in m/s^2");
  }
  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;

  double Weight_n() const { return gravity_mps2 * (chassis_mass_kg + 2.0 * wheel_mass_kg); }
  /// On one wheel, and on the caster, at rest on level ground.
  double WeightOnWheel_n() const;
  double WeightOnCaster_n() const { return Weight_n() - 2.0 * WeightOnWheel_n(); }
  /// `side`: 0 left, 1 right.
  double WheelRadius_m(int side) const;
};

/// How the robot stands on a plane at rest, its wheels locked.
struct Stance {
  double height_m = 0.0;   ///< of the axle above the plane
  double pitch_rad = 0.0;  ///< against the plane, nose down
};

/// Pitch and height at which the loads on wheels and caster balance gravity, so that a robot put
/// down there stays at rest. `gravity_in_plane`: x along the robot, z off the plane, in m/s^2. The
/// caster carries nothing where it would have to pull.
Stance StanceOn(const BodyOptions& body, const Eigen::Vector3d& gravity_in_plane);

/// Of a robot that does not stand level within 0.5 degrees: its angle and the caster's height that
/// would make it level, or where its centre of mass must be lest it tips off its caster.
std::optional<std::string> TiltWarning(const BodyOptions& body);

}  // namespace rift::simulation
