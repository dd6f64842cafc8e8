#include "rift/simulation/ode_world.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

namespace rift::simulation {
namespace {

constexpr double kFree = 0.0;
constexpr double kGravity = 9.81;
constexpr double kEndless = std::numeric_limits<double>::infinity();

Terrain Ground(double mu) {
  TerrainOptions options;
  options.surfaces["ground"] = SurfaceOptions{};
  options.surfaces["ground"].mu = mu;
  return Terrain(options);
}

Terrain Ramp(Shape shape, double angle_rad, double mu) {
  TerrainOptions options;
  SurfaceOptions& ramp = options.surfaces["ground"];
  ramp = SurfaceOptions{};
  ramp.shape = shape;
  ramp.ramp_rad = angle_rad;
  ramp.ramp_top_m = 2.0;
  ramp.mu = mu;
  return Terrain(options);
}

WheelDrive Servo(double rate_rad_s) { return {rate_rad_s, 0.0, 10.0}; }
WheelDrive Drag(double torque_nm) { return {0.0, 0.0, torque_nm}; }

/// Share of the kinetic energy that the turning wheels hold beyond the moving mass.
double EffectiveMass_kg(const BodyOptions& body) {
  return body.chassis_mass_kg + 3.0 * body.wheel_mass_kg;  // 2 m + 2 (m r^2 / 2) / r^2
}
double Mass_kg(const BodyOptions& body) { return body.chassis_mass_kg + 2.0 * body.wheel_mass_kg; }

void Run(OdeWorld& world, double duration_s, double step_s,
         const std::function<std::array<WheelDrive, 2>(double)>& drives) {
  const int steps = static_cast<int>(std::lround(duration_s / step_s));
  for (int i = 0; i < steps; ++i) world.Step(drives(i * step_s));
}
void Run(OdeWorld& world, double duration_s, double step_s, std::array<WheelDrive, 2> drives) {
  Run(world, duration_s, step_s, [drives](double) { return drives; });
}

double Yaw(const WorldState& state) {
  return std::atan2(state.world_from_robot(1, 0), state.world_from_robot(0, 0));
}

TEST_CASE("A robot put down on flat ground rests there to the micrometre") {
  const double step_s = GENERATE(0.001, 0.004, 0.016, 0.032);
  const BodyOptions body;
  OdeWorld world(body, Ground(0.8), {0.1, -0.2, 0.7}, step_s);
  const Eigen::Vector3d start = world.State().position_m;
  CHECK(start.x() == Approx(0.1));
  CHECK(start.y() == Approx(-0.2));
  CHECK(start.z() == Approx(body.wheel_radius_m).margin(5e-5));
  Run(world, 1.0, step_s, {Drag(1.0), Drag(1.0)});
  CHECK((world.State().position_m - start).norm() < 1e-6);
  CHECK(world.State().velocity_mps.norm() < 1e-6);
  CHECK(Yaw(world.State()) == Approx(0.7).margin(1e-6));
}

/// A picture of 2 x 2 m about the origin that climbs evenly towards +x.
Terrain Slope(double angle_rad) {
  TerrainOptions options;
  SurfaceOptions& slope = options.surfaces["ground"];
  slope = SurfaceOptions{};
  slope.shape = Shape::kHeightfield;
  slope.image = "slope.png";
  slope.image_width_m = 2.0;
  slope.image_height_m = 2.0 * std::tan(angle_rad);
  return Terrain(options, std::make_shared<HeightImage>(HeightImage{2, 2, {0.0, 1.0, 0.0, 1.0}}));
}

Terrain Bend() {
  TerrainOptions options;
  SurfaceOptions& board = options.surfaces["ground"];
  board = SurfaceOptions{};
  board.shape = Shape::kRampDown;
  board.ramp_edge_x_m = 0.0;
  board.ramp_bend_m = 0.3;
  return Terrain(options);
}

TEST_CASE("On ground that is no plane a robot starts where and as it is asked to") {
  const BodyOptions body;
  const double heading_rad = GENERATE(0.0, 1.2, 1.5708, -2.3, 3.0);
  for (const Terrain& terrain : {Slope(0.1), Slope(0.3), Slope(0.4), Bend()}) {
    const OdeWorld world(body, terrain, {0.03, -0.02, heading_rad}, 0.004);
    const Eigen::Vector3d at = world.State().position_m;
    INFO(heading_rad << " " << at.transpose());
    CHECK((at.head<2>() - Eigen::Vector2d(0.03, -0.02)).norm() < 1e-4);
    CHECK(std::abs(Yaw(world.State()) - heading_rad) < 1e-3);
    // The axle stands a radius off the ground, along the ground's normal.
    const Eigen::Vector3d foot(at.x(), at.y(), terrain.HeightAt(at.x(), at.y()));
    CHECK(terrain.NormalAt(at.x(), at.y()).dot(at - foot) ==
          Approx(body.wheel_radius_m).margin(6e-4));
  }
}

TEST_CASE("A coasting robot stops after v squared over twice its deceleration") {
  const BodyOptions body;
  const double speed_mps = 0.3, drag_nm = 2e-4, step_s = 0.001;
  OdeWorld world(body, Ground(0.8), {}, step_s);
  world.Launch(speed_mps);
  const double deceleration = 2.0 * drag_nm / body.wheel_radius_m / EffectiveMass_kg(body);
  Run(world, 4.0, step_s, {Drag(drag_nm), Drag(drag_nm)});
  CHECK(world.State().velocity_mps.norm() < 1e-5);
  CHECK(world.State().position_m.x() ==
        Approx(speed_mps * speed_mps / (2.0 * deceleration)).epsilon(0.003));
}

TEST_CASE("The caster brakes by its load times its friction times what the ground makes of it") {
  BodyOptions body;
  body.caster_mu = 0.02;
  const auto lost_mps = [&](double caster_factor) {
    TerrainOptions options;
    options.surfaces["ground"] = SurfaceOptions{};
    options.surfaces["ground"].caster_factor = caster_factor;
    OdeWorld world(body, Terrain(options), {}, 0.001);
    world.Launch(0.3);
    Run(world, 1.0, 0.001, {Drag(kFree), Drag(kFree)});
    return 0.3 - world.State().velocity_mps.norm();
  };
  const double load_n = body.chassis_mass_kg * kGravity * body.com_ahead_m / body.caster_ahead_m;
  CHECK(lost_mps(0.0) == Approx(0.0).margin(1e-6));
  CHECK(lost_mps(1.0) == Approx(body.caster_mu * load_n / EffectiveMass_kg(body)).epsilon(0.05));
  CHECK(lost_mps(3.0) == Approx(3.0 * lost_mps(1.0)).epsilon(0.05));
}

TEST_CASE("The caster brakes by what is under it and nowhere else") {
  BodyOptions body;
  body.caster_mu = 0.02;
  TerrainOptions options;
  options.surfaces["ground"] = SurfaceOptions{};
  options.surfaces["ground"].caster_factor = 3.0;
  const auto lost_mps = [&](std::vector<PatchOptions> patches) {
    options.patches = std::move(patches);
    OdeWorld world(body, Terrain(options), {0.0, 0.3, 0.0}, 0.001);
    world.Launch(0.3);
    Run(world, 0.5, 0.001, {Drag(kFree), Drag(kFree)});
    return 0.3 - world.State().velocity_mps.norm();
  };
  const double outside_mps = lost_mps({});
  const PatchOptions under{-0.2, 0.29, 0.2, 0.4, 0.8, 0.0, 0.0};  // what it rolls on has factor 1
  const PatchOptions beside{-0.2, 0.29, -0.4, -0.2, 0.8, 0.0, 0.0};
  CHECK(lost_mps({under}) == Approx(outside_mps / 3.0).epsilon(0.05));
  CHECK(lost_mps({beside}) == outside_mps);
}

TEST_CASE("A robot with locked wheels stops after v squared over twice mu times the wheel load") {
  BodyOptions body;
  body.com_ahead_m = 0.0;  // all weight on the wheels but what braking itself moves to the rim
  body.com_above_m = -body.wheel_radius_m + 0.002;
  body.wheel_mass_kg = 1e-4;
  body.rim_mu = 0.0;
  const double speed_mps = 0.3, mu = 0.2, step_s = 0.0005;
  OdeWorld world(body, Ground(mu), {}, step_s);
  world.Launch(speed_mps);
  Run(world, 0.5, step_s, {Servo(0.0), Servo(0.0)});
  CHECK(world.State().velocity_mps.norm() < 0.005);  // it still rocks on its wheels
  CHECK(world.State().position_m.x() ==
        Approx(speed_mps * speed_mps / (2.0 * mu * kGravity)).epsilon(0.03));
}

TEST_CASE("A free robot rolls down a ramp with the acceleration of its mass and its wheels") {
  const BodyOptions body;
  const double angle_rad = 0.2404, step_s = 0.001, time_s = 0.5;
  OdeWorld world(body, Ramp(Shape::kRampDown, angle_rad, 0.9), {1.0, 0.0, 0.0}, step_s);
  const Eigen::Vector3d start = world.State().position_m;
  Run(world, time_s, step_s, {Drag(kFree), Drag(kFree)});
  const double acceleration =
      kGravity * std::sin(angle_rad) * Mass_kg(body) / EffectiveMass_kg(body);
  CHECK(world.State().velocity_mps.norm() == Approx(acceleration * time_s).epsilon(0.002));
  CHECK((world.State().position_m - start).norm() ==
        Approx(0.5 * acceleration * time_s * time_s).epsilon(0.005));
}

TEST_CASE("Energy is conserved on a ramp without friction and all of it moves the mass") {
  const BodyOptions body;
  const double step_s = 0.001;
  OdeWorld world(body, Ramp(Shape::kRampDown, 0.2404, 0.0), {1.0, 0.0, 0.0}, step_s);
  const double start_z = world.State().position_m.z();
  Run(world, 0.5, step_s, {Drag(kFree), Drag(kFree)});
  const double dropped_m = start_z - world.State().position_m.z();
  CHECK(dropped_m > 0.05);
  CHECK(world.State().velocity_mps.squaredNorm() ==
        Approx(2.0 * kGravity * dropped_m).epsilon(0.005));
  CHECK(std::abs(world.State().wheel_rate_rad_s[0]) < 1e-6);
}

TEST_CASE("On flat ground without friction or drag momentum and spin never change") {
  OdeWorld world(BodyOptions{}, Ground(0.0), {}, 0.004);
  world.Launch(0.3);
  Run(world, 3.0, 0.004, {Drag(kFree), Drag(kFree)});
  CHECK(world.State().velocity_mps.x() == Approx(0.3).epsilon(1e-6));
  CHECK(world.State().position_m.x() == Approx(0.9).epsilon(1e-6));
  CHECK(world.State().wheel_rate_rad_s[1] == Approx(0.3 / 0.016).epsilon(1e-6));
}

TEST_CASE("Locked wheels hold on a slope up to tan of the angle equal to mu and slide beyond") {
  BodyOptions body;  // all weight on the wheels, so that mu acts on all of it
  body.com_ahead_m = -1e-6;
  body.com_above_m = -body.wheel_radius_m + 1e-6;
  body.wheel_mass_kg = 1e-4;
  body.rim_mu = 0.0;
  const double mu = 0.4, critical_rad = std::atan(mu);
  for (const double excess : {-0.02, 0.02}) {
    const double angle_rad = critical_rad + excess;
    OdeWorld world(body, Ramp(Shape::kRampDown, angle_rad, mu), {1.5, 0.0, 1.5707963}, 0.002);
    const Eigen::Vector3d start = world.State().position_m;
    Run(world, 0.5, 0.002, {Servo(0.0), Servo(0.0)});
    const double slid_m = (world.State().position_m - start).norm();
    if (excess < 0.0) {
      CHECK(slid_m < 1e-4);
    } else {
      const double acceleration = kGravity * (std::sin(angle_rad) - mu * std::cos(angle_rad));
      CHECK(slid_m == Approx(0.5 * acceleration * 0.25).epsilon(0.08));
    }
  }
}

TEST_CASE("A robot that brakes hard on slippery ground slides while its wheels already stand") {
  OdeWorld world(BodyOptions{}, Ground(0.1), {}, 0.002);
  world.Launch(0.4);
  Run(world, 0.05, 0.002, {Servo(0.0), Servo(0.0)});
  CHECK(std::abs(world.State().wheel_rate_rad_s[0]) < 0.1);
  CHECK(world.State().velocity_mps.x() > 0.3);
}

TEST_CASE("A driven wheel creeps by the share of its friction that it uses") {
  const BodyOptions body;
  TerrainOptions options;
  options.surface = "uphill";
  SurfaceOptions& ramp = options.surfaces["uphill"];
  ramp.slip = 0.1;
  OdeWorld world(body, Terrain(options), {-0.4, 0.0, 0.0}, 0.002);
  Run(world, 1.0, 0.002, {Servo(15.0), Servo(15.0)});
  const Stance stance = StanceOn(
      body, kGravity * Eigen::Vector3d(-std::sin(ramp.ramp_rad), 0.0, -std::cos(ramp.ramp_rad)));
  const double load_n = body.contact_stiffness_n_per_m * (body.wheel_radius_m - stance.height_m);
  const double used = 0.5 * Mass_kg(body) * kGravity * std::sin(ramp.ramp_rad) / (ramp.mu * load_n);
  CHECK(world.State().velocity_mps.norm() ==
        Approx(15.0 * body.wheel_radius_m * (1.0 - ramp.slip * used)).epsilon(0.002));
  CHECK(ramp.slip * used > 0.03);
}

TEST_CASE("Equal wheel rates drive a straight line") {
  OdeWorld world(BodyOptions{}, Ground(0.8), {0.0, 0.0, 0.3}, 0.004);
  Run(world, 3.0, 0.004, {Servo(15.0), Servo(15.0)});
  CHECK(std::abs(Yaw(world.State()) - 0.3) < 1e-6);
  const Eigen::Vector3d p = world.State().position_m;
  CHECK(std::abs(-std::sin(0.3) * p.x() + std::cos(0.3) * p.y()) < 1e-6);
  CHECK(std::hypot(p.x(), p.y()) == Approx(3.0 * 15.0 * 0.016).epsilon(0.01));
}

TEST_CASE("Opposite wheel rates turn the robot in place") {
  const BodyOptions body;
  OdeWorld world(body, Ground(0.8), {}, 0.002);
  const auto ramped = [](double t_s) {
    const double rate_rad_s = 5.0 * std::min(1.0, t_s / 0.2);
    return std::array<WheelDrive, 2>{Servo(-rate_rad_s), Servo(rate_rad_s)};
  };
  Run(world, 1.2, 0.002, ramped);
  const double turned_rad = 5.0 * (1.2 - 0.1) * 2.0 * body.wheel_radius_m / body.track_m;
  CHECK(Yaw(world.State()) == Approx(turned_rad).margin(0.01));
  CHECK(world.State().position_m.head<2>().norm() < 1e-4);
}

TEST_CASE("Opposite torques turn the robot by its inertia about the middle of its axle") {
  BodyOptions body;
  body.caster_mu = 0.0;
  body.wheel_mass_kg = 0.02;
  body.wheel_width_m = 0.02;
  body.com_ahead_m = -0.015;
  TerrainOptions options;
  options.surfaces["ground"].slip = 0.0;
  const double torque_nm = 5e-4, time_s = 0.2, half_m = 0.5 * body.track_m;
  const double r = body.wheel_radius_m, R = body.chassis_radius_m;
  // An upright cylinder beside the axle, and two that lie on it and roll.
  const double inertia_kg_m2 =
      body.chassis_mass_kg * (0.5 * R * R + body.com_ahead_m * body.com_ahead_m) +
      2.0 * body.wheel_mass_kg *
          (half_m * half_m + (3.0 * r * r + body.wheel_width_m * body.wheel_width_m) / 12.0 +
           0.5 * half_m * half_m);
  for (const double side : {1.0, -1.0}) {
    OdeWorld world(body, Terrain(options), {}, 0.001);
    const auto drive = [&](double sign) { return WheelDrive{sign * 1000.0, 0.0, torque_nm}; };
    Run(world, time_s, 0.001, {drive(-side), drive(side)});
    CHECK(world.State().spin_rad_s.z() ==
          Approx(side * 2.0 * torque_nm * half_m / r * time_s / inertia_kg_m2).epsilon(0.01));
  }
}

/// Wheel rates of a weave that never slips, mean of the exact ones over the step.
std::array<double, 2> WeaveRates(double t_s) {
  const double rise = t_s < 0.5 ? 0.5 * (1.0 - std::cos(2.0 * M_PI * t_s)) : 1.0;
  const double turn = 3.0 * std::sin(2.0 * M_PI * 0.8 * t_s);
  return {rise * (15.0 - turn), rise * (15.0 + turn)};
}
std::array<WheelDrive, 2> WeaveDrives(double t_s, double step_s) {
  const auto from = WeaveRates(t_s), to = WeaveRates(t_s + step_s);
  return {Servo(0.5 * (from[0] + to[0])), Servo(0.5 * (from[1] + to[1]))};
}

geometry::Pose2 Unicycle(const BodyOptions& body, double duration_s) {
  const double dt_s = 1e-5;
  geometry::Pose2 pose;
  for (int i = 0; i < std::lround(duration_s / dt_s); ++i) {
    const auto rates = WeaveRates((i + 0.5) * dt_s);
    const double v = 0.5 * (rates[0] + rates[1]) * body.wheel_radius_m;
    const double w = (rates[1] - rates[0]) * body.wheel_radius_m / body.track_m;
    const double yaw = pose.yaw_rad + 0.5 * w * dt_s;
    pose.x_m += v * std::cos(yaw) * dt_s;
    pose.y_m += v * std::sin(yaw) * dt_s;
    pose.yaw_rad += w * dt_s;
  }
  return pose;
}

double WeaveError_m(double step_s, const geometry::Pose2& truth) {
  BodyOptions body;
  OdeWorld world(body, Ground(5.0), {}, step_s);
  Run(world, 3.0, step_s, [step_s](double t_s) { return WeaveDrives(t_s, step_s); });
  return (world.State().position_m.head<2>() - truth.Position()).norm();
}

TEST_CASE("Without slip the robot is a unicycle to a hundredth of a millimetre") {
  const double error_m = WeaveError_m(0.001, Unicycle(BodyOptions{}, 3.0));
  INFO("error " << error_m * 1e3 << " mm");
  CHECK(error_m < 1e-5);
}

TEST_CASE("Halving the step more than halves the error as of second order") {
  BodyOptions body;
  OdeWorld reference(body, Ground(5.0), {}, 0.00025);
  Run(reference, 3.0, 0.00025, [](double t_s) { return WeaveDrives(t_s, 0.00025); });
  const geometry::Pose2 truth{reference.State().position_m.x(), reference.State().position_m.y(),
                              0.0};
  double coarse_m = WeaveError_m(0.016, truth);
  for (const double step_s : {0.008, 0.004, 0.002}) {
    const double fine_m = WeaveError_m(step_s, truth);
    INFO("step " << step_s << " s: " << fine_m * 1e3 << " mm, twice it " << coarse_m * 1e3);
    CHECK(fine_m < 0.4 * coarse_m);
    coarse_m = fine_m;
  }
}

TEST_CASE("Two worlds in two threads move exactly as one alone") {
  const auto drive = [](WorldState& end) {
    OdeWorld world(BodyOptions{}, Ground(0.4), {}, 0.004);
    Run(world, 2.0, 0.004, [](double t_s) { return WeaveDrives(t_s, 0.004); });
    end = world.State();
  };
  WorldState alone, first, second;
  drive(alone);
  std::thread one([&] { drive(first); }), two([&] { drive(second); });
  one.join();
  two.join();
  CHECK(alone.position_m == first.position_m);
  CHECK(alone.position_m == second.position_m);
  CHECK(alone.world_from_robot == second.world_from_robot);
}

TEST_CASE("A robot that drives off the table falls and says so") {
  TerrainOptions options;
  options.table_half_size_m = 0.3;
  OdeWorld world(BodyOptions{}, Terrain(options), {}, 0.004);
  Run(world, 4.0, 0.004, {Servo(15.0), Servo(15.0)});
  REQUIRE(world.Fall());
  CHECK_FALSE(world.Fault());  // the simulation is sound
  const bool explained = world.Fall()->find("fell") != std::string::npos ||
                         world.Fall()->find("tipped") != std::string::npos;
  CHECK(explained);
  const WorldState lies = world.State();
  Run(world, 0.1, 0.004, {Servo(15.0), Servo(15.0)});
  CHECK(world.State().position_m == lies.position_m);
}

TEST_CASE("A robot across a steep slippery ramp with a high centre of mass tips over") {
  BodyOptions body;
  body.com_above_m = 0.15;
  OdeWorld world(body, Ramp(Shape::kRampDown, 0.5, 2.0), {1.5, 0.0, 1.5707963}, 0.002);
  Run(world, 3.0, 0.002, {Servo(0.0), Servo(0.0)});
  REQUIRE(world.Fall());
  CHECK_THAT(*world.Fall(), Catch::StartsWith("tipped over at ("));
  CHECK_FALSE(world.Fault());
}

TEST_CASE("A drive that is not finite becomes a fault and the world stands still") {
  OdeWorld world(BodyOptions{}, Ground(0.8), {}, 0.004);
  world.Step({Servo(std::nan("")), Servo(1.0)});
  REQUIRE(world.Fault());
  world.Step({Servo(1.0), Servo(1.0)});
  CHECK(world.Fault());
}

TEST_CASE("An assertion inside ODE becomes an exception") {
  BodyOptions body;
  body.chassis_mass_kg = -1.0;
  CHECK_THROWS_AS(OdeWorld(body, Ground(0.8), {}, 0.004), std::runtime_error);
}

TEST_CASE("The robot climbs over blocks of four millimetres and stays upright") {
  TerrainOptions options;
  options.surface = "bump";
  OdeWorld world(BodyOptions{}, Terrain(options), {-0.28, -0.0785, 0.0}, 0.004);
  double highest_m = 0.0;
  Run(world, 3.0, 0.004, [&](double) {
    highest_m = std::max(highest_m, world.State().position_m.z());
    return std::array<WheelDrive, 2>{Servo(15.0), Servo(15.0)};
  });
  INFO(world.Fault().value_or("no fault"));
  CHECK_FALSE(world.Fault());
  CHECK(world.State().position_m.x() > 0.1);
  CHECK(highest_m > 0.016 + 0.001);
  CHECK(highest_m < 0.016 + 0.006);
}

TEST_CASE("A robot put down on blocks has come to rest with its wheels' angles at zero") {
  TerrainOptions options;
  options.surface = "bump";
  // The left wheel on a block, the right one and the caster on the floor.
  OdeWorld world(BodyOptions{}, Terrain(options), {0.0, 0.06 - 0.0415, 0.0}, 0.004);
  REQUIRE_FALSE(world.Fault());
  const WorldState start = world.State();
  CHECK(start.velocity_mps.norm() == 0.0);
  CHECK(start.spin_rad_s.norm() == 0.0);
  for (const int side : {0, 1}) {
    CHECK(start.wheel_angle_rad[side] == 0.0);
    CHECK(start.wheel_rate_rad_s[side] == 0.0);
  }
  CHECK(start.position_m.z() == Approx(0.016 + 0.002).margin(0.001));
  const double roll_rad = std::atan2(start.world_from_robot(2, 1), start.world_from_robot(2, 2));
  CHECK(roll_rad == Approx(0.004 / 0.083).margin(0.01));
  Run(world, 0.4, 0.004, {Servo(0.0), Servo(0.0)});
  CHECK((world.State().position_m - start.position_m).norm() < 2e-4);
}

TEST_CASE("The robot drives up and down the ramp board and over its edge") {
  const bool up = GENERATE(true, false);
  TerrainOptions options;
  options.surface = up ? "uphill" : "downhill";
  OdeWorld world(BodyOptions{}, Terrain(options), {-0.28, -0.065, 0.0}, 0.004);
  const double start_z = world.State().position_m.z();
  Run(world, 3.0, 0.004, {Servo(15.0), Servo(15.0)});
  INFO(world.Fault().value_or("no fault"));
  CHECK_FALSE(world.Fault());
  const double climbed_m = world.State().position_m.z() - start_z;
  CHECK(world.State().position_m.x() > 0.3);
  const double x_m = world.State().position_m.x();
  const Terrain terrain(options);
  CHECK(climbed_m ==
        Approx(terrain.HeightAt(x_m, 0.0) - terrain.HeightAt(-0.28, 0.0)).margin(0.002));
  CHECK(std::abs(climbed_m) > 0.08);
}

TEST_CASE("A sliding caster turns a coasting robot by its lever alone, whatever the heading") {
  BodyOptions body;
  body.caster_mu = 0.1;
  const auto coast = [&](double yaw_rad) {
    OdeWorld world(body, Ground(0.8), {0.0, 0.0, yaw_rad}, 0.004);
    world.Launch(0.3);
    Run(world, 0.5, 0.004, {Drag(kFree), Drag(kFree)});
    return std::pair{world.State().position_m.norm(), Yaw(world.State()) - yaw_rad};
  };
  const double straight_m = coast(0.0).first;
  for (const double yaw_rad : {0.2, 0.26, 0.785, 1.3, -2.5}) {
    const auto [moved_m, turned_rad] = coast(yaw_rad);
    CHECK(std::abs(turned_rad) < 1e-9);
    CHECK(moved_m == Approx(straight_m).margin(1e-9));
  }
}

TEST_CASE("Dry friction in the gears holds the robot on the ramp and gives way beyond") {
  const BodyOptions body;
  const double angle_rad = 0.255;
  const double holding_nm =
      0.5 * Mass_kg(body) * kGravity * std::sin(angle_rad) * body.wheel_radius_m;
  CHECK(holding_nm == Approx(0.0033).margin(0.0001));
  const bool down = GENERATE(true, false);
  const auto moved = [&](double friction_nm) {
    OdeWorld world(body, Ramp(down ? Shape::kRampDown : Shape::kRampUp, angle_rad, 0.9),
                   {down ? 1.0 : -1.0, 0.0, 0.0}, 0.004);
    const Eigen::Vector3d start = world.State().position_m;
    // A motor that gets no power brakes by its windings and holds nothing at rest.
    const WheelDrive off{0.0, 2300.0, kEndless, friction_nm};
    Run(world, 2.0, 0.004, {off, off});
    return (world.State().position_m - start).norm();
  };
  CHECK(moved(1.02 * holding_nm) < 1e-5);
  CHECK(moved(0.98 * holding_nm) > 1e-3);
}

}  // namespace
}  // namespace rift::simulation
