#include "rift/vision/tracking/world_frame.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "rift/vision/tracking/session.hpp"
#include "support/inputs/paper_camera.hpp"
#include "support/mirror.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

/// 600 px a radian, no lens, 640 x 480, 2 m above the floor and looking straight down, at (a, b).
CameraModel Overhead(double a_m = 0.0, double b_m = 0.0) {
  CameraModel camera{.name = "overhead", .width_px = 640, .height_px = 480};
  camera.k << 600.0, 0.0, 319.5, 0.0, 600.0, 239.5, 0.0, 0.0, 1.0;
  camera.world.emplace();
  camera.world->world_from_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  camera.world->world_from_camera.translation() = Eigen::Vector3d(a_m, b_m, 2.0);
  camera.world->origin = "4 reference tags";
  return camera;
}

Eigen::Vector2d PixelOf(const CameraModel& camera, const Eigen::Vector3d& p_in_world) {
  return PixelsFromPoints(camera, {camera.world->world_from_camera.inverse() * p_in_world})[0];
}

TagDetection SquareAt(const CameraModel& camera, int id, const Eigen::Vector3d& middle_m) {
  TagDetection tag;
  tag.id = id;
  const std::array<Eigen::Vector3d, 4> arms{
      {{-0.02, -0.02, 0.0}, {0.02, -0.02, 0.0}, {0.02, 0.02, 0.0}, {-0.02, 0.02, 0.0}}};
  for (int i = 0; i < 4; ++i) tag.corners[i] = PixelOf(camera, middle_m + arms[i]);
  return tag;
}

TEST_CASE("A pixel lies on the floor where its ray meets it, at any height") {
  const CameraModel camera = Overhead(0.5, -0.25);
  // 60 px to the right are 0.1 of the way down, 30 px down the picture are 0.05 towards -y.
  const auto floor = MapFromPixel(camera, {379.5, 269.5}, 0.0);
  REQUIRE(floor);
  CHECK(floor->x() == Approx(0.5 + 0.2));
  CHECK(floor->y() == Approx(-0.25 - 0.1));
  const auto raised = MapFromPixel(camera, {379.5, 269.5}, 1.0);
  REQUIRE(raised);
  CHECK(raised->x() == Approx(0.5 + 0.1));
  CHECK(raised->y() == Approx(-0.25 - 0.05));
  CHECK_FALSE(MapFromPixel(camera, {379.5, 269.5}, 2.5));  // above the camera
}

TEST_CASE("A ray that does not go down meets no floor") {
  CameraModel camera = Overhead();
  // Looking along +x: z forward is x, x right is -y, y down is -z.
  camera.world->world_from_camera.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  CHECK_FALSE(MapFromPixel(camera, {319.5, 239.5}, 0.0));
  CHECK_FALSE(MapFromPixel(camera, {319.5, 200.0}, 0.0));
  const auto ahead = MapFromPixel(camera, {319.5, 239.5 + 600.0}, 0.0);
  REQUIRE(ahead);
  CHECK(ahead->x() == Approx(2.0));
  CHECK(ahead->y() == Approx(0.0).margin(1e-12));
}

TEST_CASE("The middle of a tag is where its diagonals cross, however it is seen") {
  CameraModel camera = Overhead();
  camera.world->world_from_camera.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.6, 0.8, 0.0)).toRotationMatrix() *
      camera.world->world_from_camera.linear();
  const Eigen::Vector3d middle_m(0.4, -0.9, 0.03);
  const Eigen::Vector2d middle = MiddlePixel(camera, SquareAt(camera, 1, middle_m).corners);
  CHECK((middle - PixelOf(camera, middle_m)).norm() < 1e-6);
  camera.distortion = {0.1, -0.02, 0.001, 0.002};
  const Eigen::Vector2d bent = MiddlePixel(camera, SquareAt(camera, 1, middle_m).corners);
  CHECK((bent - PixelOf(camera, middle_m)).norm() < 1e-4);
}

TEST_CASE("Points pose the camera, on one height or on several") {
  const CameraModel camera = test::PaperCamera();
  const bool flat = GENERATE(true, false);
  std::vector<WorldPoint> points;
  for (const auto& [x, y, z] : {std::tuple{-0.5, -0.3, 0.02},
                                {0.6, -0.25, 0.1},
                                {0.5, 0.35, 0.3},
                                {-0.45, 0.3, 0.15},
                                {0.1, 0.05, 0.2}}) {
    const Eigen::Vector3d p(x, y, flat ? 0.05 : z);
    points.push_back({p, PixelOf(camera, p), ""});
  }
  const WorldFrame world = WorldFromPoints(camera, points, "5 points");
  CHECK(world.origin == "5 points");
  CHECK(world.residual_m < 1e-6);
  CHECK(world.world_from_camera.isApprox(camera.world->world_from_camera, 1e-5));
}

