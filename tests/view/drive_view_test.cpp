#include "rift/view/drive_view.hpp"

#include <catch2/catch.hpp>
#include <utility>

#include "support/inputs/paper_camera.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift::view {
namespace {

TEST_CASE("Any key in the window stops a robot under way, before that the keys that give up") {
  const TrackInput none, space{.any_key = true}, quit{.quit = true, .any_key = true},
      closed{.quit = true, .closed = true};
  CHECK(WishOf(none, false) == DriveWish::kGoOn);
  CHECK(WishOf(none, true) == DriveWish::kGoOn);
  CHECK(WishOf(space, false) == DriveWish::kGoOn);
  CHECK(WishOf(space, true) == DriveWish::kStopByKey);
  for (const bool is_started : {false, true}) {
    CHECK(WishOf(quit, is_started) == DriveWish::kStopByKey);
    CHECK(WishOf(closed, is_started) == DriveWish::kStopByClosing);
  }
}

vision::Sighting SeenAt(double x_m) {
  vision::Sighting sighting;
  sighting.map_from_tag.translation() = Eigen::Vector3d(x_m, 0.1, 0.03);
  sighting.latency_s = 0.02;
  return sighting;
}

TEST_CASE("The window of a drive says what its keys do, and outlines the start while it waits") {
  const vision::CameraModel camera = test::PaperCamera();
  const control::Task task(test::PaperWaypoints());
  TrackScene shown;
  TrackInput next;
  DriveView view(camera, task, [&](const TrackScene& scene) {
    shown = scene;
    return std::exchange(next, {});
  });
  using Words = std::vector<std::string>;
  const vision::CaptureStatus status{.rate_hz = 30.0};
  CHECK(view.Show(nullptr, std::nullopt, status, "3.1 cm, 2 deg off", false) == DriveWish::kGoOn);
  CHECK(shown.prompts == Words{"put the robot into the outline: 3.1 cm, 2 deg off",
                               "Enter in the terminal starts; q, Escape or closing gives up"});
  CHECK(shown.keys.empty());  // those of track would stop the robot
  REQUIRE(shown.stand_at);
  CHECK(*shown.stand_at == task.Start());
  CHECK(shown.status.rate_hz == 30.0);
  CHECK(shown.frame == nullptr);
  CHECK(shown.path_m.size() == task.IdealPath().size());
  CHECK(shown.waypoints.size() == task.waypoints.size());
  CHECK(shown.waypoints[1].p_in_world_m == task.waypoints[1].Position());

  const vision::Frame frame;
  next.any_key = true;
  CHECK(view.Show(&frame, SeenAt(0.0), status, "", true) == DriveWish::kStopByKey);
  CHECK(shown.prompts == Words{"any key in this window, or closing it, stops the robot"});
  CHECK_FALSE(shown.stand_at);
  CHECK(shown.frame == &frame);
  CHECK(shown.plane_z_m == 0.03);
  CHECK(shown.latency_s == 0.02);
  CHECK(shown.robots.front().sighting);
}

TEST_CASE("The trail of a drive has a point each two millimetres, and none where nothing is seen") {
  const vision::CameraModel camera = test::PaperCamera();
  TrackScene shown;
  DriveView view(camera, control::Task(test::PaperWaypoints()), [&](const TrackScene& scene) {
    shown = scene;
    return TrackInput{};
  });
  const auto trail_after = [&](const std::optional<vision::Sighting>& seen) {
    view.Show(nullptr, seen, {}, "", true);
    return shown.robots.front().trail_m.size();
  };
  CHECK(trail_after(std::nullopt) == 0);
  CHECK(trail_after(SeenAt(0.0)) == 1);
  CHECK(trail_after(SeenAt(0.0019)) == 1);
  CHECK(trail_after(std::nullopt) == 1);
  CHECK(trail_after(SeenAt(0.0021)) == 2);
  CHECK(shown.robots.front().trail_m[1] == Eigen::Vector2d(0.0021, 0.1));
}

TEST_CASE("A robot that is carried to its place leaves no trail, and its drive begins one there") {
  const vision::CameraModel camera = test::PaperCamera();
  TrackScene shown;
  DriveView view(camera, control::Task(test::PaperWaypoints()), [&](const TrackScene& scene) {
    shown = scene;
    return TrackInput{};
  });
  const auto trail_after = [&](double x_m, const std::string& placement) {
    view.Show(nullptr, SeenAt(x_m), {}, placement, true);
    return shown.robots.front().trail_m;
  };
  using Places = std::vector<Eigen::Vector2d>;
  trail_after(2.0, "2 m off");
  CHECK(trail_after(0.3, "30 cm off") == Places{{0.3, 0.1}});
  CHECK(shown.robots.front().beside.largest_m < 0.3);
  CHECK(trail_after(0.31, "") == Places{{0.3, 0.1}, {0.31, 0.1}});
  CHECK(shown.robots.front().beside.largest_m < 0.3);
}

TEST_CASE("A drive shows its newest eight metres, and the largest distance of all of it") {
  const vision::CameraModel camera = test::PaperCamera();
  std::size_t points = 0;
  double largest_m = 0.0;
  DriveView view(camera, control::Task(test::PaperWaypoints()), [&](const TrackScene& scene) {
    points = scene.robots.front().trail_m.size();
    largest_m = scene.robots.front().beside.largest_m;
    return TrackInput{};
  });
  view.Show(nullptr, SeenAt(9.0), {}, "", true);
  const double farthest_m = largest_m;
  CHECK(farthest_m > 7.0);
  for (int i = 0; i < 4000; ++i) view.Show(nullptr, SeenAt(0.0025 * (i % 2)), {}, "", true);
  CHECK(points == 4000);
  CHECK(largest_m == farthest_m);
}

}  // namespace
}  // namespace rift::view
