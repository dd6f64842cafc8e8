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
  run.height_at = [](double, double) { return -HUGE_VAL; };  // where there is no ground
  CHECK(SceneAt(run, 2.0).z_m == run.body.wheel_radius_m);
  run.height_at = {};
  CHECK(SceneAt(run, 2.0).z_m == run.body.wheel_radius_m);
}

TEST_CASE("Between two poses of one time there is no speed, and the first is shown") {
  Run run;
  run.truth.poses = {{.t_s = 4.0, .x_m = 1.0, .y_m = 2.0, .z_m = 0.0, .yaw_rad = 0.5},
                     {.t_s = 4.0, .x_m = 3.0, .y_m = 5.0, .z_m = 0.0, .yaw_rad = 1.5}};
  const Scene scene = SceneAt(run, 0.0);
  CHECK(std::isnan(scene.speed_mps));
  CHECK((scene.world_from_robot.x_m == 1.0 && scene.world_from_robot.y_m == 2.0));
  CHECK(scene.world_from_robot.yaw_rad == 0.5);
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
  ViewOptions options;
  options.margin_m = 0.25;
  const Ground ground = MakeFilm(run, options).fixed.ground;
  CHECK(ground.columns * ground.rows < 2'000'000);
  CHECK(ground.cell_m == Approx((900.0 + 2.0 * (0.25 + run.body.chassis_radius_m)) / 1200.0));
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
  ViewOptions fast;
  fast.fps = 240;
  run.truth.poses = {run.truth.poses.front(), run.truth.poses.back()};
  run.truth.poses.back().t_s = run.truth.poses.front().t_s + 100'000 / 240.0;
  CHECK(MakeFilm(run, fast).scenes.size() == 100'000);
  run.truth.poses.back().t_s += 1 / 240.0;
  CHECK_THROWS_WITH(MakeFilm(run, fast), Contains("has 100001 pictures, but at most 100000"));
  run.truth.poses.back().yaw_rad = NAN;
  CHECK_THROWS_WITH(MakeFilm(run), Contains("yaw"));
  run.truth.poses.clear();
  CHECK_THROWS_AS(MakeFilm(run), std::invalid_argument);
  ViewOptions odd;
  odd.width_px = 1281;
  CHECK_THROWS_WITH(MakeFilm(StraightRun(), odd), Contains("width_px is 1281"));
}

TEST_CASE("A scene has its lean, height and speed from the poses about it, and no speed of one") {
  Run run;
  run.truth.poses = {{.t_s = 3.0,
                      .x_m = 0.0,
                      .y_m = 0.0,
                      .z_m = 0.5,
                      .roll_rad = 0.1,
                      .pitch_rad = -0.2,
                      .yaw_rad = 0.0},
                     {.t_s = 5.0,
                      .x_m = 0.3,
                      .y_m = 0.4,
                      .z_m = 1.7,
                      .roll_rad = 0.3,
                      .pitch_rad = 0.2,
                      .yaw_rad = 1.0},
                     {.t_s = 6.0,
                      .x_m = 0.3,
                      .y_m = 0.4,
                      .z_m = 1.7,
                      .roll_rad = NAN,
                      .pitch_rad = NAN,
                      .yaw_rad = 1.0}};
  const Scene scene = SceneAt(run, 0.5);
  CHECK(scene.t_s == 0.5);
  CHECK(scene.z_m == Approx(0.8));
  CHECK(scene.roll_rad == Approx(0.15));
  CHECK(scene.pitch_rad == Approx(-0.1));
  CHECK(scene.speed_mps == Approx(std::hypot(0.5, 1.2) / 2.0));
  CHECK(SceneAt(run, 2.5).roll_rad == Approx(0.15));  // unknown is level
  CHECK(SceneAt(run, 2.5).speed_mps == 0.0);
  CHECK(SceneAt(run, -1.0).world_from_robot.x_m == 0.0);
  CHECK(SceneAt(run, 9.0).world_from_robot.x_m == 0.3);
  run.truth.poses.resize(1);
  CHECK(std::isnan(SceneAt(run, 0.0).speed_mps));
  CHECK(SceneAt(run, 0.0).z_m == 0.5);
}

TEST_CASE(
    "The newest row counts from its very time on, and a place is a target to the micrometre") {
  Run run = StraightRun();
  for (std::size_t i = 0; i < run.logged.poses.size(); ++i) {
    run.logged.poses[i].t_s = 5.0 + 0.25 * static_cast<double>(i);
    run.logged.channels[0].values[i] = 0.01 * static_cast<double>(i);
  }
  CHECK(SceneAt(run, 0.5).power.left == 0.02);
  CHECK(SceneAt(run, 0.5 - 1e-9).power.left == 0.01);
  CHECK(SceneAt(run, 0.5).trail_points == 3);
  run.logged.channels[0].values.resize(2);  // shorter than the log
  CHECK(std::isnan(SceneAt(run, 0.5).power.left));
  run.logged.poses[2].target_x_m += 0.9e-6;
  CHECK(SceneAt(run, 0.5).target == 1);
  run.logged.poses[2].target_x_m += 0.2e-6;
  CHECK(SceneAt(run, 0.5).target == -1);
  run.logged.poses[2].target_x_m = run.logged.poses[2].target_y_m = 0.0;
  CHECK(SceneAt(run, 0.5).target == 0);
  for (auto& pose : run.logged.poses) pose.t_s += 1.0;
  const Scene before = SceneAt(run, 0.5);
  CHECK((before.target == -1 && before.trail_points == 0 && std::isnan(before.power.right)));
}

TEST_CASE("The ground reaches by its margin around every point that is shown, in cells of a size") {
  Run run = StraightRun();
  run.waypoints.push_back({"aside", {0.1, -0.6}});
  run.reference_m = {{0.0, 0.7}, {NAN, 5.0}};
  run.height_at = [](double x_m, double y_m) { return 0.01 * x_m + 0.1 * y_m; };
  ViewOptions options;
  options.margin_m = 0.1;
  options.ground_cell_m = 0.02;
  const StaticScene fixed = MakeFilm(run, options).fixed;
  const Ground& ground = fixed.ground;
  const double margin_m = 0.1 + run.body.chassis_radius_m;
  CHECK(ground.x_min_m == Approx(-margin_m));
  CHECK(ground.y_min_m == Approx(-0.6 - margin_m));
  CHECK(ground.cell_m == 0.02);
  CHECK(ground.columns == static_cast<int>(std::ceil((0.4 + 2.0 * margin_m) / 0.02)) + 1);
  CHECK(ground.rows == static_cast<int>(std::ceil((1.3 + 2.0 * margin_m) / 0.02)) + 1);
  CHECK(ground.At(3, 7) == Approx(0.01 * (ground.x_min_m + 0.06) + 0.1 * (ground.y_min_m + 0.14)));
  const double highest_m = ground.At(ground.columns - 1, ground.rows - 1);
  CHECK(fixed.top_m == Approx(highest_m + 0.016 - 0.011 + 0.0266 + 0.0484));
  run.height_at = {};
  const StaticScene level = MakeFilm(run, options).fixed;
  CHECK(level.top_m == Approx(0.016 - 0.011 + 0.0266 + 0.0484));
  CHECK(level.ground.At(0, 0) == 0.0F);
  CHECK(level.trail_m.size() == 41);
  options.height_px = 721;
  CHECK_THROWS_WITH(MakeFilm(run, options), "height_px is 721, but it must be even");
}

TEST_CASE("The outline of a robot is its simulation's, member by member") {
  simulation::BodyOptions body;
  body.chassis_radius_m = 0.1;
  body.chassis_height_m = 0.2;
  body.rim_clearance_m = 0.01;
  body.wheel_radius_m = 0.03;
  body.wheel_width_m = 0.04;
  body.track_m = 0.05;
  const BodyShape shape = ShapeOf(body);
  CHECK((shape.chassis_radius_m == 0.1 && shape.chassis_height_m == 0.2));
  CHECK(shape.chassis_bottom_m == Approx(-0.02));
  CHECK((shape.wheel_radius_m == 0.03 && shape.wheel_width_m == 0.04 && shape.track_m == 0.05));
}

TEST_CASE("From the first row of a log on its powers and its waypoint are known") {
  Run run = StraightRun();
  const Scene scene = SceneAt(run, 0.0);
  CHECK(scene.power.left == 0.2);
  CHECK(scene.power.right == 0.18);
  CHECK(scene.target == 1);
  for (auto& pose : run.logged.poses) pose.t_s += 0.01;
  const Scene before = SceneAt(run, 0.0);
  CHECK(std::isnan(before.power.left));
  CHECK(before.target == -1);
}

}  // namespace
}  // namespace rift::view