TEST_CASE("The residual of a frame is the root mean square on the floor") {
  const CameraModel camera = Overhead();
  std::vector<WorldPoint> points;
  for (const double x : {-0.4, 0.4}) {
    for (const double y : {-0.3, 0.3}) {
      for (const double off : {-0.003, 0.003}) {  // pairs about one place: the frame stays
        const Eigen::Vector3d p(x, y, 0.0);
        points.push_back({p, PixelOf(camera, p + Eigen::Vector3d(off, 0.0, 0.0)), ""});
      }
    }
  }
  CHECK(WorldFromPoints(camera, points, "").residual_m == Approx(0.003).epsilon(1e-3));
}

TEST_CASE("Of points that do not fit exactly no camera nearby would see them better") {
  const CameraModel camera = test::PaperCamera();
  const bool flat = GENERATE(true, false);
  std::vector<WorldPoint> points;
  for (const auto& [x, y, z, off] : {std::tuple{-0.5, -0.3, 0.02, 1.5},
                                     {0.6, -0.25, 0.1, -1.0},
                                     {0.5, 0.35, 0.3, 2.0},
                                     {-0.45, 0.3, 0.15, -0.5},
                                     {0.1, 0.05, 0.2, 1.0}}) {
    const Eigen::Vector3d p(x, y, flat ? 0.05 : z);
    points.push_back({p, PixelOf(camera, p) + Eigen::Vector2d(off, -0.7 * off), ""});
  }
  std::vector<Eigen::Vector2d> pixels;
  for (const WorldPoint& point : points) pixels.push_back(point.pixel);
  const auto rays = RaysFromPixels(camera, pixels);
  const auto off = [&](const Eigen::Isometry3d& camera_from_world) {
    double squares = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      squares += ((camera_from_world * points[i].p_in_world).hnormalized() - rays[i]).squaredNorm();
    }
    return squares;
  };
  const Eigen::Isometry3d found = WorldFromPoints(camera, points, "").world_from_camera.inverse();
  for (int i = 0; i < 6; ++i) {
    for (const double step : {-1e-4, 1e-4}) {
      Eigen::Isometry3d moved = found;
      if (i < 3) moved.translation()[i] += step;
      if (i >= 3) {
        moved = Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(i - 3)) * found;
      }
      INFO(i << " " << step);
      CHECK(off(moved) > off(found));
    }
  }
}

TEST_CASE("Points that make no frame are refused with what to do") {
  const CameraModel camera = Overhead();
  std::vector<WorldPoint> points;
  for (const auto& [x, y] : {std::pair{-0.4, -0.3}, {0.4, -0.3}, {0.4, 0.3}, {-0.4, 0.3}}) {
    const Eigen::Vector3d p(x, y, 0.0);
    points.push_back({p, PixelOf(camera, p), ""});
  }
  CHECK_NOTHROW(WorldFromPoints(camera, points, ""));
  test::OnBothSides("x", "y", [&](const test::Side& side) {
    std::vector<WorldPoint> thin = points;
    for (WorldPoint& point : thin) point.p_in_world[side.IsFirst() ? 0 : 1] *= 0.03;
    CHECK_THROWS_WITH(
        WorldFromPoints(camera, thin, ""),
        "a world frame needs points in both directions of the floor, these lie on a line");
    for (WorldPoint& point : thin) point.p_in_world[side.IsFirst() ? 0 : 1] *= 2.5;
    for (WorldPoint& point : thin) point.pixel = PixelOf(camera, point.p_in_world);
    CHECK_NOTHROW(WorldFromPoints(camera, thin, ""));
    std::vector<WorldPoint> mirrored = points;
    for (WorldPoint& point : mirrored) point.p_in_world[side.IsFirst() ? 0 : 1] *= -1.0;
    CHECK_THROWS_WITH(
        WorldFromPoints(camera, mirrored, ""),
        "these points could only be seen so from below the floor: give them with x right and y up, "
        "as on a map (counter-clockwise positive), each at its own point");
  });
  const std::vector<WorldPoint> one_place(4, points[0]);
  CHECK_THROWS_WITH(
      WorldFromPoints(camera, one_place, ""),
      "a world frame needs points in both directions of the floor, these lie on a line");
  points.pop_back();
  CHECK_THROWS_WITH(WorldFromPoints(camera, points, ""),
                    "a world frame needs 4 points that are seen, there are 3");
}

