#include "simulation/block_contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "rift/simulation/ode_world.hpp"
#include "rift/statistics/random.hpp"

namespace rift::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_m = 0.016;
constexpr double kRoundness_m = 0.0034;
constexpr double kHeight_m = 0.004;
const Block kBlock{0.06, 0.0, 0.010, kHeight_m};

RoundEdge Tyre(const Vector3d& centre, double yaw_rad = 0.0) {
  return {
      centre, {-std::sin(yaw_rad), std::cos(yaw_rad), 0.0}, kRadius_m - kRoundness_m, kRoundness_m};
}

RoundEdge Ball(const Vector3d& centre, double radius_m) {
  return {centre, Vector3d::UnitY(), 0.0, radius_m};
}

/// Of the contact that reaches in most; negative when none does.
double Depth_m(const std::vector<ContactPoint>& contacts) {
  double depth_m = -1.0;
  for (const ContactPoint& contact : contacts) depth_m = std::max(depth_m, contact.depth_m);
  return depth_m;
}

TEST_CASE("A tyre on a block stands on its top, one beside it on the floor") {
  const double sunk_m = 1e-5;
  const auto on_top =
      ContactsWithBlocks({kBlock}, Tyre({0.061, 0.002, kHeight_m + kRadius_m - sunk_m}, 0.4), 0.0);
  REQUIRE(on_top.size() == 1);
  CHECK(on_top[0].depth_m == Approx(sunk_m).epsilon(1e-9));
  CHECK((on_top[0].normal - Vector3d::UnitZ()).norm() < 1e-12);
  CHECK((on_top[0].point - Vector3d(0.061, 0.002, kHeight_m - sunk_m)).norm() < 1e-12);

  const auto on_floor = ContactsWithBlocks({kBlock}, Tyre({0.02, 0.0, kRadius_m - sunk_m}), 0.0);
  REQUIRE(on_floor.size() == 1);
  CHECK(on_floor[0].depth_m == Approx(sunk_m).epsilon(1e-9));
}

TEST_CASE("A tyre that runs into a block touches its edge along the line to its hub") {
  const double side = GENERATE(1.0, -1.0);  // from either side of the block
  const Vector3d edge(kBlock.x_m - side * 0.010, 0.003, kHeight_m);
  const double low_m = kRadius_m - kHeight_m, sunk_m = 2e-5;
  const double reach_m = std::sqrt(std::pow(kRadius_m - sunk_m, 2) - low_m * low_m);
  const auto contacts =
      ContactsWithBlocks({kBlock}, Tyre({edge.x() - side * reach_m, 0.003, kRadius_m}), 0.0);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].depth_m == Approx(sunk_m).epsilon(1e-9));
  CHECK(contacts[0].normal.x() == Approx(-side * reach_m / (kRadius_m - sunk_m)));
  CHECK(contacts[0].normal.z() == Approx(low_m / (kRadius_m - sunk_m)));
  CHECK(std::abs(contacts[0].normal.y()) < 1e-12);
}

TEST_CASE("A ball before the corner of a block touches the corner") {
  const double radius_m = 0.00635;
  const Vector3d corner(kBlock.x_m - 0.010, 0.010, kHeight_m);
  const Vector3d away = Vector3d(-0.6, 0.64, 0.48);
  const auto contacts =
      ContactsWithBlocks({kBlock}, Ball(corner + (radius_m - 1e-5) * away, radius_m), 0.0);
  const auto at_corner = std::find_if(contacts.begin(), contacts.end(),
                                      [](const auto& c) { return c.normal.x() != 0.0; });
  REQUIRE(at_corner != contacts.end());
  CHECK((at_corner->normal - away).norm() < 1e-12);
  CHECK(at_corner->depth_m == Approx(1e-5).epsilon(1e-9));
}

