// The world of ODE against closed forms: energy, inertia, creep, starts on slopes, other grounds.
#include "rift/simulation/ode_world.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "simulation/heightfield_options.hpp"

namespace rift::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kGravity = 9.81;

WheelDrive Servo(double rate_rad_s) { return {rate_rad_s, 0.0, 10.0}; }
constexpr WheelDrive kFree{};

void Run(OdeWorld& world, int steps, const std::array<WheelDrive, 2>& drives) {
  for (int i = 0; i < steps; ++i) world.Step(drives);
}

/// The ground of the default surface with another shape and grip.
TerrainOptions Ground(const SurfaceOptions& surface) {
  TerrainOptions options;
  options.surfaces["ground"] = surface;
  return options;
}

SurfaceOptions Ramp(Shape shape, double angle_rad, double mu) {
  SurfaceOptions ramp;
  ramp.shape = shape;
  ramp.ramp_rad = angle_rad;
  ramp.ramp_top_m = 2.0;
  ramp.mu = mu;
  return ramp;
}

double Yaw(const WorldState& state) {
  return std::atan2(state.world_from_robot(1, 0), state.world_from_robot(0, 0));
}

/// Three masses that differ, and a level stance.
BodyOptions Heavy() {
  BodyOptions body;
  body.chassis_mass_kg = 0.2;
  body.wheel_mass_kg = 0.02;
  body.wheel_width_m = 0.01;
  body.com_ahead_m = -0.015;
  body.com_above_m = 0.004;
  body.caster_below_m = body.wheel_radius_m - body.caster_radius_m;
  return body;
}

TEST_CASE("At rest all energy is that of height, of the chassis and of both wheels") {
  const BodyOptions body = Heavy();
  for (const double height_m : {0.0, 0.24}) {
    SurfaceOptions plateau = Ramp(Shape::kRampDown, 0.255, 0.8);
    plateau.ramp_top_m = height_m;
    const OdeWorld world(body, Terrain(Ground(plateau)), {-1.0, 0.2, 0.4}, 0.004);
    const double axle_m = height_m + 0.016;
    CHECK(world.Energy_j() ==
          Approx(kGravity * (0.2 * (axle_m + 0.004) + 2.0 * 0.02 * axle_m)).epsilon(0.005));
  }
}

TEST_CASE("A launched robot has the energy of its way and of its turning wheels") {
  const BodyOptions body = Heavy();
  OdeWorld world(body, Terrain(TerrainOptions{}), {0.0, 0.0, 0.7}, 0.004);
  const double rest_j = world.Energy_j();
  world.Launch(0.5);
  // A wheel is a cylinder: rolling, it weighs 1.5 of its mass.
  CHECK(world.Energy_j() - rest_j == Approx(0.5 * (0.2 + 3.0 * 0.02) * 0.25));
  CHECK(world.State().velocity_mps.x() == Approx(0.5 * std::cos(0.7)));
  CHECK(world.State().velocity_mps.y() == Approx(0.5 * std::sin(0.7)));
  CHECK(world.State().spin_rad_s.norm() == 0.0);
  world.Launch(-0.5);
  CHECK(world.State().velocity_mps.x() == Approx(-0.5 * std::cos(0.7)));
  CHECK(world.State().wheel_rate_rad_s[0] == Approx(-0.5 / 0.016));
  CHECK(world.State().wheel_rate_rad_s[1] == Approx(-0.5 / 0.016));
}

