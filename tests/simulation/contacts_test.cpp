#include "simulation/contacts.hpp"
#include "simulation/heightfield_options.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace rift::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_m = 0.016;

Terrain Named(const std::string& surface) {
  TerrainOptions options;
  options.surface = surface;
  return Terrain(options);
}

/// A heightfield of 2 x 2 m about the origin that climbs by 0.05 towards +x and by 0.1 towards +y.
Terrain Slanted() {
  const TerrainOptions options = HeightfieldOptions(2.0, 0.3);
  const auto image =
      std::make_shared<HeightImage>(HeightImage{2, 2, {2.0 / 3.0, 1.0, 0.0, 1.0 / 3.0}});
  return Terrain(options, image);
}

const Vector3d kSlantedNormal = Vector3d(-0.05, -0.1, 1.0).normalized();

TEST_CASE("A ball and a rim on a plane touch with their point farthest down its normal") {
  const Terrain terrain = Named("downhill");
  const Vector3d ground(0.5, 0.02, terrain.HeightAt(0.5, 0.02));
  const Vector3d normal = terrain.NormalAt(0.5, 0.02);
  const auto ball = BallContactPoint(terrain, ground + 0.0149 * normal, Vector3d::UnitX(), 0.015);
  REQUIRE(ball);
  CHECK(ball->depth_m == Approx(1e-4));
  CHECK((ball->point - (ground - 1e-4 * normal)).norm() < 1e-9);
  CHECK((ball->normal - normal).norm() < 1e-9);
  CHECK_FALSE(BallContactPoint(terrain, ground + 0.0151 * normal, Vector3d::UnitX(), 0.015));
  // A disc that stands upright on its edge, across the slope.
  const Vector3d up = Vector3d::UnitY();
  const auto rim = RimContactPoint(terrain, ground + 0.0399 * normal, Vector3d::UnitX(), up, 0.04);
  REQUIRE(rim);
  CHECK(rim->depth_m == Approx(1e-4));
  CHECK((rim->point - (ground - 1e-4 * normal)).norm() < 1e-9);
  CHECK_FALSE(RimContactPoint(terrain, ground + 0.0401 * normal, Vector3d::UnitX(), up, 0.04));
}

