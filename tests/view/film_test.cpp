#include "rift/view/film.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "view/synthetic_run.hpp"

namespace rift::view {
namespace {

using Catch::Matchers::Contains;
using synthetic::StraightRun;

TEST_CASE("A film has as many pictures as duration times rate") {
  ViewOptions options;
  options.fps = GENERATE(1, 25, 30, 60);
  CHECK(MakeFilm(StraightRun(), options).scenes.size() == 2U * options.fps);
}

TEST_CASE("The last picture shows the end and how the run ended and no other does") {
  const Film film = MakeFilm(StraightRun());
  CHECK(film.scenes.back().t_s == Approx(2.0));
  CHECK(film.scenes.back().world_from_robot.x_m == Approx(0.4));
  CHECK(film.scenes.back().outcome == "reached");
  CHECK(film.scenes.back().trail_points == 41);
  CHECK(film.scenes[film.scenes.size() - 2].outcome.empty());
}

TEST_CASE("A scene lies between two poses and turns the short way round") {
  Run run;
  run.truth.poses = {{.t_s = 1.0, .x_m = 0.0, .y_m = 0.0, .yaw_rad = 3.1},
                     {.t_s = 2.0, .x_m = 1.0, .y_m = -2.0, .yaw_rad = -3.1}};
  const Scene scene = SceneAt(run, 0.25);
  CHECK(scene.world_from_robot.x_m == Approx(0.25));
  CHECK(scene.world_from_robot.y_m == Approx(-0.5));
  CHECK(scene.world_from_robot.yaw_rad == Approx(3.1 + 0.25 * (2.0 * M_PI - 6.2)));
  CHECK(scene.speed_mps == Approx(std::hypot(1.0, 2.0)));
}

TEST_CASE("A scene knows the powers and the waypoint of the newest row") {
  Run run = StraightRun();
  Scene scene = SceneAt(run, 1.0);
  CHECK(scene.power.left == 0.2);
  CHECK(scene.power.right == 0.18);
  CHECK(scene.target == 1);
  run.truth.channels = {{"power_left", std::vector<double>(41, 0.5)}};
  CHECK(SceneAt(run, 1.0).power.left == 0.5);
  run.logged = {};
  scene = SceneAt(run, 1.0);
  CHECK(std::isnan(scene.power.right));
  CHECK(scene.target == -1);
}

TEST_CASE("The trail grows with what has been measured") {
  const Run run = StraightRun();
  CHECK(SceneAt(run, 0.0).trail_points == 1);
  CHECK(SceneAt(run, 1.01).trail_points == 21);
}

TEST_CASE("A robot of unknown height stands on the ground") {
  Run run = StraightRun();
  run.height_at = [](double x_m, double) { return 0.5 * x_m; };
  for (auto& pose : run.truth.poses) pose.z_m = NAN;
  CHECK(SceneAt(run, 2.0).z_m == Approx(0.2 + run.body.wheel_radius_m));
}

TEST_CASE("The ground is sampled around path and waypoints with a margin") {
  Run run = StraightRun();
  run.height_at = [](double x_m, double) { return x_m > 0.2 ? 0.01 : 0.0; };
  ViewOptions options;
  options.margin_m = 0.05;
  const Ground ground = MakeFilm(run, options).fixed.ground;
  CHECK(ground.x_min_m == Approx(-0.05 - run.body.chassis_radius_m));
  CHECK(ground.x_min_m + (ground.columns - 1) * ground.cell_m >= 0.45);
  CHECK(ground.At(0, 0) == 0.0F);
  CHECK(ground.At(ground.columns - 1, ground.rows - 1) == 0.01F);
}

TEST_CASE("A wide world is sampled coarsely rather than without end") {
  Run run = StraightRun();
  run.waypoints.push_back({"far", {900.0, -900.0}});
  const Ground ground = MakeFilm(run).fixed.ground;
  CHECK(ground.columns * ground.rows < 2'000'000);
}

TEST_CASE("A single pose makes a film of one picture") {
  Run run = StraightRun();
  run.truth.poses.resize(1);
  const Film film = MakeFilm(run);
  REQUIRE(film.scenes.size() == 1);
  CHECK(film.scenes[0].outcome == "reached");
}

TEST_CASE("What cannot be filmed is refused in one line") {
  Run run = StraightRun();
  run.truth.poses.back().t_s = 1e6;
  CHECK_THROWS_WITH(MakeFilm(run), Contains("at most 100000") && Contains("lower fps"));
  run.truth.poses.back().yaw_rad = NAN;
  CHECK_THROWS_WITH(MakeFilm(run), Contains("yaw"));
  run.truth.poses.clear();
  CHECK_THROWS_AS(MakeFilm(run), std::invalid_argument);
  ViewOptions odd;
  odd.width_px = 1281;
  CHECK_THROWS_WITH(MakeFilm(StraightRun(), odd), Contains("width_px is 1281"));
}

}  // namespace
}  // namespace rift::view