TEST_CASE("Reference tags that are seen set the frame and are kept with where they were seen") {
  const CameraModel camera = Overhead(0.1, 0.05);
  std::vector<ReferenceMark> marks;
  std::vector<TagDetection> seen;
  int id = 3;
  for (const auto& [x, y] :
       {std::pair{-0.4, -0.3}, {0.45, -0.3}, {0.4, 0.35}, {-0.4, 0.3}, {0.0, 0.1}}) {
    marks.push_back({id, {x, y, 0.0}, Eigen::Vector2d::Zero()});
    if (id != 7) seen.push_back(SquareAt(camera, id, marks.back().p_in_world));
    ++id;
  }
  const WorldFrame world = WorldFromTags(camera, marks, seen, 0.005);
  CHECK(world.origin == "4 reference tags");
  REQUIRE(world.marks.size() == 4);
  CHECK(world.world_from_camera.isApprox(camera.world->world_from_camera, 1e-5));
  for (int i = 0; i < 4; ++i) {
    CHECK(world.marks[i].tag_id == 3 + i);
    CHECK((world.marks[i].seen_px - PixelOf(camera, marks[i].p_in_world)).norm() < 1e-6);
  }
  seen.erase(seen.begin() + 1);
  CHECK_THROWS_WITH(WorldFromTags(camera, marks, seen, 0.005),
                    "a world frame needs 4 reference tags, 3 of 5 are seen (not 4, 7)");
  marks.resize(3);
  CHECK_THROWS_WITH(WorldFromTags(camera, marks, seen, 0.005),
                    Contains("needs 4 reference tags or more, and the file names 3"));
}

TEST_CASE(
    "How far a camera was moved is the root mean square of the reference tags it still sees") {
  CameraModel camera = Overhead();
  CHECK_FALSE(MovedBy_m(camera, {}));
  const std::array<Eigen::Vector3d, 3> places{{{-0.4, 0.0, 0.0}, {0.4, 0.0, 0.0}, {0.0, 0.3, 0.5}}};
  const std::array<Eigen::Vector3d, 3> off{{{0.03, 0.0, 0.0}, {0.0, 0.04, 0.0}, {0.0, 0.0, 0.0}}};
  std::vector<TagDetection> seen;
  for (int i = 0; i < 3; ++i) {
    camera.world->marks.push_back({i, places[i], PixelOf(camera, places[i])});
    seen.push_back(SquareAt(camera, i, places[i] + off[i]));
  }
  const auto moved_m = MovedBy_m(camera, seen);
  REQUIRE(moved_m);
  CHECK(*moved_m == Approx(std::sqrt((0.0009 + 0.0016) / 3.0)));
  seen.pop_back();
  CHECK(*MovedBy_m(camera, seen) == Approx(std::sqrt((0.0009 + 0.0016) / 2.0)));
  CHECK_FALSE(MovedBy_m(camera, {SquareAt(camera, 9, places[0])}));
  // Another tag of its id lies about.
  const std::vector<TagDetection> twice{SquareAt(camera, 0, places[1]),
                                        SquareAt(camera, 0, places[0] + off[0])};
  CHECK(*MovedBy_m(camera, twice) == Approx(0.03));
  camera.world.reset();
  CHECK_FALSE(MovedBy_m(camera, seen));
}

TEST_CASE("A camera that was moved is said from the limit on, with the distance") {
  CHECK_FALSE(MovedWarning(std::nullopt, 0.01));
  CHECK_FALSE(MovedWarning(0.01, 0.01));
  const auto warning = MovedWarning(0.0123, 0.01);
  REQUIRE(warning);
  CHECK_THAT(*warning, Contains("the reference tags lie 12.3 mm off"));
}

TEST_CASE("The first pose of a robot's tag is the origin below it, its heading the x axis") {
  std::vector<Eigen::Isometry3d> poses;
  const Eigen::Isometry3d camera_from_tag = Eigen::Translation3d(0.3, -0.2, 2.0) *
                                            Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.0, 0.0, 1.0)) *
                                            Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX());
  for (const double off : {-0.004, 0.004}) {
    poses.push_back(Eigen::Translation3d(0.0, off, 0.0) * camera_from_tag *
                    Eigen::AngleAxisd(10.0 * off, Eigen::Vector3d::UnitZ()));
  }
  const WorldFrame world = WorldFromFirstPose(poses, 0.03);
  CHECK(world.origin == kFirstPoseOrigin);
  CHECK(world.residual_m == Approx(0.004));
  const Eigen::Isometry3d tag = world.world_from_camera * camera_from_tag;
  CHECK((tag.translation() - Eigen::Vector3d(0.0, 0.0, 0.03)).norm() < 1e-12);
  CHECK(tag.linear().isApprox(Eigen::Matrix3d::Identity(), 1e-9));
  CHECK_THROWS_WITH(WorldFromFirstPose({}, 0.03), Contains("no sighting"));
}

}  // namespace
}  // namespace rift::vision