TEST_CASE("On ground that is no plane a ball leans as the ground does, whichever way it looks") {
  const Terrain terrain = Slanted();
  const Vector3d ground(0.1, -0.2, terrain.HeightAt(0.1, -0.2));
  CHECK(ground.z() == Approx(0.15 + 0.005 - 0.02));
  for (const double yaw_rad : {0.0, 0.7, 1.6, -2.5}) {
    INFO(yaw_rad);
    const Vector3d forward(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
    const auto ball =
        BallContactPoint(terrain, ground + (kRadius_m - 1e-4) * kSlantedNormal, forward, kRadius_m);
    REQUIRE(ball);
    CHECK((ball->normal - kSlantedNormal).norm() < 5e-3);
    // Two vertical cuts through the ball, neither down the slope, see a little less of it.
    CHECK(ball->depth_m == Approx(7.5e-5).margin(2.6e-5));
    CHECK_FALSE(BallContactPoint(terrain, ground + (kRadius_m + 1e-6) * kSlantedNormal, forward,
                                 kRadius_m));
  }
}

TEST_CASE("A level rim over ground that is no plane touches where the ground is highest under it") {
  const Terrain terrain = Slanted();
  // Of eight points about the middle the one at 45 degrees is the highest: 0.04 m ahead and left.
  const double radius_m = 0.04, along_m = radius_m / std::sqrt(2.0);
  const double highest_m = terrain.HeightAt(along_m, along_m);
  const auto rim = RimContactPoint(terrain, {0.0, 0.0, highest_m - 1e-3}, Vector3d::UnitX(),
                                   Vector3d::UnitZ(), radius_m);
  REQUIRE(rim);
  CHECK(rim->depth_m == Approx(1e-3));
  CHECK((rim->point - Vector3d(along_m, along_m, highest_m - 1e-3)).norm() < 1e-9);
  CHECK((rim->normal - kSlantedNormal).norm() < 1e-6);
  CHECK_FALSE(RimContactPoint(terrain, {0.0, 0.0, highest_m + 1e-6}, Vector3d::UnitX(),
                              Vector3d::UnitZ(), radius_m));
}

TEST_CASE("A wheel that hangs over the edge of a table rests on its corner") {
  TerrainOptions options;
  options.table_half_size_m = 1.0;
  const Terrain terrain(options);
  // Nearly 1 cm beyond the edge of x, at a height at which the corner is just inside of the disc.
  const double beyond_m = 0.0097, low_m = std::sqrt(kRadius_m * kRadius_m - beyond_m * beyond_m);
  const auto contact = WheelContactPoint(terrain, {1.0 + beyond_m, 0.0, low_m - 1e-4},
                                         Vector3d::UnitY(), kRadius_m, 0.0);
  REQUIRE(contact);
  // The edge is found to a micrometre.
  const double away_m = std::hypot(beyond_m, low_m - 1e-4);
  CHECK(std::abs(contact->normal.x() - beyond_m / away_m) < 5e-5);
  CHECK(std::abs(contact->normal.z() - (low_m - 1e-4) / away_m) < 5e-5);
  CHECK(std::abs(contact->depth_m - (kRadius_m - away_m)) < 1e-6);
  CHECK_FALSE(WheelContactPoint(terrain, {1.0 + beyond_m, 0.0, low_m + 1e-4}, Vector3d::UnitY(),
                                kRadius_m, 0.0));
}

TEST_CASE("The edge of a table is found to a third of a micrometre, and to no less") {
  TerrainOptions options;
  options.table_half_size_m = 1.0;
  const Terrain terrain(options);
  // A wheel's diameter in 24 parts, each of which is halved twelve times.
  const double found_m = 2.0 * kRadius_m / 24.0 / 4096.0, height_m = 0.002;
  double most_m = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double beyond_m = 0.014 + 2.3e-5 * i;
    const auto contact = WheelContactPoint(terrain, {1.0 + beyond_m, 0.0, height_m},
                                           Vector3d::UnitY(), kRadius_m, 0.0);
    REQUIRE(contact);
    const double away_m = kRadius_m - contact->depth_m;
    const double off_m = std::sqrt(away_m * away_m - height_m * height_m) - beyond_m;
    CHECK(off_m > -1e-9);
    most_m = std::max(most_m, off_m);
  }
  CHECK(most_m < 1.01 * found_m);
  CHECK(most_m > 0.8 * found_m);
}

TEST_CASE("A wide wheel counts the highest ground under its width") {
  const TerrainOptions options = HeightfieldOptions(0.02, 0.002);
  // A ridge along x at y = 0.01, up to which the ground climbs from y = 0.
  const auto image = std::make_shared<HeightImage>(
      HeightImage{3, 3, {1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}});
  const Terrain terrain(options, image);
  const auto depth_m = [&](double y_m, double width_m) {
    const auto contact =
        WheelContactPoint(terrain, {0.0, y_m, kRadius_m}, Vector3d::UnitY(), kRadius_m, width_m);
    return contact ? contact->depth_m : 0.0;
  };
  CHECK(depth_m(0.0, 0.0) == 0.0);
  CHECK(depth_m(0.0, 0.008) == Approx(0.0008).epsilon(0.02));  // half of it to the left
  CHECK(depth_m(-0.002, 0.008) == Approx(0.0004).epsilon(0.02));
  CHECK(depth_m(0.004, 0.0) == Approx(0.0008).epsilon(0.02));
}

