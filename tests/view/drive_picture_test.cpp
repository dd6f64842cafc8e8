#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <opencv2/core.hpp>

#include "support/inputs/paper_camera.hpp"
#include "view/camera_picture.hpp"
#include "view/track_picture.hpp"

namespace rift::view {
namespace {

TEST_CASE("Where a robot has to stand is drawn as its outline around the place and nowhere else") {
  const vision::CameraModel camera = test::PaperCamera();
  TrackScene scene{.camera = &camera};
  const TrackPicture empty = DrawTrack(scene);
  scene.stand_at = geometry::Pose2{0.2, 0.1, 0.5};
  const TrackPicture drawn = DrawTrack(scene);
  cv::Mat differs;
  cv::extractChannel(empty.bgr != drawn.bgr, differs, 1);
  std::vector<cv::Point> changed;
  cv::findNonZero(differs, changed);
  REQUIRE(changed.size() > 100);

  const Eigen::Vector3d middle_in_camera =
      vision::MapFromCamera(camera).inverse() * Eigen::Vector3d(0.2, 0.1, 0.0);
  const Eigen::Vector2d middle =
      vision::PixelsFromPoints(camera, {middle_in_camera}).front() / drawn.px_per_shown;
  const double metre_px = camera.k(0, 0) / middle_in_camera.z() / drawn.px_per_shown;
  double farthest_m = 0.0, ahead_m = 0.0;
  for (const cv::Point& pixel : changed) {
    const Eigen::Vector2d off = (Eigen::Vector2d(pixel.x, pixel.y) - middle) / metre_px;
    farthest_m = std::max(farthest_m, off.norm());
    ahead_m = std::max(ahead_m, off.dot(Eigen::Vector2d(std::cos(0.5), -std::sin(0.5))));
  }
  CHECK(farthest_m < 0.075);
  CHECK(farthest_m == Approx(ahead_m).margin(0.006));  // the nose
  CHECK(ahead_m > 0.055);
}

/// A tag that lies on the floor at x, y, as the camera sees it.
vision::Sighting TagAt(const vision::CameraModel& camera, int id, double x_m, double y_m) {
  constexpr double kHalf_m = 0.025;
  vision::Sighting sighting;
  sighting.tag_id = id;
  sighting.map_from_tag.translation() = Eigen::Vector3d(x_m, y_m, 0.0);
  const std::array<Eigen::Vector2d, 4> corners{Eigen::Vector2d{-kHalf_m, kHalf_m},
                                               {kHalf_m, kHalf_m},
                                               {kHalf_m, -kHalf_m},
                                               {-kHalf_m, -kHalf_m}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d p_in_map(x_m + corners[i].x(), y_m + corners[i].y(), 0.0);
    sighting.corners[i] =
        vision::PixelsFromPoints(camera, {vision::MapFromCamera(camera).inverse() * p_in_map})
            .front();
  }
  return sighting;
}

/// Pixels of the green of an outline within some px of a point of the camera's picture.
int GreenNear(const TrackPicture& drawn, const Eigen::Vector2d& pixel) {
  constexpr int kNear_px = 3;
  const Eigen::Vector2d shown = pixel / drawn.px_per_shown;
  const cv::Rect around(cvRound(shown.x()) - kNear_px, cvRound(shown.y()) - kNear_px,
                        2 * kNear_px + 1, 2 * kNear_px + 1);
  cv::Mat found;
  cv::inRange(drawn.bgr(around), cv::Scalar(30, 200, 30), cv::Scalar(60, 225, 60), found);
  return cv::countNonZero(found);
}

TEST_CASE("Every robot's tag is outlined with its trail, and one that is not seen is not") {
  const vision::CameraModel camera = test::PaperCamera();
  const vision::Sighting first = TagAt(camera, 0, -0.2, 0.1), second = TagAt(camera, 3, 0.2, -0.1);
  TrackScene scene{.camera = &camera,
                   .robots = {{.tag_id = 0, .sighting = first}, {.tag_id = 3, .sighting = second}}};
  const TrackPicture both = DrawTrack(scene);
  scene.robots[1].sighting.reset();
  const TrackPicture one = DrawTrack(scene);
  for (const Eigen::Vector2d& corner : first.corners) {
    CHECK(GreenNear(both, corner) > 3);
    CHECK(GreenNear(one, corner) > 3);
  }
  for (const Eigen::Vector2d& corner : second.corners) {
    CHECK(GreenNear(both, corner) > 3);
    CHECK(GreenNear(one, corner) == 0);
  }
  // Both trails, in red.
  const auto red = [](const TrackPicture& drawn) {
    cv::Mat found;
    cv::inRange(drawn.bgr, cv::Scalar(40, 40, 235), cv::Scalar(40, 40, 235), found);
    return cv::countNonZero(found);
  };
  TrackScene trails{.camera = &camera, .robots = {SceneRobot{}, SceneRobot{}}};
  trails.robots[0].trail_m = {{-0.2, 0.1}, {-0.1, 0.1}};
  const int first_trail = red(DrawTrack(trails));
  trails.robots[1].trail_m = {{0.1, -0.1}, {0.2, -0.1}};
  CHECK(first_trail > 50);
  CHECK(red(DrawTrack(trails)) == Approx(2.0 * first_trail).epsilon(0.2));
}

TEST_CASE("The keys of a window are told at its foot, and nothing is where it has none") {
  const vision::CameraModel camera = test::PaperCamera();
  const auto letters = [&](const std::string& keys) {
    const cv::Mat bgr = DrawTrack({.camera = &camera, .keys = keys}).bgr;
    cv::Mat found;
    cv::inRange(bgr.rowRange(bgr.rows - 30, bgr.rows), cv::Scalar::all(120), cv::Scalar::all(255),
                found);
    return cv::countNonZero(found);
  };
  CHECK(letters("w: waypoint here") > 20);
  CHECK(letters("") == 0);
}

TEST_CASE("How far the first robot is off its path is told in millimetres") {
  const vision::CameraModel camera = test::PaperCamera();
  TrackScene scene{.camera = &camera,
                   .robots = {{.tag_id = 0, .sighting = TagAt(camera, 0, 0.0, 0.0123)}}};
  const auto has_line = [&](const std::string& line) {
    const std::vector<std::string> lines = WordsOf(scene);
    return std::find(lines.begin(), lines.end(), line) != lines.end();
  };
  for (const std::string& line : WordsOf(scene)) CHECK(line.find("path") == line.npos);
  scene.path_m = {{-0.2, 0.0}, {0.2, 0.0}};
  scene.robots[0].beside.largest_m = 0.0311;
  CHECK(has_line("off the path 12.3 mm left   largest 31.1 mm"));
  scene.robots[0].sighting.reset();
  CHECK(has_line("off the path -   largest 31.1 mm"));
  scene.robots[0].sighting = TagAt(camera, 0, 0.0, 0.0322);
  CHECK(has_line("off the path 32.2 mm left   largest 32.2 mm"));
  scene.robots[0].sighting.reset();
  // With several robots each pose has its tag.
  scene.robots.push_back({.tag_id = 7, .sighting = TagAt(camera, 7, 0.1, -0.05)});
  CHECK(has_line("tag 0: not seen"));
  CHECK(has_line("tag 7: x +0.1000 m   y -0.0500 m   yaw   +0.0 deg"));
}

TEST_CASE("What is nearer to the camera than five centimetres, or behind it, is not drawn") {
  const vision::CameraModel camera = test::PaperCamera();
  const TrackScene empty{.camera = &camera};
  for (const double ahead_m : {0.053, 0.047, -0.3}) {
    const Eigen::Vector3d place =
        vision::MapFromCamera(camera) * Eigen::Vector3d(0.0, 0.0, ahead_m);
    TrackScene scene = empty;
    scene.plane_z_m = place.z();
    scene.waypoints = {{"here", place.head<2>()}};
    const bool is_drawn = cv::norm(DrawTrack(scene).bgr, DrawTrack(empty).bgr, cv::NORM_INF) > 0.0;
    INFO(ahead_m);
    CHECK(is_drawn == (ahead_m > 0.05));
  }
}

TEST_CASE("Without a picture there is room for words, which stay in it however many they are") {
  CHECK(ShownPicture(nullptr, 0, 0).size() == cv::Size(320, 240));
  CHECK(ShownPicture(nullptr, 321, 241).size() == cv::Size(321, 241));
  cv::Mat picture = ShownPicture(nullptr, 0, 0);
  DrawLines(picture, std::vector<std::string>(30, std::string(200, 'x')), true);
  CHECK(picture.size() == cv::Size(320, 240));
  cv::Mat bright(240, 320, CV_8UC3, cv::Scalar::all(255));
  DrawLines(bright, {"some words"}, false);
  CHECK(bright.at<cv::Vec3b>(240 - 28 - 1, 4) == cv::Vec3b::all(255));
  CHECK(bright.at<cv::Vec3b>(240 - 28, 4) != cv::Vec3b::all(255));
  CHECK(bright.at<cv::Vec3b>(239, 4) == cv::Vec3b(99, 96, 95));  // 0.3 of it, 0.7 of the panel
  CHECK(bright.at<cv::Vec3b>(239, 319) == cv::Vec3b::all(255));
}

TEST_CASE("A path of many short legs is drawn as one of a long leg") {
  const vision::CameraModel camera = test::PaperCamera();
  const auto black = [&](int legs) {
    TrackScene scene{.camera = &camera};
    for (int i = 0; i <= legs; ++i) scene.path_m.emplace_back(-0.3 + 0.6 * i / legs, 0.0);
    cv::Mat found;
    cv::inRange(DrawTrack(scene).bgr, cv::Scalar::all(0), cv::Scalar::all(0), found);
    return cv::countNonZero(found);
  };
  CHECK(black(1) > 50);
  CHECK(black(60) == Approx(black(1)).epsilon(0.15));  // of a centimetre
}

TEST_CASE("What is drawn over a picture has the colours that its legend tells") {
  const vision::CameraModel camera = test::PaperCamera();
  const auto count = [&](const TrackScene& scene, const cv::Scalar& colour) {
    cv::Mat found;
    cv::inRange(DrawTrack(scene).bgr, colour, colour, found);
    return cv::countNonZero(found);
  };
  const cv::Scalar green(40, 220, 40), red(40, 40, 235), black(0, 0, 0), yellow(0, 225, 255),
      blue(235, 110, 30), white(255, 255, 255), panel(32, 28, 26);
  const TrackScene empty{.camera = &camera};
  for (const cv::Scalar& colour : {green, red, black, yellow, blue})
    CHECK(count(empty, colour) == 0);
  CHECK(count(empty, panel) > 100'000);
  TrackScene path = empty;
  path.path_m = {{-0.3, 0.0}, {0.3, 0.0}};
  CHECK(count(path, black) > 50);
  TrackScene waypoint = empty;
  waypoint.waypoints = {{"a", {0.1, 0.1}}};
  CHECK(count(waypoint, yellow) > 50);
  TrackScene tag = empty;
  tag.robots = {{.tag_id = 0, .sighting = TagAt(camera, 0, 0.0, 0.0)}};
  CHECK(count(tag, green) > 50);
  CHECK(count(tag, red) > 20);
  TrackScene beside = empty;
  beside.robots = {SceneRobot{}};
  beside.robots[0].beside.lines = {{{0.0, 0.1}, {0.0, -0.1}}};
  CHECK(count(beside, blue) > 50);
  TrackScene place = empty;
  place.stand_at = geometry::Pose2{0.1, 0.0, 0.0};
  CHECK(count(place, white) > count(empty, white) + 50);
}

}  // namespace
}  // namespace rift::view
