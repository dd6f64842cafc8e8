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

/// A picture of so many pixels to each side of a square of `width_m`; `share` of its height at x
/// and y.
template <class Share>
Terrain Pictured(double width_m, double height_m, int pixels, double mu, const Share& share) {
  TerrainOptions options = HeightfieldOptions(width_m, height_m);
  options.surfaces["ground"].mu = mu;
  const double pixel_m = width_m / (pixels - 1);
  std::vector<double> samples;
  for (int row = 0; row < pixels; ++row) {
    for (int column = 0; column < pixels; ++column) {
      samples.push_back(share(pixel_m * column - 0.5 * width_m, 0.5 * width_m - pixel_m * row));
    }
  }
  return Terrain(options, std::make_shared<HeightImage>(HeightImage{pixels, pixels, samples}));
}

/// Waves of 3 mm, 0.1 m long in x and 0.14 m in y.
Terrain Waves(double mu) {
  return Pictured(1.0, 0.003, 101, mu, [](double x_m, double y_m) {
    return 0.5 + 0.25 * std::sin(62.8 * (x_m + 0.5) + 0.4) + 0.25 * std::cos(44.9 * (0.5 - y_m));
  });
}

/// As long, with a crest near the middle.
Terrain HighWaves(double height_m) {
  return Pictured(1.0, height_m, 101, 0.8, [](double x_m, double y_m) {
    return 0.5 + 0.25 * std::sin(62.8 * x_m + 0.4) + 0.25 * std::cos(44.9 * y_m);
  });
}

/// Of height `per_m` x y.
Terrain Twisted(double per_m) {
  const double height_m = 0.125 * std::abs(per_m);
  return Pictured(0.5, height_m, 101, 0.8,
                  [=](double x_m, double y_m) { return 0.5 + per_m * x_m * y_m / height_m; });
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

TEST_CASE("A drive over ridges of twenty degrees ends where it did") {
  const Terrain ridges = Pictured(
      1.0, 0.04 * std::tan(M_PI / 18.0), 1001, 0.8,
      [](double x_m, double) { return std::abs(std::fmod(x_m + 10.013, 0.08) - 0.04) / 0.04; });
  CheckEnd(OdeWorld(BodyOptions{}, ridges, {-0.03, 0.0, 0.3}, kStep_s), 120,
           {0.0128580009, 0.0296514383, 0.0187542786, 0.9980069808, -0.0417923353, 0.0082510032,
            5.6611819399, 7.2992650425});
}

TEST_CASE("A robot whose upper wheel carries hardly anything drives across a slope as it did") {
  TerrainOptions options;
  SurfaceOptions& slope = options.surfaces["ground"];
  slope = SurfaceOptions{};
  slope.shape = Shape::kRampDown;
  slope.ramp_rad = 0.4;
  slope.ramp_top_m = 2.0;
  slope.mu = 0.9;
  slope.slip = 0.3;
  BodyOptions body;
  body.com_above_m = 0.05;
  CheckEnd(OdeWorld(body, Terrain(options), {1.5, 0.0, M_PI / 2.0}, kStep_s), 120,
           {1.5700959591, 0.0207175274, 1.3746742832, -0.8908392269, 0.3787853714, -0.0977109565,
            4.9942431561, 6.8606262891});
}

TEST_CASE("A robot that begins inside of blocks comes out of them as it did") {
  TerrainOptions options;
  options.surface = "bump";
  SurfaceOptions& blocks = options.surfaces["bump"];
  blocks.bump_height_m = 0.016;
  blocks.bump_pitch_m = 0.083;  // under both wheels
  blocks.bump_size_m = 0.03;
  CheckEnd(OdeWorld(BodyOptions{}, Terrain(options), {0.002, 0.0415, 0.03}, kStep_s), 0,
           {-0.0064188854, 0.0413406477, 0.0321275903, 0.9066220904, 0.4218044643, -0.0040244462,
            0.0, 0.0});
}

TEST_CASE("A robot that slides off its place each time is put down six times") {
  CheckEnd(OdeWorld(BodyOptions{}, HighWaves(0.02), {0.037, -0.052, 0.7}, kStep_s), 0,
           {0.0369705019, -0.0520681820, 0.0258540275, 0.7592441087, -0.1168765375, 0.1919186231,
            0.0, 0.0});
}

TEST_CASE("A robot that came to rest a milliradian off is put down again, one less off is not") {
  for (const double side : {1.0, -1.0}) {
    const auto off_rad = [side](double per_m) {
      const OdeWorld world(BodyOptions{}, Twisted(side * per_m), {}, kStep_s);
      const Eigen::Matrix3d& turned = world.State().world_from_robot;
      return side * std::atan2(turned(1, 0), turned(0, 0));
    };
    // It turns by the more the more the ground is twisted, by a milliradian at 1.39.
    CHECK(off_rad(1.36) > 0.95e-3);
    CHECK(off_rad(1.36) < 1e-3);
    CHECK(off_rad(1.48) < 1e-4);
    CHECK(off_rad(1.48) > 0.0);
  }
}

TEST_CASE("A robot that came to rest a tenth of a millimetre off is put down again") {
  const auto off_m = [](double height_m) {
    const OdeWorld world(BodyOptions{}, HighWaves(height_m), {0.06, -0.052, 0.7}, kStep_s);
    return (world.State().position_m.head<2>() - Eigen::Vector2d(0.06, -0.052)).norm();
  };
  CHECK(off_m(0.0047) > 0.95e-4);
  CHECK(off_m(0.0047) < 1e-4);
  for (const double height_m : {0.0048, 0.0050, 0.0052, 0.0054}) CHECK(off_m(height_m) < 1e-5);
}

}  // namespace
}  // namespace rift::simulation