TEST_CASE("A robot that turns on the spot has the energy of its inertia, and its axle stands") {
  const BodyOptions body = Heavy();
  const double half_m = 0.5 * body.track_m, r = body.wheel_radius_m, w = body.wheel_width_m;
  const double upright = 0.5 * body.chassis_radius_m * body.chassis_radius_m;
  const double across = (3.0 * r * r + w * w) / 12.0;
  // The chassis about the axle's middle; each wheel about it, about itself, and as it rolls.
  const double inertia_kg_m2 =
      0.2 * (upright + 0.015 * 0.015) +
      2.0 * 0.02 * (half_m * half_m + across + 0.5 * r * r * std::pow(half_m / r, 2));
  for (const double side : {1.0, -1.0}) {
    OdeWorld world(body, Terrain(Ground({})), {}, 0.002);
    const double rest_j = world.Energy_j();
    for (int i = 1; i <= 100; ++i) {
      const double rate_rad_s = side * 0.1 * i;
      world.Step({Servo(-rate_rad_s), Servo(rate_rad_s)});
    }
    Run(world, 50, {Servo(-side * 10.0), Servo(side * 10.0)});
    const double spin_rad_s = side * 10.0 * r / half_m;
    CHECK(world.State().spin_rad_s.z() == Approx(spin_rad_s).epsilon(0.002));
    CHECK(world.Energy_j() - rest_j ==
          Approx(0.5 * inertia_kg_m2 * spin_rad_s * spin_rad_s).epsilon(0.01));
    CHECK(world.State().velocity_mps.norm() < 2e-3);  // 0.058 m/s is the centre of mass
  }
}

TEST_CASE("On a curve the axle moves along its heading, as fast as its place changes") {
  for (const double ahead_m : {-0.03, 0.03}) {
    BodyOptions body;
    body.com_ahead_m = 0.5 * ahead_m;
    body.caster_ahead_m = ahead_m;
    OdeWorld world(body, Terrain(Ground({})), {0.2, 0.1, -2.0}, 0.002);
    for (int i = 1; i <= 200; ++i) world.Step({Servo(0.05 * i), Servo(0.1 * i)});
    Run(world, 50, {Servo(10.0), Servo(20.0)});
    const Vector3d before = world.State().position_m, v_before = world.State().velocity_mps;
    world.Step({Servo(10.0), Servo(20.0)});
    const WorldState& state = world.State();
    const Vector3d moved_mps = (state.position_m - before) / 0.002;
    CHECK((moved_mps - 0.5 * (v_before + state.velocity_mps)).norm() < 2e-3);
    CHECK(state.velocity_mps.dot(state.world_from_robot.col(0)) ==
          Approx(15.0 * body.wheel_radius_m).epsilon(0.005));
    CHECK(std::abs(state.velocity_mps.dot(state.world_from_robot.col(1))) < 2e-3);
    CHECK(state.spin_rad_s.z() == Approx(10.0 * body.wheel_radius_m / body.track_m).epsilon(0.01));
  }
}

TEST_CASE("A robot that tips does so by the inertia of its cylinder about a line across") {
  for (const double side : {1.0, -1.0}) {  // over its nose, over its tail
    BodyOptions body;
    body.chassis_mass_kg = 0.3;
    body.chassis_height_m = 0.2;
    body.wheel_mass_kg = 1e-4;
    body.com_ahead_m = side * 0.02;
    body.caster_ahead_m = -side * 0.04;
    body.caster_below_m = body.wheel_radius_m - body.caster_radius_m;
    OdeWorld world(body, Terrain(Ground({.mu = 0.0})), {}, 0.0005);
    Run(world, 60, {kFree, kFree});
    const double radius_m = body.chassis_radius_m;
    const double inertia = (3.0 * radius_m * radius_m + 0.2 * 0.2) / 12.0;  // of each kg
    const double expected_rad_s = side * 0.03 * kGravity * 0.02 / (inertia + 0.02 * 0.02);
    CHECK(world.State().spin_rad_s.y() == Approx(expected_rad_s).epsilon(0.03));
  }
}

