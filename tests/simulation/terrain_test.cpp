#include "rift/simulation/terrain.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "simulation/contacts.hpp"
#include "simulation/heightfield_options.hpp"

namespace rift::simulation {
namespace {

Terrain Named(const std::string& surface) {
  TerrainOptions options;
  options.surface = surface;
  return Terrain(options);
}

TEST_CASE("The downhill plateau lies before the edge and its slope falls to the floor") {
  const Terrain terrain = Named("downhill");
  CHECK(terrain.HeightAt(-1.0, 0.3) == Approx(0.24));
  CHECK(terrain.HeightAt(0.05, 0.0) == Approx(0.24));
  CHECK(terrain.HeightAt(0.45, 0.0) == Approx(0.24 - 0.40 * std::tan(0.255)));
  CHECK(terrain.HeightAt(0.05 + 0.24 / std::tan(0.255), 0.0) == Approx(0.0).margin(1e-12));
  CHECK(terrain.HeightAt(2.0, 0.0) == 0.0);
  CHECK(terrain.NormalAt(0.45, 0.0).x() == Approx(std::sin(0.255)));
}

TEST_CASE("Uphill is the downhill board mirrored at its edge") {
  const Terrain up = Named("uphill"), down = Named("downhill");
  for (double off_m = -1.5; off_m < 1.5; off_m += 0.05) {
    CHECK(up.HeightAt(0.31 + off_m, 0.0) == Approx(down.HeightAt(0.05 - off_m, 0.0)));
  }
  CHECK(up.HeightAt(0.0, 0.0) < up.HeightAt(0.04, 0.0));
}

TEST_CASE("Where the ground is one plane that plane is the ground") {
  const Terrain terrain = Named("downhill");
  int planes = 0;
  for (double x = -0.5; x < 1.5; x += 0.013) {
    const auto plane = terrain.PlaneNear(x, 0.1, 0.02);
    if (!plane) continue;
    ++planes;
    for (const double reach : {-0.02, 0.02}) {
      const Eigen::Vector3d p(x + reach, 0.1, terrain.HeightAt(x + reach, 0.1));
      CHECK(plane->normal.dot(p - plane->point) == Approx(0.0).margin(1e-12));
    }
  }
  CHECK(planes > 130);
  CHECK_FALSE(terrain.PlaneNear(0.05, 0.1, 0.02));
}

TEST_CASE("A bent board turns evenly from plateau to slope, downhill and uphill") {
  const double bend_m = 0.2, steep = std::tan(0.255);
  for (const Shape shape : {Shape::kRampDown, Shape::kRampUp}) {
    TerrainOptions options;
    SurfaceOptions& board = options.surfaces["ground"];
    board.shape = shape;
    board.ramp_edge_x_m = 0.05;
    const Terrain sharp(options);
    board.ramp_bend_m = bend_m;
    const Terrain bent(options);
    const double ahead = shape == Shape::kRampDown ? 1.0 : -1.0;
    const auto x = [&](double past_edge_m) { return 0.05 + ahead * past_edge_m; };
    for (const double away_m : {-0.3, -0.1, 0.1, 0.3}) {
      CHECK(bent.HeightAt(x(away_m), 0.0) == Approx(sharp.HeightAt(x(away_m), 0.0)).margin(1e-12));
    }
    CHECK(bent.HeightAt(x(0.0), 0.0) == Approx(0.24 - steep * bend_m / 8.0));
    for (double past_m = -0.09; past_m < 0.1; past_m += 0.02) {
      const Eigen::Vector3d normal = bent.NormalAt(x(past_m), 0.0);
      CHECK(ahead * normal.x() / normal.z() == Approx(steep * (past_m + 0.1) / bend_m));
    }
    int planes = 0;
    for (double off_m = -0.5; off_m < 0.5; off_m += 0.013) {
      const auto plane = bent.PlaneNear(0.05 + off_m, 0.1, 0.02);
      if (!plane) continue;
      ++planes;
      for (const double reach : {-0.02, 0.02}) {
        const double there = 0.05 + off_m + reach;
        const Eigen::Vector3d p(there, 0.1, bent.HeightAt(there, 0.1));
        CHECK(plane->normal.dot(p - plane->point) == Approx(0.0).margin(1e-12));
      }
    }
    CHECK(planes > 50);
  }
}

TEST_CASE("A plateau may rise towards the slope, which it meets at its full height") {
  const double rise_rad = 0.06, reach_m = 0.02, back_m = 0.24 / std::tan(rise_rad);
  const double bend_m = GENERATE(0.0, 0.3);
  for (const Shape shape : {Shape::kRampDown, Shape::kRampUp}) {
    TerrainOptions options;
    SurfaceOptions& board = options.surfaces["ground"];
    board.shape = shape;
    board.ramp_edge_x_m = 0.05;
    board.ramp_bend_m = bend_m;
    board.ramp_plateau_rad = rise_rad;
    const Terrain terrain(options);
    const double ahead = shape == Shape::kRampDown ? 1.0 : -1.0;
    const auto height_m = [&](double past_edge_m) {
      return terrain.HeightAt(0.05 + ahead * past_edge_m, 0.0);
    };
    CHECK(height_m(-0.5) == Approx(0.24 - 0.5 * std::tan(rise_rad)));
    CHECK(height_m(0.5) == Approx(0.24 - 0.5 * std::tan(0.255)));
    CHECK(height_m(0.0) == Approx(0.24 - (std::tan(0.255) + std::tan(rise_rad)) * bend_m / 8.0));
    CHECK(height_m(-back_m - 0.1) == 0.0);
    double slope_before = std::tan(rise_rad);
    for (double past_m = -0.145; past_m < 0.15; past_m += 0.01) {  // without a step anywhere
      const double slope = (height_m(past_m + 1e-3) - height_m(past_m - 1e-3)) / 2e-3;
      CHECK(slope <= slope_before + 1e-9);
      slope_before = slope;
    }
    int wrong = 0;
    for (double past_m = -back_m - 0.2; past_m < 1.5; past_m += 0.0017) {
      const auto plane = terrain.PlaneNear(0.05 + ahead * past_m, 0.1, reach_m);
      const auto near = [&](double edge_m, double half_m) {
        return std::abs(past_m - edge_m) < half_m + reach_m;
      };
      wrong += plane.has_value() ==
               (near(0.0, 0.5 * bend_m) || near(-back_m, 0.0) || near(0.24 / std::tan(0.255), 0.0));
      for (const double off_m : {-reach_m, reach_m}) {
        if (!plane) continue;
        const double x_m = 0.05 + ahead * past_m + off_m;
        const Eigen::Vector3d point(x_m, 0.1, terrain.HeightAt(x_m, 0.1));
        wrong += std::abs(plane->normal.dot(point - plane->point)) > 1e-12;
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("A turned board is the same board turned about its edge at y = 0") {
  const double turn_rad = GENERATE(0.25, -1.1), bend_m = GENERATE(0.0, 0.3), reach_m = 0.02;
  const Eigen::Rotation2Dd board_from_straight(turn_rad);
  for (const Shape shape : {Shape::kRampDown, Shape::kRampUp}) {
    TerrainOptions options;
    SurfaceOptions& board = options.surfaces["ground"];
    board.shape = shape;
    board.ramp_plateau_rad = 0.4;  // its foot 0.6 m behind the edge
    board.ramp_bend_m = bend_m;
    const Terrain straight(options);
    board.ramp_turn_rad = turn_rad;
    const Terrain turned(options);
    int planes = 0, wrong = 0;
    for (double x_m = -1.2; x_m < 1.2; x_m += 0.0137) {
      for (const double y_m : {-0.4, 0.03, 0.7}) {
        const Eigen::Vector2d at =
            Eigen::Vector2d(board.ramp_edge_x_m, 0.0) +
            board_from_straight * Eigen::Vector2d(x_m - board.ramp_edge_x_m, y_m);
        wrong += std::abs(turned.HeightAt(at.x(), at.y()) - straight.HeightAt(x_m, y_m)) > 1e-12;
        Eigen::Vector3d normal = straight.NormalAt(x_m, y_m);
        normal.head<2>() = board_from_straight * normal.head<2>().eval();
        wrong += (turned.NormalAt(at.x(), at.y()) - normal).norm() > 1e-9;
        const auto plane = turned.PlaneNear(at.x(), at.y(), reach_m);
        wrong += plane.has_value() != straight.PlaneNear(x_m, y_m, reach_m).has_value();
        if (!plane) continue;
        ++planes;
        for (int corner = 0; corner < 8; ++corner) {
          const Eigen::Vector2d there =
              at + reach_m * (Eigen::Rotation2Dd(0.25 * std::numbers::pi * corner) *
                              Eigen::Vector2d::UnitX());
          const Eigen::Vector3d point(there.x(), there.y(), turned.HeightAt(there.x(), there.y()));
          wrong += std::abs(plane->normal.dot(point - plane->point)) > 1e-12;
        }
      }
    }
    CHECK(wrong == 0);
    CHECK(planes > 250);
  }
}

TEST_CASE("The plane of a table ends at its edges, on every side") {
  TerrainOptions options;
  options.table_half_size_m = 1.0;
  const Terrain terrain(options);
  for (const double sign : {-1.0, 1.0}) {
    CHECK(terrain.PlaneNear(sign * 0.9, 0.0, 0.02));
    CHECK(terrain.PlaneNear(0.0, sign * 0.9, 0.02));
    CHECK_FALSE(terrain.PlaneNear(sign * 0.99, 0.0, 0.02));
    CHECK_FALSE(terrain.PlaneNear(0.0, sign * 0.99, 0.02));
  }
}

TEST_CASE("Blocks stand on a grid in both directions") {
  const Terrain terrain = Named("bump");
  CHECK(terrain.HeightAt(0.0, 0.0) == 0.004);
  CHECK(terrain.HeightAt(0.009, -0.009) == 0.004);
  CHECK(terrain.HeightAt(0.011, 0.0) == 0.0);
  CHECK(terrain.HeightAt(0.30, 0.18) == 0.004);
  CHECK(terrain.HeightAt(0.30, 0.15) == 0.0);
}

TEST_CASE("A patch has the grip of its own and the last one counts") {
  TerrainOptions options;
  PatchOptions wet{-1.0, 1.0, -1.0, 1.0, 0.3, 0.0, 0.0}, ice{0.0, 0.1, 0.0, 0.1, 0.05, 0.0, 0.0};
  options.patches = {wet, ice};
  const Terrain terrain(options);
  CHECK(terrain.GripAt(2.0, 0.0).mu == 0.8);
  CHECK(terrain.GripAt(0.5, 0.5).mu == 0.3);
  CHECK(terrain.GripAt(0.05, 0.05).mu == 0.05);
  wet.x_max_m = -2.0;
  CHECK_THROWS_WITH(wet.Check(), "x_min_m is -1, but it must lie below x_max_m, -2");
  wet = {-3.0, 1.0, 0.25, 0.25, 0.3, 0.0, 0.0};
  CHECK_THROWS_WITH(wet.Check(), "y_min_m is 0.25, but it must lie below y_max_m, 0.25");
}

TerrainOptions Heightfield() { return HeightfieldOptions(2.0, 0.1); }

TEST_CASE("A heightfield is linear between its pixels with its first row at large y") {
  const auto image = std::make_shared<HeightImage>(HeightImage{3,
                                                               2,
                                                               {0.0, 0.5, 1.0,  //
                                                                0.0, 0.0, 0.0}});
  const Terrain terrain(Heightfield(), image);  // 2 m x 1 m about the origin
  CHECK(terrain.HeightAt(1.0, 0.5) == Approx(0.1));
  CHECK(terrain.HeightAt(-1.0, 0.5) == Approx(0.0));
  CHECK(terrain.HeightAt(0.5, 0.5) == Approx(0.075));
  CHECK(terrain.HeightAt(1.0, 0.0) == Approx(0.05));
  CHECK(terrain.HeightAt(1.0, -0.5) == Approx(0.0));
  CHECK(terrain.HeightAt(1.2, 0.5) == 0.0);
  CHECK_THROWS_WITH(Terrain(Heightfield()), Catch::Contains("heightfield"));
}

TEST_CASE("A wheel on a plane touches with its lowest point along the normal") {
  const Terrain terrain = Named("downhill");
  const double radius_m = 0.016, sunk_m = 1e-5;
  const Eigen::Vector3d ground(0.5, 0.0, terrain.HeightAt(0.5, 0.0));
  const Eigen::Vector3d normal = terrain.NormalAt(0.5, 0.0);
  const auto contact = WheelContactPoint(terrain, ground + (radius_m - sunk_m) * normal,
                                         Eigen::Vector3d::UnitY(), radius_m, 0.0068);
  REQUIRE(contact);
  CHECK(contact->depth_m == Approx(sunk_m));
  CHECK((contact->point - (ground - sunk_m * normal)).norm() < 1e-9);
  CHECK_FALSE(WheelContactPoint(terrain, ground + (radius_m + sunk_m) * normal,
                                Eigen::Vector3d::UnitY(), radius_m, 0.0068));
}

TEST_CASE("Away from planes the profile finds the same contact as the plane does") {
  const auto image = std::make_shared<HeightImage>(HeightImage{2, 2, {0.0, 1.0, 0.0, 1.0}});
  const Terrain terrain(Heightfield(), image);  // slope of 0.05 towards +x
  const double radius_m = 0.016, sunk_m = 1e-5;
  const Eigen::Vector3d ground(0.0, 0.0, terrain.HeightAt(0.0, 0.0));
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.05, 0.0, 1.0).normalized();
  for (const Eigen::Vector3d& axle :
       {Eigen::Vector3d(0.0, 1.0, 0.0), Eigen::Vector3d(0.6, 0.8, 0.0)}) {
    const auto contact =
        WheelContactPoint(terrain, ground + (radius_m - sunk_m) * normal, axle, radius_m, 0.0);
    REQUIRE(contact);
    CHECK((contact->normal - normal).norm() < 1e-3);
    CHECK(contact->depth_m == Approx(sunk_m).margin(2e-5));
  }
}

TEST_CASE(
    "The paper's surfaces have the friction, the resistance and the slip that are documented") {
  struct Row {
    const char* name;
    Shape shape;
    double mu, rolling_resistance, slip;
  };
  const auto surfaces = PaperSurfaces();
  CHECK(surfaces.size() == 7);
  for (const Row& row : {Row{"ground", Shape::kFlat, 0.8, 0.01, 0.01},
                         {"cardboard", Shape::kFlat, 0.8, 0.02, 0.01},
                         {"parchment", Shape::kFlat, 0.4, 0.01, 0.02},
                         {"wet_parchment", Shape::kFlat, 0.3, 0.02, 0.04},
                         {"uphill", Shape::kRampUp, 0.7, 0.01, 0.01},
                         {"downhill", Shape::kRampDown, 0.7, 0.01, 0.01},
                         {"bump", Shape::kBumps, 0.85, 0.02, 0.01}}) {
    INFO(row.name);
    const SurfaceOptions& surface = surfaces.at(row.name);
    CHECK(surface.shape == row.shape);
    CHECK(surface.mu == row.mu);
    CHECK(surface.rolling_resistance == row.rolling_resistance);
    CHECK(surface.slip == row.slip);
    CHECK(surface.ramp_edge_x_m == (row.shape == Shape::kRampUp ? 0.31 : 0.05));
  }
}

TEST_CASE(
    "A plane is found wherever no edge, bend or foot of the board is in reach, and nowhere else") {
  const double bend_m = GENERATE(0.0, 0.2), reach_m = 0.03, foot_m = 0.24 / std::tan(0.255);
  for (const Shape shape : {Shape::kRampDown, Shape::kRampUp}) {
    TerrainOptions options;
    options.surfaces["ground"].shape = shape;
    options.surfaces["ground"].ramp_bend_m = bend_m;
    const Terrain terrain(options);
    const double ahead = shape == Shape::kRampDown ? 1.0 : -1.0;
    int wrong = 0;
    for (double past_m = -0.5; past_m < 1.5; past_m += 0.0017) {
      const bool near_bend = past_m > -0.5 * bend_m - reach_m && past_m < 0.5 * bend_m + reach_m;
      const bool near_foot = std::abs(past_m - foot_m) < reach_m;
      const auto plane = terrain.PlaneNear(0.05 + ahead * past_m, 0.3, reach_m);
      wrong += plane.has_value() == (near_bend || near_foot);
      if (!plane) continue;
      const bool on_slope = past_m > 0.0 && past_m < foot_m;
      wrong += std::abs(plane->normal.x() - (on_slope ? ahead * std::sin(0.255) : 0.0)) > 1e-12;
      wrong += plane->point.y() != 0.3;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("A patch holds a wheel in its own way, on ground as uneven as elsewhere") {
  TerrainOptions options;
  options.surfaces["ground"].unevenness = 0.07;
  options.surfaces["ground"].caster_factor = 3.0;
  options.patches = {{0.0, 0.1, 0.2, 0.4, 0.25, 0.05, 0.125}};
  const Terrain terrain(options);
  const Grip on = terrain.GripAt(0.1, 0.4), off = terrain.GripAt(0.1 + 1e-9, 0.3);
  CHECK((on.mu == 0.25 && on.rolling_resistance == 0.05 && on.slip == 0.125));
  CHECK((on.caster_factor == 1.0 && on.unevenness == 0.07));
  CHECK((off.mu == 0.8 && off.rolling_resistance == 0.01 && off.slip == 0.01));
  CHECK((off.caster_factor == 3.0 && off.unevenness == 0.07));
  CHECK(terrain.GripAt(-1e-9, 0.3).mu == 0.8);
  CHECK(terrain.GripAt(0.05, 0.2 - 1e-9).mu == 0.8);
  CHECK(terrain.GripAt(0.05, 0.4 + 1e-9).mu == 0.8);
}

TEST_CASE(
    "The blocks near a point are all of the grid that reach into the square, up to eight in a "
    "row") {
  const Terrain terrain = Named("bump");
  for (const auto& [x_m, y_m, reach_m] :
       {std::tuple{0.013, -0.207, 0.11}, {-0.4, 0.33, 0.05}, {0.0, 0.0, 0.2}}) {
    const auto found = terrain.BlocksNear(x_m, y_m, reach_m);
    REQUIRE(found);
    std::size_t expected = 0;
    for (int i = -20; i <= 20; ++i) {
      for (int j = -20; j <= 20; ++j) {
        const bool reaches = std::abs(0.06 * i - x_m) <= reach_m + 0.01 &&
                             std::abs(0.06 * j - y_m) <= reach_m + 0.01;
        expected += reaches;
        const bool is_found = std::any_of(found->begin(), found->end(), [&](const Block& block) {
          return std::abs(block.x_m - 0.06 * i) < 1e-9 && std::abs(block.y_m - 0.06 * j) < 1e-9;
        });
        CHECK(is_found == reaches);
      }
    }
    CHECK(found->size() == expected);
    CHECK((found->front().half_size_m == 0.01 && found->front().height_m == 0.004));
  }
  CHECK(terrain.BlocksNear(0.0, 0.0, 0.2299));
  CHECK_FALSE(terrain.BlocksNear(0.0, 0.0, 0.2301));
}

TEST_CASE("A heightfield lies about its middle, and around it is the floor") {
  TerrainOptions options = Heightfield();
  options.surfaces["ground"].image_x_m = 3.0;
  options.surfaces["ground"].image_y_m = -1.0;
  const auto image = std::make_shared<HeightImage>(
      HeightImage{3, 3, {0.0, 0.1, 0.2, 0.3, 0.5, 0.8, 0.4, 0.7, 1.0}});
  const Terrain terrain(options, image);  // a pixel is a metre
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      CHECK(terrain.HeightAt(2.0 + column, 0.0 - row) ==
            Approx(0.1 * image->samples[static_cast<std::size_t>(3 * row + column)]));
    }
  }
  CHECK(terrain.HeightAt(3.25, -1.5) ==
        Approx(0.1 * (0.5 * (0.5 + 0.25 * 0.3) + 0.5 * (0.7 + 0.25 * 0.3))));
  for (const auto& [x_m, y_m] : {std::pair{1.99, -1.0}, {4.01, -1.0}, {3.0, 0.01}, {3.0, -2.01}}) {
    CHECK(terrain.HeightAt(x_m, y_m) == 0.0);
  }
  const Eigen::Vector3d normal = terrain.NormalAt(3.5, -1.0);
  CHECK(-normal.x() / normal.z() == Approx(0.03));
  CHECK(-normal.y() / normal.z() == Approx(0.5 * (0.1 * (0.15 - 0.65) + 0.1 * (0.65 - 0.85))));
  for (const auto& [columns, rows] : {std::pair{1, 4}, {4, 1}, {2, 3}}) {
    CHECK_THROWS_WITH(Terrain(options, std::make_shared<HeightImage>(
                                           HeightImage{columns, rows, {0.0, 0.0, 0.0, 0.0}})),
                      "surface 'ground' is a heightfield, but no image of at least 2 x 2 pixels is "
                      "given");
  }
}

TEST_CASE("What is wrong with a surface is said with its rule") {
  SurfaceOptions surface;
  surface.bump_size_m = surface.bump_pitch_m;
  CHECK_NOTHROW(surface.Check());
  surface.bump_size_m = 0.07;
  CHECK_THROWS_WITH(surface.Check(),
                    "bump_size_m is 0.07, but a block must not be wider than bump_pitch_m, 0.06");
  surface = {};
  surface.shape = Shape::kHeightfield;
  CHECK_THROWS_WITH(surface.Check(),
                    "image is empty, but a surface of shape heightfield needs a PNG");
  TerrainOptions options;
  options.surfaces = {{"ice", {}}, {"sand", {}}};
  options.surface = "mud";
  CHECK_THROWS_WITH(options.Check(), "surface is 'mud', but it must be one of: ice, sand");
}

TEST_CASE("At the edge of a table the ground ends and leans no way") {
  TerrainOptions options;
  options.surface = "downhill";
  options.table_half_size_m = 0.5;
  const Terrain terrain(options);
  CHECK(std::isfinite(terrain.HeightAt(0.5, -0.5)));
  CHECK(std::isinf(terrain.HeightAt(0.5 + 1e-9, 0.0)));
  CHECK(std::isinf(terrain.HeightAt(0.0, -0.5 - 1e-9)));
  CHECK(terrain.NormalAt(0.49, 0.0).x() == Approx(std::sin(0.255)));
  CHECK(terrain.NormalAt(0.49985, 0.0).x() == 0.0);
  CHECK(terrain.NormalAt(0.49975, 0.0).x() == Approx(std::sin(0.255)));
}

}  // namespace
}  // namespace rift::simulation
