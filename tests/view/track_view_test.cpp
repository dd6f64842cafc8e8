#include "rift/view/track_view.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "rift/view/calibration_view.hpp"
#include "support/inputs/paper_camera.hpp"

namespace rift::view {
namespace {

vision::Sighting SeenAt(double x_m, double y_m, double yaw_rad = 0.0, double z_m = 0.03) {
  vision::Sighting sighting;
  sighting.map_from_tag.translation() = Eigen::Vector3d(x_m, y_m, z_m);
  sighting.map_from_tag.linear() =
      Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return sighting;
}

/// A window of tracking in which a person does as it is told, and what it shows.
struct Watched {
  vision::CameraModel camera = test::PaperCamera();
  TrackScene shown;
  TrackInput next;
  std::vector<std::vector<control::Waypoint>> saved;
  TrackView view;

  explicit Watched(TrackView::Content content, std::vector<int> ids = {3})
      : view(camera, ids, std::move(content), [this](const TrackScene& scene) {
          shown = scene;
          return std::exchange(next, {});
        }) {}
  static TrackView::Content Saving(Watched& self) {
    return {.save = [&self](const auto& waypoints) { self.saved.push_back(waypoints); }};
  }

  bool Show(const std::optional<vision::Sighting>& seen, const TrackInput& input = {},
            const std::optional<double>& moved_m = std::nullopt) {
    next = input;
    return view.Show(std::nullopt, {seen}, {.latency_s = 0.5}, moved_m);
  }
  /// Where the camera shows a point of the floor.
  Eigen::Vector2d Pixel(double x_m, double y_m) const {
    const Eigen::Vector3d p_in_camera =
        vision::MapFromCamera(camera).inverse() * Eigen::Vector3d(x_m, y_m, 0.0);
    return vision::PixelsFromPoints(camera, {p_in_camera}).front();
  }
  /// What is shown after what was done last.
  const TrackScene& Now() {
    Show(std::nullopt);
    return shown;
  }
};

TEST_CASE(
    "Waypoints lie where the floor was clicked and where the robot stood, its heading first") {
  Watched watched(Watched::Saving(watched));
  watched.Show(SeenAt(0.1, -0.2, 0.5), {.here = true});
  watched.Show(SeenAt(0.0, 0.0), {.clicks_px = {watched.Pixel(0.3, 0.1)}});
  watched.Show(SeenAt(0.2, 0.15, 1.0), {.here = true});
  REQUIRE(watched.saved.size() == 3);
  const std::vector<control::Waypoint>& made = watched.saved.back();
  REQUIRE(made.size() == 3);
  CHECK((made[0].name == "start" && made[1].name == "wp1" && made[2].name == "wp2"));
  CHECK((made[0].x_m == 0.1 && made[0].y_m == -0.2));
  REQUIRE(made[0].heading_deg);
  CHECK(*made[0].heading_deg == Approx(0.5 * 180.0 / M_PI));
  CHECK(made[1].x_m == Approx(0.3).margin(1e-6));
  CHECK(made[1].y_m == Approx(0.1).margin(1e-6));
  CHECK_FALSE(made[1].heading_deg);
  CHECK((made[2].x_m == 0.2 && made[2].y_m == 0.15 && !made[2].heading_deg));
  CHECK(watched.Now().prompts == std::vector<std::string>{"wp2: x 0.200 m, y 0.150 m"});
  REQUIRE(watched.shown.waypoints.size() == 3);
  CHECK(watched.shown.waypoints[2].name == "wp2");
}

TEST_CASE("A waypoint is taken back, or passed, the last one first, and each change is kept") {
  Watched watched(Watched::Saving(watched));
  const TrackInput click{.clicks_px = {watched.Pixel(0.0, 0.0)}};
  watched.Show(std::nullopt, {.undo = true});
  watched.Show(std::nullopt, {.toggle_stop = true});
  CHECK(watched.saved.empty());  // there is none
  watched.Show(std::nullopt, click);
  watched.Show(std::nullopt, click);
  watched.Show(std::nullopt, {.toggle_stop = true});
  REQUIRE(watched.saved.size() == 3);
  CHECK((watched.saved[2][0].stop && !watched.saved[2][1].stop));
  CHECK(watched.Now().waypoints[1].name == "wp1 (pass)");
  watched.Show(std::nullopt, {.toggle_stop = true});
  CHECK(watched.saved.back()[1].stop);
  watched.Show(std::nullopt, {.undo = true});
  CHECK(watched.saved.back().size() == 1);
  CHECK(watched.saved.size() == 5);
  watched.Show(std::nullopt);
  watched.Show(std::nullopt, {.here = true});  // no robot is seen
  CHECK(watched.saved.size() == 5);
  watched.Show(std::nullopt, {.undo = true});
  REQUIRE(watched.saved.size() == 6);
  CHECK(watched.saved[5].empty());  // or the file would keep what was taken back
}

TEST_CASE(
    "Waypoints that no file keeps are said to be lost, and planned ones are shown with them") {
  Watched watched({.path_m = {{0.0, 0.0}, {1.0, 0.0}},
                   .planned = {{"a", 0.5, 0.25}, {.name = "b", .x_m = 1.0, .stop = false}}});
  CHECK(watched.Show(SeenAt(0.0, 0.0), {.here = true}));
  const TrackScene& shown = watched.Now();
  CHECK_THAT(shown.prompts.back(), Catch::Contains("(not saved: --record-waypoints FILE)"));
  REQUIRE(shown.waypoints.size() == 3);
  CHECK((shown.waypoints[0].name == "a" && shown.waypoints[0].p_in_world_m.x() == 0.5));
  CHECK((shown.waypoints[1].name == "b (pass)" && shown.waypoints[2].name == "start"));
  CHECK(shown.path_m.size() == 2);
  CHECK_FALSE(watched.Show(std::nullopt, {.quit = true}));
  watched.Show(std::nullopt, {}, 0.0032);
  CHECK(watched.shown.prompts.front() == "reference tags 3.2 mm off their places");
}

TEST_CASE("Without a world frame clicks lie in the plane in which the tag was first seen") {
  vision::CameraModel camera = test::PaperCamera();
  camera.world.reset();
  TrackScene shown;
  TrackInput next;
  std::vector<control::Waypoint> saved;
  TrackView view(camera, {3}, {.save = [&](const auto& waypoints) { saved = waypoints; }},
                 [&](const TrackScene& scene) {
                   shown = scene;
                   return std::exchange(next, {});
                 });
  next.clicks_px = {{camera.k(0, 2), camera.k(1, 2)}};
  view.Show(std::nullopt, {std::nullopt}, {}, std::nullopt);
  view.Show(std::nullopt, {std::nullopt}, {}, std::nullopt);
  CHECK(saved.empty());
  REQUIRE(shown.prompts.size() == 1);
  CHECK_THAT(shown.prompts[0], Catch::StartsWith("no place: show the robot's tag first"));
  next.clicks_px = {{camera.k(0, 2) + 100.0, camera.k(1, 2)}};
  view.Show(std::nullopt, {SeenAt(0.0, 0.0, 0.0, -1.5)}, {}, std::nullopt);
  view.Show(std::nullopt, {SeenAt(0.0, 0.0, 0.0, -2.0)}, {}, std::nullopt);
  CHECK(shown.plane_z_m == -1.5);
  REQUIRE(saved.size() == 1);
  CHECK(saved[0].x_m == Approx(1.5 * 100.0 / camera.k(0, 0)).epsilon(0.05));  // and the lens
  CHECK(std::abs(saved[0].y_m) < 1e-3);
}

TEST_CASE("A trail has a point each two millimetres and ends where the robot was lifted away") {
  Watched watched({}, {3, 7});
  const auto show = [&](double x_m) {
    watched.view.Show(std::nullopt, {SeenAt(x_m, 0.0), std::nullopt}, {}, std::nullopt);
    return watched.shown.robots[0].trail_m.size();
  };
  CHECK(show(0.0) == 1);
  CHECK(show(0.0019) == 1);
  CHECK(show(0.0021) == 2);
  CHECK(show(0.15) == 3);
  CHECK(show(0.2999) == 4);
  CHECK(show(0.4501) == 1);
  CHECK(watched.shown.robots[0].trail_m[0].x() == 0.4501);
  CHECK(watched.shown.robots[1].trail_m.empty());
  CHECK((watched.shown.robots[0].tag_id == 3 && watched.shown.robots[1].tag_id == 7));
  CHECK(watched.shown.plane_z_m == 0.0);
  watched.next.clear_trail = true;
  show(0.5);
  CHECK(show(0.5) == 1);
  for (int i = 0; i < 4100; ++i) show(0.5 + 0.0025 * (i % 50));
  CHECK(show(0.5) == 4000);
}

TEST_CASE("The latency shown is that of the pose, or of the camera where the robot is not seen") {
  Watched watched({});
  vision::Sighting seen = SeenAt(0.0, 0.0);
  seen.latency_s = 0.02;
  watched.Show(seen);
  CHECK(watched.shown.latency_s == 0.02);
  CHECK(watched.shown.robots[0].sighting);
  watched.Show(std::nullopt);
  CHECK(watched.shown.latency_s == 0.5);
  CHECK_FALSE(watched.shown.robots[0].sighting);
}

TEST_CASE("Each key of the tracking window has its meaning, and any other is a key all the same") {
  const auto after = [](int key) {
    TrackInput input;
    TakeKey(key, input);
    return input;
  };
  CHECK_FALSE(after(-1).any_key);
  constexpr int kInsert = 0xFF63, kNumLock = 0x100000;  // beside the key
  for (const int key : {int{'q'}, 27, int{'u'}, int{'w'}, int{'s'}, int{'c'}, int{'x'}, 0,
                        kNumLock + 'q', kInsert, kNumLock + kInsert}) {
    const TrackInput input = after(key);
    INFO(key);
    const int letter = key >= kNumLock ? key - kNumLock : key;
    CHECK(input.any_key);
    CHECK(input.quit == (letter == 'q' || letter == 27));
    CHECK(input.undo == (letter == 'u'));
    CHECK(input.here == (letter == 'w'));
    CHECK(input.toggle_stop == (letter == 's'));
    CHECK(input.clear_trail == (letter == 'c'));
    CHECK_FALSE(input.closed);
  }
}

TEST_CASE("Each key of the calibration window has its meaning and no other has one") {
  constexpr int kPrint = 0xFF61, kNumLock = 0x100000;
  for (const int key :
       {-1, int{' '}, int{'u'}, int{'a'}, int{'q'}, 27, int{'x'}, kNumLock + 'a', kPrint}) {
    const vision::LiveInput input = LiveInputOf(key);
    INFO(key);
    const int letter = key >= kNumLock ? key - kNumLock : key;
    CHECK(input.take == (letter == ' '));
    CHECK(input.undo == (letter == 'u'));
    CHECK(input.toggle == (letter == 'a'));
    CHECK(input.finish == (letter == 'q' || letter == 27));
  }
}

}  // namespace
}  // namespace rift::view
