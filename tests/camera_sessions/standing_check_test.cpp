#include "sessions/drive/standing_check.hpp"

#include <catch2/catch.hpp>

namespace rift::sessions {
namespace {

vision::CameraModel CameraAbove() {
  vision::CameraModel camera{.name = "above", .width_px = 640, .height_px = 480};
  camera.world.emplace();
  camera.world->world_from_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  camera.world->world_from_camera.translation() = Eigen::Vector3d(0.0, 0.0, 2.0);
  camera.world->origin = "4 reference tags";
  return camera;
}

vision::Sighting SeenAt(double x_px, bool is_on_floor) {
  vision::Sighting sighting;
  sighting.in_world = true;
  sighting.is_on_floor = is_on_floor;
  for (Eigen::Vector2d& corner : sighting.corners) corner = {x_px, 100.0};
  sighting.map_from_tag.translation().z() = 0.1;
  return sighting;
}

TEST_CASE("A tag that rests above the floor is said once, before a drive") {
  const vision::CameraModel camera = CameraAbove();
  const vision::TagOptions tag;
  StandingCheck check(camera, tag);
  for (int i = 0; i < 9; ++i) check.Add(SeenAt(300.0 + 0.12 * i, false));
  CHECK_FALSE(check.Take());
  check.Add(SeenAt(300.0, false));
  const auto warning = check.Take();
  REQUIRE(warning);
  CHECK_THAT(*warning, Catch::Contains("the tag is not on the floor in 10 of 10 pictures"));
  CHECK_FALSE(check.Take());
  for (int i = 0; i < 30; ++i) check.Add(SeenAt(300.0, false));
  CHECK_FALSE(check.Take());
}

TEST_CASE("A robot that is carried to its start, or stands on the floor, is not said") {
  const vision::CameraModel camera = CameraAbove();
  const vision::TagOptions tag;
  StandingCheck carried(camera, tag), standing(camera, tag);
  for (int i = 0; i < 40; ++i) {
    carried.Add(SeenAt(300.0 + 1.1 * (i / 9), false));
    standing.Add(SeenAt(300.0, true));
  }
  CHECK_FALSE(carried.Take());
  CHECK_FALSE(standing.Take());
}

TEST_CASE("A tag rests while the middle of its four corners moves by a pixel at most") {
  const vision::CameraModel camera = CameraAbove();
  const vision::TagOptions tag;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (const bool is_x : {true, false}) {
      for (const double sign : {1.0, -1.0}) {
        const auto is_said = [&](double by_px) {
          StandingCheck check(camera, tag);
          for (int i = 0; i < 10; ++i) {
            vision::Sighting sighting = SeenAt(300.0, false);
            if (i >= 5)
              (is_x ? sighting.corners[corner].x() : sighting.corners[corner].y()) += sign * by_px;
            check.Add(sighting);
          }
          return check.Take().has_value();
        };
        INFO(corner << " " << is_x << " " << sign);
        CHECK(is_said(3.9));
        CHECK_FALSE(is_said(4.1));
      }
    }
  }
}

}  // namespace
}  // namespace rift::sessions