TEST_CASE("A part that will run into a block is known before it does, by how far off it is") {
  const double off_m = 0.001;
  const Vector3d centre(kBlock.x_m, 0.0, kHeight_m + kRadius_m + off_m);
  CHECK(ContactsWithBlocks({kBlock}, Tyre(centre), 0.9 * off_m).empty());
  const auto contacts = ContactsWithBlocks({kBlock}, Tyre(centre), 1.1 * off_m);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].depth_m == Approx(-off_m));
}

TEST_CASE("However a wheel moves over blocks, its depth changes by no more than its way") {
  TerrainOptions options;
  options.surface = "bump";
  const Terrain terrain(options);
  const statistics::CounterRandom random(5, 1);
  const double margin_m = 0.05;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const auto draw = [&](std::uint64_t k) { return random.Uniform(i, k) - 0.5; };
    const Vector3d centre(0.1 * draw(0), 0.1 * draw(1), kRadius_m + 0.004 * (draw(2) + 0.5));
    const Vector3d step = 0.002 * Vector3d(draw(3), draw(4), draw(5));
    const double yaw_rad = 6.0 * draw(6);
    const auto depth_m = [&](const Vector3d& at) {
      return Depth_m(ContactsWithBlocks(*terrain.BlocksNear(at.x(), at.y(), 0.03),
                                        Tyre(at, yaw_rad), margin_m));
    };
    CAPTURE(i);
    CHECK(std::abs(depth_m(centre + step) - depth_m(centre)) <= step.norm() + 1e-12);
  }
}

TEST_CASE("The blocks near a point are those that reach into the square about it") {
  TerrainOptions options;
  options.surface = "bump";
  options.table_half_size_m = 0.5;
  const Terrain terrain(options);
  const auto one = terrain.BlocksNear(0.121, -0.062, 0.016);
  REQUIRE(one);
  REQUIRE(one->size() == 1);
  CHECK(one->front().x_m == Approx(0.12));
  CHECK(one->front().y_m == Approx(-0.06));
  CHECK(terrain.BlocksNear(0.09, -0.06, 0.019)->empty());
  CHECK(terrain.BlocksNear(0.09, -0.06, 0.021)->size() == 2);
  CHECK_FALSE(terrain.BlocksNear(0.49, 0.0, 0.016));  // there the table ends
  CHECK_FALSE(Terrain(TerrainOptions{}).BlocksNear(0.0, 0.0, 0.1));
}

TEST_CASE("A robot that rolls freely over blocks never gains energy") {
  const double step_s = GENERATE(0.002, 0.004, 0.016), height_m = GENERATE(0.001, 0.004);
  TerrainOptions options;
  options.surface = "bump";
  options.surfaces["bump"].bump_height_m = height_m;
  const statistics::CounterRandom random(9, 2);
  double farthest_m = 0.0;
  for (std::uint64_t run = 0; run < 12; ++run) {
    const auto draw = [&](std::uint64_t k) { return 2.0 * random.Uniform(run, k) - 1.0; };
    BodyOptions body;
    body.caster_mu = 0.1;
    if (run % 2 == 1) body.caster_ahead_m = 0.0404, body.com_ahead_m = 0.008;
    OdeWorld world(body, Terrain(options), {0.03 * draw(0), 0.03 * draw(1), 3.14 * draw(2)},
                   step_s);
    const Vector3d start = world.State().position_m;
    world.Launch(0.35 + 0.15 * draw(3));
    const double start_j = world.Energy_j();
    double most_j = start_j;
    for (double t_s = 0.0; t_s < 0.8; t_s += step_s) {
      world.Step({});
      most_j = std::max(most_j, world.Energy_j());
    }
    CAPTURE(run, step_s, height_m);
    CHECK_FALSE(world.Fault());
    CHECK(most_j - start_j < 1e-9);
    farthest_m = std::max(farthest_m, (world.State().position_m - start).norm());
  }
  CHECK(farthest_m > 0.05);
}

}  // namespace
}  // namespace rift::simulation