TEST_CASE("A wide wheel sees as far to its left as to its right, whichever way it rolls") {
  const TerrainOptions options = HeightfieldOptions(0.02, 0.002);
  // A ridge 0.01 m to one side, up to which the ground climbs from the middle.
  struct Case {
    std::vector<double> samples;
    Vector3d axle;
  };
  for (const Case& one : {Case{{1, 1, 1, 0, 0, 0, 0, 0, 0}, Vector3d::UnitY()},
                          Case{{0, 0, 0, 0, 0, 0, 1, 1, 1}, Vector3d::UnitY()},
                          Case{{1, 0, 0, 1, 0, 0, 1, 0, 0}, Vector3d::UnitX()},
                          Case{{0, 0, 1, 0, 0, 1, 0, 0, 1}, Vector3d::UnitX()}}) {
    const Terrain terrain(options, std::make_shared<HeightImage>(HeightImage{3, 3, one.samples}));
    for (const double sign : {1.0, -1.0}) {
      const auto contact =
          WheelContactPoint(terrain, {0.0, 0.0, kRadius_m}, sign * one.axle, kRadius_m, 0.008);
      REQUIRE(contact);
      CHECK(contact->depth_m == Approx(0.0008).epsilon(0.02));  // 0.4 of the way up
    }
  }
}

TEST_CASE("A wheel whose middle lies on the ground is pushed upwards by all of its radius") {
  const Terrain terrain = Slanted();
  const Vector3d ground(0.1, -0.2, terrain.HeightAt(0.1, -0.2));
  const auto contact = WheelContactPoint(terrain, ground, Vector3d::UnitY(), kRadius_m, 0.0);
  REQUIRE(contact);
  CHECK(contact->depth_m == Approx(kRadius_m));
  CHECK(contact->normal.norm() == Approx(1.0));
  CHECK(contact->normal.z() > 0.99);
}

TEST_CASE("A tyre among blocks is round by half its width, and by half its radius at most") {
  TerrainOptions options;
  options.surface = "bump";
  const Terrain terrain(options);
  const double lean_rad = 0.3;
  WorldState state;
  state.world_from_robot = Eigen::AngleAxisd(lean_rad, Vector3d::UnitX()).toRotationMatrix();
  for (const auto& [width_m, round_m] : {std::pair{0.0068, 0.0034}, {0.05, 0.008}}) {
    BodyOptions body;
    body.wheel_width_m = width_m;
    const ContactScene scene{body, terrain, state, {}, 0.0};
    // On the floor between four blocks, leaning on the round of its edge.
    const double hub_m = (kRadius_m - round_m) * std::cos(lean_rad) + round_m;
    std::vector<GroundContact> contacts;
    AddWheelContacts(scene, 0, {0.03, 0.03, hub_m + 1e-6}, contacts);
    CHECK(contacts.empty());
    AddWheelContacts(scene, 0, {0.03, 0.03, hub_m - 1e-5}, contacts);
    REQUIRE(contacts.size() == 1);
    CHECK(contacts[0].at.depth_m == Approx(1e-5).epsilon(1e-6));
  }
}

/// A robot that moves, turns and spins its wheels.
WorldState Moving() {
  WorldState state;
  state.position_m = {0.2, -0.1, kRadius_m - 1e-5};
  state.world_from_robot = Eigen::AngleAxisd(0.5, Vector3d::UnitZ()).toRotationMatrix();
  state.velocity_mps = {0.3, -0.1, 0.02};
  state.spin_rad_s = {0.0, 0.0, 2.0};
  state.wheel_rate_rad_s = {12.0, -7.0};
  return state;
}