TEST_CASE("Held on a slope a robot creeps by a millionth of a metre a second for each newton") {
  const BodyOptions body;
  const double angle_rad = 0.3;
  const double pull_n =
      (body.chassis_mass_kg + 2.0 * body.wheel_mass_kg) * kGravity * std::sin(angle_rad);
  const Shape shape = GENERATE(Shape::kRampDown, Shape::kRampUp);
  const double yaw_rad = GENERATE(0.0, M_PI / 2.0);  // along and across
  const double down = shape == Shape::kRampDown ? 1.0 : -1.0;
  OdeWorld world(body, Terrain(Ground(Ramp(shape, angle_rad, 0.9))), {down, 0.0, yaw_rad}, 0.004);
  Run(world, 100, {Servo(0.0), Servo(0.0)});
  const Vector3d before = world.State().position_m;
  Run(world, 250, {Servo(0.0), Servo(0.0)});
  const Vector3d crept_m = world.State().position_m - before;
  // Half of the pull on each wheel.
  CHECK(crept_m.x() == Approx(down * 0.5e-6 * pull_n * std::cos(angle_rad)).epsilon(0.1));
  CHECK(std::abs(crept_m.y()) < 1e-8);
}

TEST_CASE("A robot on a ramp starts over the place and in the heading that are asked for") {
  for (const Shape shape : {Shape::kRampDown, Shape::kRampUp}) {
    const double down = shape == Shape::kRampDown ? 1.0 : -1.0;
    const Terrain terrain(Ground(Ramp(shape, 0.35, 0.9)));
    for (const double yaw_rad : {0.0, 0.8, M_PI / 2.0, 2.2, -0.8, -M_PI / 2.0, -2.2}) {
      const OdeWorld world(BodyOptions{}, terrain, {down * 1.1, -0.3, yaw_rad}, 0.004);
      const WorldState& state = world.State();
      INFO(down << " " << yaw_rad);
      CHECK(state.position_m.x() == Approx(down * 1.1));
      CHECK(state.position_m.y() == Approx(-0.3));
      CHECK(std::abs(Yaw(state) - yaw_rad) < 2e-3);
      // Its own upward axis is the plane's normal, but for what caster and wheels sink in.
      const Vector3d normal(down * std::sin(0.35), 0.0, std::cos(0.35));
      CHECK(state.world_from_robot.col(2).dot(normal) > 0.99999);
      CHECK(state.position_m.z() - terrain.HeightAt(down * 1.1, -0.3) ==
            Approx(0.016 / std::cos(0.35)).margin(5e-5));
      CHECK(state.velocity_mps.norm() == 0.0);
    }
  }
}

TEST_CASE("A start beyond the edge of a table is refused with its place, on every side") {
  TerrainOptions options;
  options.table_half_size_m = 0.3;
  const Terrain terrain(options);
  const auto refusal = [&](double x_m, double y_m) -> std::string {
    try {
      OdeWorld(BodyOptions{}, terrain, {x_m, y_m, 0.5}, 0.004);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(refusal(0.31, -0.2) ==
        "the robot cannot start at (0.310, -0.200) m, beyond the edge of the table");
  CHECK(refusal(-0.301, 0.0) ==
        "the robot cannot start at (-0.301, 0.000) m, beyond the edge of the table");
  CHECK(refusal(0.1, 0.4) ==
        "the robot cannot start at (0.100, 0.400) m, beyond the edge of the table");
  CHECK(refusal(0.0, -0.3001) ==
        "the robot cannot start at (0.000, -0.300) m, beyond the edge of the table");
  CHECK(refusal(0.25, -0.25) == "accepted");
}

TEST_CASE("A robot falls off a table on each of its sides alike, and says where") {
  TerrainOptions options;
  options.table_half_size_m = 0.3;
  std::vector<double> steps;
  for (const double yaw_rad : {0.0, M_PI / 2.0, M_PI, -M_PI / 2.0}) {
    OdeWorld world(BodyOptions{}, Terrain(options), {0.0, 0.0, yaw_rad}, 0.004);
    int step = 0;
    for (; step < 1000 && !world.Fall(); ++step) world.Step({Servo(15.0), Servo(15.0)});
    REQUIRE(world.Fall());
    const Vector3d& p = world.State().position_m;
    const Vector2d ahead(std::cos(yaw_rad), std::sin(yaw_rad));
    INFO(*world.Fall());
    CHECK(world.Fall()->ends_with(fmt::format(" at ({:.3f}, {:.3f}) m", p.x(), p.y())));
    CHECK(p.head<2>().dot(ahead) > 0.3);
    CHECK(std::abs(p.x() * ahead.y() - p.y() * ahead.x()) < 0.05);
    steps.push_back(step);
  }
  for (const double step : steps) CHECK(step == Approx(steps[0]).margin(25.0));
}

TEST_CASE("A wheel drive of which any number is none stops the world, and on either side") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const double endless = std::numeric_limits<double>::infinity();
  const WheelDrive good{1.0, 0.5, endless, 0.001};
  const std::vector<WheelDrive> wrong{{none, 0.5, 1.0, 0.0},   {endless, 0.5, 1.0, 0.0},
                                      {1.0, none, 1.0, 0.0},   {1.0, endless, 1.0, 0.0},
                                      {1.0, 0.5, none, 0.0},   {1.0, 0.5, 1.0, none},
                                      {1.0, 0.5, 1.0, endless}};
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    for (const bool is_left : {true, false}) {
      INFO(i << " " << is_left);
      OdeWorld world(BodyOptions{}, Terrain(TerrainOptions{}), {}, 0.004);
      world.Step({good, good});
      CHECK_FALSE(world.Fault());
      const WorldState before = world.State();
      world.Step(is_left ? std::array{wrong[i], good} : std::array{good, wrong[i]});
      CHECK(world.Fault() == "a wheel drive is not a number");
      CHECK_FALSE(world.Fall());
      world.Step({good, good});
      CHECK(world.State().position_m == before.position_m);
      CHECK(world.State().wheel_angle_rad == before.wheel_angle_rad);
    }
  }
}

