#include "rift/vision/tracking/world_check.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "vision/rendered_tags.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

constexpr double kLimit_m = 0.005;

/// Six tags on the floor as the camera sees them, to a tenth of a pixel.
std::vector<WorldPoint> SixTags(const CameraModel& camera) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::vector<WorldPoint> points;
  const std::vector<Eigen::Vector2d> places{{-0.5, -0.2},  {0.0, -0.25}, {0.5, -0.2},
                                            {-0.45, 0.35}, {0.05, 0.3},  {0.55, 0.35}};
  for (const Eigen::Vector2d& place : places) {
    WorldPoint point{{place.x(), place.y(), 0.0}, {}, "tag " + std::to_string(points.size() + 1)};
    point.pixel =
        PixelsFromPoints(camera, {camera.world->world_from_camera.inverse() * point.p_in_world})[0];
    point.pixel += Eigen::Vector2d(noise(random), noise(random));
    points.push_back(point);
  }
  return points;
}

TEST_CASE("Places that fit are taken") {
  const CameraModel camera = test::PaperCamera();
  CHECK_NOTHROW(CheckPoints(camera, SixTags(camera), kLimit_m));
  for (const double off_m : LeaveOneOut_m(camera, SixTags(camera))) CHECK(off_m < 1e-3);
}

TEST_CASE("A tag that lies elsewhere, two that are swapped and a stretched axis are named") {
  const CameraModel camera = test::PaperCamera();
  std::vector<WorldPoint> points = SixTags(camera);
  SECTION("one moved by 10 cm") {
    points[3].p_in_world.x() += 0.1;
    CHECK_THROWS_WITH(CheckPoints(camera, points, kLimit_m),
                      Contains("tag 4 is wrong") && Contains("mm away"));
  }
  SECTION("one moved so little that the mean is within the limit") {
    points[3].p_in_world.x() += 0.012;
    CHECK_THROWS_WITH(CheckPoints(camera, points, kLimit_m),
                      Contains("mm off where the others put it (limit") &&
                          Contains(", for one twice that): tag 4 is wrong"));
  }
  SECTION("one moved so far that the mean is beyond it") {
    points[3].p_in_world.x() += 0.1;
    CHECK_THROWS_WITH(CheckPoints(camera, points, kLimit_m),
                      Contains("mm RMS (limit") && !Contains("twice that"));
  }
  SECTION("two swapped") {
    std::swap(points[1].p_in_world, points[5].p_in_world);
    CHECK_THROWS_WITH(CheckPoints(camera, points, kLimit_m),
                      Contains("tag 2 and tag 6 are swapped"));
  }
  SECTION("two swapped of four") {
    points.resize(5);
    points.erase(points.begin() + 1);
    std::swap(points[0].p_in_world, points[1].p_in_world);
    CHECK_THROWS_WITH(CheckPoints(camera, points, kLimit_m), Contains("are swapped"));
  }
  SECTION("x is a tenth too long") {
    for (WorldPoint& point : points) point.p_in_world.x() *= 1.1;
    CHECK_THROWS_WITH(CheckPoints(camera, points, kLimit_m), Contains("scale differs"));
  }
}

TEST_CASE("The robot's own tag tells centimetres from metres") {
  CameraModel camera = test::PaperCamera();
  TagDetection tag{.id = 0};
  tag.corners = test::TrueCorners(camera, test::RobotAt(0.1, 0.05, 0.4));
  const auto scale = ScaleByTag(camera, {tag}, 0, 0.0475, 0.03);
  REQUIRE(scale);
  CHECK(*scale == Approx(1.0).margin(1e-3));
  CHECK_FALSE(ScaleByTag(camera, {tag}, 3, 0.0475, 0.03));
  CHECK_NOTHROW(CheckScale(*scale, 0.0475, 0.05));
  CHECK_THROWS_WITH(CheckScale(100.0, 0.0475, 0.05), Contains("centimetres"));
  CHECK_THROWS_WITH(CheckScale(1.1, 0.0475, 0.05), Contains("0.05225 m wide"));
}

TEST_CASE("A better frame is not replaced") {
  const WorldFrame tags{.residual_m = 0.0004, .origin = "6 reference tags"};
  const WorldFrame worse{.residual_m = 0.003, .origin = "4 reference tags"};
  const WorldFrame first{.residual_m = 0.0001, .origin = std::string(kFirstPoseOrigin)};
  CHECK_FALSE(IsWorseThan(tags, worse));
  CHECK_FALSE(IsWorseThan(tags, first));
  REQUIRE(IsWorseThan(worse, tags));
  CHECK_THAT(*IsWorseThan(worse, tags), Contains("6 reference tags, 0.40 mm"));
  CHECK(IsWorseThan(first, tags));
}

}  // namespace
}  // namespace rift::vision