TEST_CASE("A wheel grips across its way with the creep of its rim and the weight it carries") {
  TerrainOptions options;
  SurfaceOptions& surface = options.surfaces["ground"];
  surface.mu = 0.6;
  surface.slip = 0.04;
  const Terrain terrain(options);
  BodyOptions body;
  body.right_over_left = 1.05;
  const WorldState state = Moving();
  const ContactScene scene{body, terrain, state, {0.03, -0.02}, 0.0};
  for (const int side : {0, 1}) {
    const double radius_m = body.WheelRadius_m(side);
    const Vector3d axle = state.world_from_robot.col(1);
    const Vector3d centre = state.position_m + (side == 0 ? 0.04 : -0.04) * axle +
                            (radius_m - 1e-5 - state.position_m.z()) * Vector3d::UnitZ();
    std::vector<GroundContact> contacts;
    AddWheelContacts(scene, side, centre, contacts);
    REQUIRE(contacts.size() == 1);
    const GroundContact& contact = contacts[0];
    const double rolling_mps = state.wheel_rate_rad_s[side] * radius_m;
    CHECK(contact.at.depth_m == Approx(1e-5));
    CHECK(contact.mu == 0.6);
    CHECK((contact.direction - axle).norm() < 1e-9);
    CHECK(contact.creep_along_mps == Approx(0.04 * std::abs(rolling_mps)));
    CHECK(contact.creep_across_mps == Approx(0.04 * std::abs(rolling_mps)));
    CHECK(contact.usual_load_n == Approx(body.WeightOnWheel_n()));
    CHECK(contact.uneven_mps == Approx((side == 0 ? 0.03 : -0.02) * rolling_mps));
  }
}

TEST_CASE("Caster and rim slide against their own motion in the ground") {
  TerrainOptions options;
  options.surfaces["ground"].caster_factor = 2.5;
  const Terrain terrain(options);
  BodyOptions body;
  body.caster_mu = 0.1;
  body.rim_mu = 0.35;
  body.caster_below_m = kRadius_m - body.caster_radius_m;
  WorldState state = Moving();
  const ContactScene scene{body, terrain, state, {}, 0.0};
  std::vector<GroundContact> contacts;
  AddCasterContacts(scene, contacts);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].at.depth_m == Approx(1e-5));
  CHECK(contacts[0].mu == Approx(0.25));
  CHECK(contacts[0].usual_load_n == Approx(body.WeightOnCaster_n()));
  const auto check_motion = [&](const GroundContact& contact) {
    const Vector3d arm = contact.at.point - state.position_m;
    const Vector3d v(state.velocity_mps.x() - state.spin_rad_s.z() * arm.y(),
                     state.velocity_mps.y() + state.spin_rad_s.z() * arm.x(), 0.0);
    CHECK((contact.direction - v.normalized()).norm() < 1e-9);
    CHECK(contact.creep_along_mps == 0.0);
    CHECK(contact.creep_across_mps == Approx(v.norm()));
    CHECK(contact.uneven_mps == 0.0);
  };
  check_motion(contacts[0]);
  CHECK((contacts[0].at.point.head<2>() - state.position_m.head<2>()).norm() ==
        Approx(std::abs(body.caster_ahead_m)));

  contacts.clear();
  AddRimContacts(scene, contacts);
  CHECK(contacts.empty());  // it is clear of the ground
  state.position_m.z() -= body.rim_clearance_m;
  AddRimContacts(scene, contacts);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].at.depth_m == Approx(1e-5));
  CHECK(contacts[0].mu == 0.35);
  CHECK(contacts[0].usual_load_n == Approx(body.Weight_n()));
  check_motion(contacts[0]);

  // At rest there is no way to slide along: the robot's own.
  contacts.clear();
  state.velocity_mps.setZero();
  state.spin_rad_s.setZero();
  AddRimContacts(scene, contacts);
  REQUIRE(contacts.size() == 1);
  CHECK((contacts[0].direction - state.world_from_robot.col(0)).norm() < 1e-9);
  CHECK(contacts[0].creep_across_mps == 0.0);
}

