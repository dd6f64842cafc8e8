// Where short drives over each kind of ground ended when they were last looked at, to a micrometre:
// no closed form tells of the contacts' finer settings. Another physics changes these numbers, and
// then they are to be written anew.

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "rift/simulation/ode_world.hpp"
#include "simulation/heightfield_options.hpp"

namespace rift::simulation {
namespace {

constexpr double kStep_s = 0.004;

/// Waves of 3 mm, 0.1 m long in x and 0.14 m in y.
Terrain Waves(double mu) {
  TerrainOptions options = HeightfieldOptions(1.0, 0.003);
  options.surfaces["ground"].mu = mu;
  constexpr int kPixels = 101;
  std::vector<double> samples;
  for (int row = 0; row < kPixels; ++row) {
    for (int column = 0; column < kPixels; ++column) {
      const double x_m = 0.01 * column, y_m = 0.01 * row;
      samples.push_back(0.5 + 0.25 * std::sin(62.8 * x_m + 0.4) + 0.25 * std::cos(44.9 * y_m));
    }
  }
  return Terrain(options, std::make_shared<HeightImage>(HeightImage{kPixels, kPixels, samples}));
}

Terrain Named(const std::string& surface) {
  TerrainOptions options;
  options.surface = surface;
  return Terrain(options);
}

/// Of a motor with some give.
WheelDrive Drive(double rate_rad_s) { return {rate_rad_s, 900.0, 0.02, 0.001}; }

void CheckEnd(OdeWorld world, int steps, const std::vector<double>& expected) {
  for (int i = 0; i < steps; ++i) world.Step({Drive(14.0), Drive(17.0)}, {0.02, -0.03});
  REQUIRE_FALSE(world.Fault());
  const WorldState& state = world.State();
  const Eigen::Matrix3d& turned = state.world_from_robot;
  const std::vector<double> seen{state.position_m.x(),
                                 state.position_m.y(),
                                 state.position_m.z(),
                                 turned(0, 0),
                                 turned(2, 0),
                                 turned(2, 1),
                                 state.wheel_angle_rad[0],
                                 state.wheel_angle_rad[1]};
  for (size_t i = 0; i < seen.size(); ++i) {
    INFO(i);
    CHECK(seen[i] == Approx(expected[i]).margin(1e-6).epsilon(0.0));
  }
}

TEST_CASE("A robot that is put down on waves stands there as it did") {
  CheckEnd(OdeWorld(BodyOptions{}, Waves(0.8), {0.037, -0.052, 0.7}, kStep_s), 0,
           {0.0369474205, -0.0520435942, 0.0176635783, 0.7649337884, -0.0185525146, 0.0099371804,
            0.0, 0.0});
}

TEST_CASE("A drive over waves ends where it did") {
  CheckEnd(OdeWorld(BodyOptions{}, Waves(0.5), {0.037, -0.052, 0.7}, kStep_s), 120,
           {0.1107636606, 0.0190597738, 0.0170424847, 0.6502942001, 0.0101031766, -0.0021311673,
            6.0830109243, 7.4368140031});
}

TEST_CASE("A drive over blocks ends where it did") {
  CheckEnd(OdeWorld(BodyOptions{}, Named("bump"), {-0.05, 0.012, 0.3}, kStep_s), 100,
           {0.0129237887, 0.0290400911, 0.0179594787, 0.9621646108, 0.0506339739, 0.0482068209,
            4.4844630354, 5.5522983086});
}

TEST_CASE("A drive over the edge of a ramp ends where it did") {
  CheckEnd(OdeWorld(BodyOptions{}, Named("downhill"), {-0.03, 0.02, 0.4}, kStep_s), 120,
           {0.0654019816, 0.0706031694, 0.2510563242, 0.7930037391, -0.1175525406, 0.1185133072,
            6.0125676089, 7.6880030039});
}

TEST_CASE("A drive on the floor ends where it did") {
  CheckEnd(OdeWorld(BodyOptions{}, Named("parchment"), {-0.03, 0.02, 0.4}, kStep_s), 120,
           {0.0595339412, 0.0669172900, 0.0159738866, 0.8366749660, 0.0008954021, 0.0000032045,
            6.0150466423, 7.4399794592});
}

}  // namespace
}  // namespace rift::simulation
