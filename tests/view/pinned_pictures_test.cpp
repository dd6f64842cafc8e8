#include <catch2/catch.hpp>
#include <cmath>

#include "rift/geometry/pose2.hpp"
#include "rift/vision/calibration/live_views.hpp"
#include "support/inputs/paper_camera.hpp"
#include "support/pinned_picture.hpp"
#include "view/calibration_picture.hpp"
#include "view/painter.hpp"
#include "view/track_picture.hpp"

namespace rift::view {
namespace {

using rift::test::DifferenceFromPinnedPicture;

/// A turn to the left over a slope with a step, a hole and two patches, and no two numbers alike.
Run UnevenRun() {
  Run run;
  run.title = "uneven ground, no two numbers alike";
  run.waypoints = {{"start", {0.0, 0.0}}, {"side", {0.35, 0.05}}, {"end", {0.3, 0.3}}};
  run.reference_m = {{0.0, 0.0}, {0.35, 0.05}, {0.3, 0.3}};
  run.patches = {{"ice", 0.1, 0.22, -0.05, 0.12}, {"mud", 0.25, 0.6, 0.2, 0.26}};
  run.height_at = [](double x_m, double y_m) -> double {
    if (std::hypot(x_m - 0.05, y_m - 0.25) < 0.05) return -HUGE_VAL;
    return 0.08 * std::max(0.0, x_m) + (y_m > 0.1 ? 0.02 : 0.0);
  };
  for (int i = 0; i <= 30; ++i) {
    const double yaw_rad = 0.05 * i;
    run.truth.poses.push_back({.t_s = 2.0 + 0.1 * i,
                               .x_m = 0.25 * std::sin(yaw_rad),
                               .y_m = 0.25 * (1.0 - std::cos(yaw_rad)),
                               .z_m = 0.03,
                               .roll_rad = 0.2,
                               .pitch_rad = -0.3,
                               .yaw_rad = yaw_rad,
                               .target_x_m = i < 15 ? 0.35 : 0.3,
                               .target_y_m = i < 15 ? 0.05 : 0.3});
  }
  run.logged = run.truth;
  for (trajectory::StampedPose& pose : run.logged.poses) pose.y_m += 0.01;
  run.logged.channels = {{"power_left", std::vector<double>(31, -0.4)},
                         {"power_right", std::vector<double>(31, 0.75)}};
  run.outcome = "timeout";
  return run;
}

TEST_CASE("The picture of a simulated run is the pinned one") {
  const Film film = MakeFilm(UnevenRun());
  const Painter painter(film.fixed, {1280, 720});
  CHECK(DifferenceFromPinnedPicture(
            "view/run.png", painter.Paint(film.scenes[film.scenes.size() / 3],
                                          {"space: stop   arrows: speed", "q: end"})) == "");
  CHECK(DifferenceFromPinnedPicture("view/run_end.png", painter.Paint(film.scenes.back())) == "");
  const Painter small(film.fixed, {640, 480});
  CHECK(DifferenceFromPinnedPicture("view/run_small.png", small.Paint(film.scenes[40])) == "");
}

/// The paper's camera, in front of it a floor that brightens to one side.
vision::Frame FloorFrame(const vision::CameraModel& camera) {
  vision::Frame frame{.width_px = camera.width_px, .height_px = camera.height_px};
  for (int row = 0; row < frame.height_px; ++row) {
    for (int column = 0; column < frame.width_px; ++column) {
      frame.bytes.push_back(static_cast<std::uint8_t>(60 + 60 * column / frame.width_px +
                                                      30 * row / frame.height_px));
    }
  }
  return frame;
}

vision::Sighting TagAt(const vision::CameraModel& camera, int id, const geometry::Pose2& at) {
  vision::Sighting sighting;
  sighting.tag_id = id;
  sighting.in_world = true;
  sighting.map_from_tag.translation() = Eigen::Vector3d(at.x_m, at.y_m, 0.03);
  sighting.map_from_tag.linear() =
      Eigen::AngleAxisd(at.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const std::array<Eigen::Vector3d, 4> corners{
      {{-0.024, 0.024, 0.0}, {0.024, 0.024, 0.0}, {0.024, -0.024, 0.0}, {-0.024, -0.024, 0.0}}};
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d p_in_camera =
        vision::MapFromCamera(camera).inverse() * (sighting.map_from_tag * corners[i]);
    sighting.corners[i] = vision::PixelsFromPoints(camera, {p_in_camera}).front();
  }
  return sighting;
}

TrackScene TwoRobots(const vision::CameraModel& camera, const vision::Frame& frame) {
  TrackScene scene{.camera = &camera, .frame = &frame};
  scene.robots = {{3, TagAt(camera, 3, {0.2, 0.06, 0.4}), {{0.0, 0.01}, {0.1, 0.04}, {0.2, 0.06}}},
                  {11, TagAt(camera, 11, {-0.3, -0.15, -2.0}), {{-0.25, 0.0}, {-0.3, -0.15}}}};
  scene.robots[0].beside = {
      {{{0.0, 0.01}, {0.0, 0.0}}, {{0.1, 0.04}, {0.1, 0.0}}, {{0.2, 0.06}, {0.2, 0.0}}}, 0.06};
  scene.robots[1].sighting->tags_of_this_id = 2;
  scene.path_m = {{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.3}};
  scene.waypoints = {{"start", {0.0, 0.0}}, {"corner", {0.4, 0.0}}, {"goal", {0.4, 0.3}}};
  scene.stand_at = geometry::Pose2{-0.4, 0.25, 0.8};
  scene.plane_z_m = 0.03;
  scene.status = {.state = vision::CameraState::kRunning, .rate_hz = 29.97, .dropped = 4};
  scene.latency_s = 0.0234;
  scene.prompts = {"the camera was moved"};
  return scene;
}

TEST_CASE("The window of tracking is the pinned one") {
  vision::CameraModel camera = rift::test::PaperCamera();
  const vision::Frame frame = FloorFrame(camera);
  TrackScene scene = TwoRobots(camera, frame);
  CHECK(DifferenceFromPinnedPicture("view/track.png", DrawTrack(scene).bgr) == "");
  scene.robots.pop_back();
  scene.frame = nullptr;
  scene.stand_at.reset();
  CHECK(DifferenceFromPinnedPicture("view/track_one.png", DrawTrack(scene).bgr) == "");
}

TEST_CASE("A picture wider than 1280 px is shown smaller, with everything at its place") {
  vision::CameraModel camera = rift::test::PaperCamera();
  camera.width_px *= 2;
  camera.height_px *= 2;
  camera.k.topRows(2) *= 2.0;
  const vision::Frame frame = FloorFrame(camera);
  const TrackPicture drawn = DrawTrack(TwoRobots(camera, frame));
  CHECK(drawn.bgr.cols == 1280);
  CHECK(drawn.px_per_shown == Approx(camera.width_px / 1280.0));
  CHECK(DifferenceFromPinnedPicture("view/track_wide.png", drawn.bgr) == "");
}

TEST_CASE("The words over a tracked picture say each robot, its path and the camera") {
  const vision::CameraModel camera = rift::test::PaperCamera();
  TrackScene scene = TwoRobots(camera, {});
  scene.frame = nullptr;
  CHECK(WordsOf(scene) ==
        std::vector<std::string>{"tag 3: x +0.2000 m   y +0.0600 m   yaw  +22.9 deg",
                                 "tag 11: x -0.3000 m   y -0.1500 m   yaw -114.6 deg",
                                 "tag 11: 2 tags of this id!",
                                 "off the path 60.0 mm left   largest 60.0 mm",
                                 "running   30.0 Hz   latency 23 ms   dropped 4"});
  scene.robots[0].sighting.reset();
  scene.path_m.clear();
  scene.latency_s = std::nan("");
  scene.status.reason = "it repeats its pictures";
  CHECK(WordsOf(scene) ==
        std::vector<std::string>{
            "tag 3: not seen", "tag 11: x -0.3000 m   y -0.1500 m   yaw -114.6 deg",
            "tag 11: 2 tags of this id!", "running   30.0 Hz   recording   dropped 4",
            "it repeats its pictures"});
  scene.robots.erase(scene.robots.begin());
  scene.robots[0].sighting->in_world = false;
  scene.robots[0].sighting->tags_of_this_id = 1;
  scene.status.reason.clear();
  CHECK(WordsOf(scene) == std::vector<std::string>{"x -0.3000 m   y -0.1500 m   yaw -114.6 deg",
                                                   "z +0.0300 m   camera frame, y up",
                                                   "running   30.0 Hz   recording   dropped 4"});
  scene.robots[0].sighting.reset();
  CHECK(WordsOf(scene).front() == "no tag");
  scene.robots.clear();
  CHECK(WordsOf(scene).front() == "no tag");
}

TEST_CASE("The window of a calibration is the pinned one") {
  vision::CameraModel camera = rift::test::PaperCamera();
  const vision::Frame frame = FloorFrame(camera);
  std::vector<vision::BoardView> taken(2);
  vision::BoardView searched;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      taken[0].corners.emplace_back(80 + 30 * column, 300 + 34 * row);
      taken[1].corners.emplace_back(600 + 40 * column + 5 * row, 320 + 30 * row);
      searched.corners.emplace_back(330 + 40 * column, 330 + 38 * row + 3 * column);
    }
  }
  vision::LiveScene scene{.frame = &frame,
                          .searched = &searched,
                          .taken = &taken,
                          .board = {.columns = 4, .rows = 3, .square_m = 0.03},
                          .coverage = {.x = 0.3, .y = 0.9, .size = 0.0, .skew = 0.6},
                          .takes_by_itself = false,
                          .good_views = 12,
                          .good_coverage = 0.7};
  scene.next = {{0.7, 0.3, 0.4, 0.3}, "to the right and tilted"};
  scene.advice = "hold it still";
  CHECK(DifferenceFromPinnedPicture("view/calibration.png", DrawCalibrating(scene)) == "");
  scene.next = {};
  scene.takes_by_itself = true;
  scene.good_views = 2;
  scene.advice.clear();
  scene.status.reason = "it sees no light";
  CHECK(DifferenceFromPinnedPicture("view/calibration_covered.png", DrawCalibrating(scene)) == "");
}

}  // namespace
}  // namespace rift::view