TEST_CASE("The rim of the chassis runs into the side of a block at the chassis' own radius") {
  TerrainOptions options;
  options.surface = "bump";  // blocks of 0.02 m, 0.06 m apart, 0.004 m high
  const Terrain terrain(options);
  BodyOptions body;
  body.rim_clearance_m = 0.002;
  for (const double sunk_m : {1e-5, -1e-6}) {
    WorldState state;
    state.position_m = {0.05 - body.chassis_radius_m + sunk_m, 0.0, body.wheel_radius_m};
    std::vector<GroundContact> contacts;
    AddRimContacts({body, terrain, state, {}, 0.0}, contacts);
    REQUIRE(contacts.size() == (sunk_m > 0.0 ? 1u : 0u));
    if (contacts.empty()) continue;
    CHECK(contacts[0].at.depth_m == Approx(sunk_m).epsilon(1e-6));
    CHECK((contacts[0].at.normal + Vector3d::UnitX()).norm() < 1e-9);
  }
}

TEST_CASE(
    "The rim of the chassis stands on a block by its lower side, round by half a millimetre") {
  TerrainOptions options;
  options.surface = "bump";
  const Terrain terrain(options);
  BodyOptions body;
  body.rim_clearance_m = 0.002;
  const auto contacts_at = [&](double x_m, double lower_side_m, double margin_m) {
    WorldState state;
    state.position_m = {x_m, 0.0, body.wheel_radius_m - 0.002 + lower_side_m};
    std::vector<GroundContact> contacts;
    AddRimContacts({body, terrain, state, {}, margin_m}, contacts);
    return contacts;
  };
  // Its foremost point over the middle of a block.
  const double over_m = 0.06 - body.chassis_radius_m;
  CHECK(contacts_at(over_m, 0.004 + 1e-6, 0.0).empty());
  const auto on_top = contacts_at(over_m, 0.004 - 1e-5, 0.0);
  REQUIRE_FALSE(on_top.empty());
  for (const GroundContact& contact : on_top) {
    CHECK(contact.at.depth_m == Approx(1e-5).epsilon(1e-6));
    CHECK((contact.at.normal - Vector3d::UnitZ()).norm() < 1e-9);
  }
  // The middle of its round edge 0.3 mm above the block's and 0.4 mm before it: half a millimetre.
  const double before_m = 0.05 - 0.0004 - (body.chassis_radius_m - 0.0005);
  CHECK(contacts_at(before_m - 1e-6, 0.004 + 0.0003 - 0.0005, 0.0).empty());
  const auto at_edge = contacts_at(before_m + 1e-5, 0.004 + 0.0003 - 0.0005, 0.0);
  REQUIRE(at_edge.size() == 1);
  CHECK(at_edge[0].at.depth_m == Approx(0.0005 - std::hypot(0.00039, 0.0003)).epsilon(1e-5));
  CHECK(at_edge[0].at.normal.x() == Approx(-0.39 / std::hypot(0.39, 0.3)).epsilon(1e-5));
  // It is known before it touches, by the margin.
  const double off_m = 0.05 - body.chassis_radius_m - 1e-4;
  CHECK(contacts_at(off_m, 0.002, 0.9e-4).empty());
  const auto ahead = contacts_at(off_m, 0.002, 1.1e-4);
  REQUIRE(ahead.size() == 1);
  CHECK(ahead[0].at.depth_m == Approx(-1e-4).epsilon(1e-6));
}