/// A picture of 2 x 2 m that climbs evenly in a direction: 0 to +x, 1 to -x, 2 to +y, 3 to -y.
Terrain Picture(int direction, double angle_rad, double mu) {
  TerrainOptions options = HeightfieldOptions(2.0, 2.0 * std::tan(angle_rad));
  options.surfaces["ground"].mu = mu;
  const std::vector<std::vector<double>> samples{
      {0, 1, 0, 1}, {1, 0, 1, 0}, {1, 1, 0, 0}, {0, 0, 1, 1}};
  return Terrain(options, std::make_shared<HeightImage>(
                              HeightImage{2, 2, samples[static_cast<std::size_t>(direction)]}));
}

TEST_CASE("What held a robot while it was put down on a picture holds it no longer") {
  const BodyOptions body;
  const double angle_rad = 0.2, time_s = 0.3;
  const double slid_m = 0.5 * kGravity * std::sin(angle_rad) * time_s * time_s;
  const std::vector<Vector2d> uphill{{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  for (int direction = 0; direction < 4; ++direction) {
    INFO(direction);
    for (const double mu : {0.0, 0.8}) {
      OdeWorld world(body, Picture(direction, angle_rad, mu), {0.05, -0.02, 0.3}, 0.002);
      const Vector3d start = world.State().position_m;
      CHECK(world.State().velocity_mps.norm() == 0.0);
      Run(world, 150, {Servo(0.0), Servo(0.0)});
      const Vector3d moved = world.State().position_m - start;
      const Vector2d& up = uphill[static_cast<std::size_t>(direction)];
      if (mu > 0.0) {
        CHECK(moved.norm() < 2e-4);
      } else {
        CHECK(moved.head<2>().dot(up) == Approx(-slid_m * std::cos(angle_rad)).epsilon(0.03));
        CHECK(moved.z() == Approx(-slid_m * std::sin(angle_rad)).epsilon(0.05));
      }
    }
  }
}

TEST_CASE("Locked wheels brake by mu on flat pictures and blocks without height as on the floor") {
  BodyOptions body;
  body.com_ahead_m = 0.0;
  body.com_above_m = -body.wheel_radius_m + 0.002;
  body.wheel_mass_kg = 1e-4;
  body.rim_mu = 0.0;
  for (const double mu : {0.15, 0.3}) {
    SurfaceOptions blocks;
    blocks.shape = Shape::kBumps;
    blocks.bump_height_m = 0.0;
    blocks.mu = mu;
    for (const Terrain& terrain : {Picture(0, 0.0, mu), Terrain(Ground(blocks))}) {
      OdeWorld world(body, terrain, {-0.1, 0.02, 0.4}, 0.001);
      const Vector3d start = world.State().position_m;
      world.Launch(0.3);
      Run(world, 400, {Servo(0.0), Servo(0.0)});
      const Vector2d moved = (world.State().position_m - start).head<2>();
      INFO(mu << " " << moved.transpose());
      CHECK(moved.norm() == Approx(0.09 / (2.0 * mu * kGravity)).epsilon(0.05));
      CHECK(std::atan2(moved.y(), moved.x()) == Approx(0.4).margin(0.02));
    }
  }
}

TEST_CASE("At equal rates a larger wheel turns the robot to the other side") {
  BodyOptions body;
  for (const double ratio : {1.04, 0.97}) {
    body.right_over_left = ratio;
    OdeWorld world(body, Terrain(Ground({.mu = 2.0})), {}, 0.002);
    for (int i = 1; i <= 100; ++i) world.Step({Servo(0.1 * i), Servo(0.1 * i)});
    Run(world, 400, {Servo(10.0), Servo(10.0)});
    const double left_m = 2.0 * 0.016 / (1.0 + ratio), right_m = ratio * left_m;
    const double rate_rad_s = 10.0 * (right_m - left_m) / body.track_m;
    CHECK(world.State().spin_rad_s.z() == Approx(rate_rad_s).epsilon(0.02));
    CHECK(Yaw(world.State()) == Approx(0.9 * rate_rad_s).epsilon(0.02));
    CHECK(world.State().velocity_mps.norm() == Approx(0.16).epsilon(0.005));
  }
}

TEST_CASE("Across a steep ramp a high robot tips downhill, whichever side it turns there") {
  BodyOptions body;
  body.com_above_m = 0.15;
  for (const Shape shape : {Shape::kRampDown, Shape::kRampUp}) {
    const double down = shape == Shape::kRampDown ? 1.0 : -1.0;
    for (const double yaw_rad : {M_PI / 2.0, -M_PI / 2.0}) {
      OdeWorld world(body, Terrain(Ground(Ramp(shape, 0.5, 2.0))), {down * 1.5, 0.0, yaw_rad},
                     0.002);
      Run(world, 1500, {Servo(0.0), Servo(0.0)});
      REQUIRE(world.Fall());
      CHECK(world.Fall()->starts_with("tipped over at ("));
      CHECK(down * world.State().world_from_robot(0, 2) > 0.8);
      CHECK(std::abs(world.State().world_from_robot(1, 2)) < 0.3);
    }
  }
}

TEST_CASE(
    "A robot put down with a wheel beyond the edge of a table is somewhere, without a fault") {
  TerrainOptions options;
  options.table_half_size_m = 0.3;
  const Terrain terrain(options);
  for (const double off_m : {0.27, 0.299}) {
    for (const double side : {1.0, -1.0}) {
      for (const bool is_along_x : {true, false}) {
        INFO(off_m << " " << side << " " << is_along_x);
        const geometry::Pose2 start = is_along_x ? geometry::Pose2{0.0, side * off_m, 0.0}
                                                 : geometry::Pose2{side * off_m, 0.0, M_PI / 2.0};
        OdeWorld world(BodyOptions{}, terrain, start, 0.004);
        CHECK_FALSE(world.Fault());
        CHECK(world.State().position_m.allFinite());
        CHECK((world.State().position_m.head<2>() - start.Position()).norm() < 0.1);
        Run(world, 50, {Servo(0.0), Servo(0.0)});
        CHECK_FALSE(world.Fault());
      }
    }
  }
}

}  // namespace
}  // namespace rift::simulation