TEST_CASE(
    "A motion ends where the robot tips by 60 degrees, sinks by 12 mm or falls by half a metre") {
  TerrainOptions options;
  options.table_half_size_m = 1.0;
  const Terrain terrain(options);
  const auto fault = [&](const Vector3d& p, double lean_rad) {
    WorldState state;
    state.position_m = p;
    state.world_from_robot =
        Eigen::AngleAxisd(lean_rad, Vector3d(0.6, 0.8, 0.0)).toRotationMatrix();
    return FaultOf(state, terrain).value_or(FallOf(state, terrain).value_or(""));
  };
  CHECK(fault({0.0, 0.0, 0.016}, 1.04).empty());
  CHECK(fault({0.1, -0.25, 0.016}, 1.06) == "tipped over at (0.100, -0.250) m");
  CHECK(fault({0.1, 0.2, -0.0119}, 0.0).empty());
  CHECK(fault({0.1, 0.2, -0.0121}, 0.0) == "sank through the floor at (0.100, 0.200) m");
  CHECK(fault({1.1, 0.0, -0.49}, 0.0).empty());
  CHECK(fault({1.1, 0.0, -0.51}, 0.0) == "fell off the table at (1.100, 0.000) m");
  for (int k = 0; k < 5; ++k) {
    WorldState state;
    if (k == 0) state.position_m.y() = std::nan("");
    if (k == 1) state.velocity_mps.z() = INFINITY;
    if (k == 2) state.world_from_robot(1, 1) = std::nan("");
    if (k == 3) state.wheel_rate_rad_s[1] = std::nan("");
    if (k == 4) state.wheel_rate_rad_s[0] = -INFINITY;
    CHECK(FaultOf(state, terrain).value() == "the simulated motion is no longer finite");
  }
}

TEST_CASE("The caster's ball touches a block by its own radius, as far behind as it hangs") {
  TerrainOptions options;
  options.surface = "bump";  // blocks of 0.02 m, 0.06 m apart, 0.004 m high
  options.surfaces["bump"].caster_factor = 2.5;
  const Terrain terrain(options);
  BodyOptions body;
  body.caster_mu = 0.1;
  body.caster_ahead_m = -0.05;
  body.caster_below_m = 0.003;
  body.caster_radius_m = 0.007;
  WorldState state;
  state.world_from_robot = Eigen::AngleAxisd(M_PI / 2.0, Vector3d::UnitZ()).toRotationMatrix();
  // Behind a robot that looks along y, over the middle of a block.
  for (const double sunk_m : {1e-5, -1e-6}) {
    state.position_m = {0.06, 0.17, 0.004 + 0.007 + 0.003 - sunk_m};
    std::vector<GroundContact> contacts;
    AddCasterContacts({body, terrain, state, {}, 0.0}, contacts);
    REQUIRE(contacts.size() == (sunk_m > 0.0 ? 1u : 0u));
    if (contacts.empty()) continue;
    CHECK(contacts[0].at.depth_m == Approx(1e-5).epsilon(1e-6));
    CHECK((contacts[0].at.point - Vector3d(0.06, 0.12, 0.004 - 1e-5)).norm() < 1e-12);
    CHECK(contacts[0].mu == Approx(0.25));
    CHECK(contacts[0].usual_load_n == Approx(body.WeightOnCaster_n()));
  }
}

TEST_CASE("A wheel on a block has the grip of the place where it touches") {
  TerrainOptions options;
  options.surface = "bump";
  options.patches = {{0.05, 0.07, -0.01, 0.01, 0.35, 0.0, 0.0}};  // the block at x = 0.06
  const Terrain terrain(options);
  const BodyOptions body;
  WorldState state;
  state.wheel_rate_rad_s = {-10.0, 20.0};
  for (const auto& [x_m, mu] : {std::pair{0.06, 0.35}, {0.12, 0.85}}) {
    for (const int side : {0, 1}) {
      std::vector<GroundContact> contacts;
      const ContactScene scene{body, terrain, state, {0.05, -0.02}, 0.0};
      AddWheelContacts(scene, side, {x_m, 0.0, 0.004 + kRadius_m - 1e-5}, contacts);
      REQUIRE(contacts.size() == 1);
      CHECK(contacts[0].mu == mu);
      CHECK(contacts[0].creep_along_mps ==
            Approx(mu == 0.35 ? 0.0 : (side == 0 ? 0.0016 : 0.0032)));
      CHECK(contacts[0].uneven_mps == Approx(side == 0 ? -0.008 : -0.0064));
    }
  }
}

}  // namespace
}  // namespace rift::simulation
