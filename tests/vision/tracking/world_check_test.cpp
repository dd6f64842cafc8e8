#include "rift/vision/tracking/world_check.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <random>

#include "vision/rendered_tags.hpp"
#include "vision/small_recording.hpp"

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

TEST_CASE("Points that make no frame are refused as that, wherever they were seen") {
  const CameraModel camera = test::PaperCamera();
  std::vector<WorldPoint> points = SixTags(camera);
  for (const std::size_t count : {0U, 1U, 3U}) {
    CHECK_THROWS_WITH(
        CheckPoints(camera, {points.begin(), points.begin() + static_cast<long>(count)}, kLimit_m),
        "a world frame needs 4 points that are seen, there are " + std::to_string(count));
  }
  for (WorldPoint& point : points) point.p_in_world.y() = 0.5 * point.p_in_world.x();
  CHECK_THROWS_WITH(CheckPoints(camera, points, kLimit_m), Contains("these lie on a line"));
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

TEST_CASE(
    "A frame in another unit is named by its factor, and what is within the tolerance is not") {
  CHECK_NOTHROW(CheckScale(1.05 - 1e-9, 0.05, 0.05));
  CHECK_NOTHROW(CheckScale(0.95 + 1e-9, 0.05, 0.05));
  CHECK_THROWS(CheckScale(1.05 + 1e-9, 0.05, 0.05));
  CHECK_THROWS(CheckScale(0.95 - 1e-9, 0.05, 0.05));
  const auto reason = [](double scale) -> std::string {
    try {
      CheckScale(scale, 0.05, 0.05);
    } catch (const std::invalid_argument& error) {
      const std::string text = error.what();
      return text.substr(text.rfind(": ") + 2);
    }
    return "";
  };
  const std::string metres = ": x_m and y_m are metres";
  CHECK_THROWS_WITH(
      CheckScale(100.0, 0.05, 0.05),
      "in this frame the robot's tag is 5 m wide, printed it is 0.05 m: the places are "
      "centimetres" +
          metres);
  const std::string unclear =
      "is the tag's size right (--set track.tag.size_m), and are the places metres?";
  for (const auto& [low, high, unit] : {std::tuple{31.0, 49.0, "inches"},
                                        {80.0, 125.0, "centimetres"},
                                        {800.0, 1250.0, "millimetres"}}) {
    INFO(unit);
    CHECK_THROWS_WITH(CheckScale(1.001 * low, 0.05, 0.05), Contains(unit));
    CHECK_THROWS_WITH(CheckScale(0.999 * high, 0.05, 0.05), Contains(unit));
    CHECK(reason(low) == unclear);
    CHECK(reason(high) == unclear);
  }
}

TEST_CASE("The scale of a frame is the mean side of the tag over its printed side") {
  const CameraModel camera = test::PaperCamera();
  TagDetection tag{.id = 4};
  // Sides of 0.05, 0.1, 0.05 and 0.1 m at a height of 0.03 m.
  const std::array<Eigen::Vector3d, 4> corners{
      {{0.1, 0.1, 0.03}, {0.15, 0.1, 0.03}, {0.15, 0.2, 0.03}, {0.1, 0.2, 0.03}}};
  for (int i = 0; i < 4; ++i) {
    tag.corners[i] =
        PixelsFromPoints(camera, {camera.world->world_from_camera.inverse() * corners[i]})[0];
  }
  TagDetection other = tag;
  other.id = 3;
  for (Eigen::Vector2d& corner : other.corners) corner *= 2.0;
  CHECK(*ScaleByTag(camera, {other, tag}, 4, 0.05, 0.03) == Approx(1.5));
  CHECK(*ScaleByTag(camera, {tag}, 4, 0.05, 0.0) == Approx(1.5 * 0.87 / 0.84));
  CHECK_FALSE(ScaleByTag(camera, {tag}, 4, 0.05, 1.0));  // above the camera
}

TEST_CASE("A frame is worse from half as much again and 0.2 mm on, and after one of the floor") {
  const auto is_worse = [](double residual_m, double than_m) {
    return IsWorseThan({.residual_m = residual_m, .origin = "4 points"},
                       {.residual_m = than_m, .origin = "5 points"})
        .has_value();
  };
  CHECK_FALSE(is_worse(1.5 * 0.002 + 2e-4 - 1e-9, 0.002));
  CHECK(is_worse(1.5 * 0.002 + 2e-4 + 1e-9, 0.002));
  CHECK_FALSE(is_worse(1.9e-4, 0.0));
  CHECK(is_worse(2.1e-4, 0.0));
  const WorldFrame first{.residual_m = 0.001, .origin = std::string(kFirstPoseOrigin)};
  WorldFrame again = first;
  CHECK_FALSE(IsWorseThan(again, first));
  again.residual_m = 0.00234;
  CHECK(
      *IsWorseThan(again, first) ==
      "it holds a frame from first pose, 1.00 mm off; the new one is from first pose, 2.34 mm off");
  CHECK(IsWorseThan(first, {.residual_m = 1.0, .origin = "4 points"}));
  CHECK_FALSE(IsWorseThan({.residual_m = 1.0, .origin = "4 points"}, first));
}

/// Places as a camera sees them, without noise.
std::vector<WorldPoint> Exact(const CameraModel& camera,
                              const std::vector<Eigen::Vector2d>& places) {
  std::vector<WorldPoint> points;
  for (const Eigen::Vector2d& place : places) {
    const Eigen::Vector3d p(place.x(), place.y(), 0.02);
    points.push_back(
        {p, PixelsFromPoints(camera, {camera.world->world_from_camera.inverse() * p})[0], ""});
  }
  return points;
}

TEST_CASE(
    "How far a point lies off is told to where the others put it, of four by the other three") {
  const CameraModel camera = test::PaperCamera();
  std::vector<Eigen::Vector2d> places{{-0.5, -0.25}, {0.5, -0.2}, {0.55, 0.3}, {-0.45, 0.35}};
  for (const bool has_fifth : {false, true}) {
    if (has_fifth) places.emplace_back(0.05, 0.1);
    std::vector<WorldPoint> points = Exact(camera, places);
    for (const double off_m : LeaveOneOut_m(camera, points)) CHECK(off_m < 1e-4);
    points[2].p_in_world.head<2>() += Eigen::Vector2d(0.03, -0.04);
    const std::vector<double> off_m = LeaveOneOut_m(camera, points);
    REQUIRE(off_m.size() == places.size());
    CHECK(off_m[2] == Approx(0.05).epsilon(0.01));
    const std::string says =
        has_fifth ? "a point is wrong: the others put it 50.0 mm away; measure it again"
                  : "which one is wrong takes more tags to tell: measure all "
                    "again, or lay five or more";
    CHECK_THROWS_WITH(CheckPoints(camera, points, 0.004),
                      Contains("(limit 4 mm): ") && Contains(says));
    CHECK_NOTHROW(CheckPoints(camera, points, 10.0));
  }
}

TEST_CASE(
    "Points that only a camera below the floor sees so are said to fit from no place above it") {
  const CameraModel camera = test::PaperCamera();
  std::vector<WorldPoint> points =
      Exact(camera, {{-0.5, -0.25}, {0.5, -0.2}, {0.55, 0.3}, {-0.45, 0.35}, {0.05, 0.1}});
  for (WorldPoint& point : points) point.p_in_world.y() *= -1.0;
  CHECK_THROWS_WITH(
      CheckPoints(camera, points, 0.004),
      Contains("do not fit what the camera sees, from no place above the floor (limit"));
}

TEST_CASE("A world frame that came with another lens is told by its own reference tags") {
  CameraModel camera = test::SmallCamera();
  CHECK_FALSE(WhyNotOfThisLens(camera));  // clicked points keep no tags
  for (int id = 1; id <= 4; ++id) {
    const Eigen::Vector3d p(id < 3 ? -0.2 : 0.2, id % 2 == 0 ? -0.1 : 0.1, 0.0);
    const Eigen::Vector2d seen_px =
        PixelsFromPoints(camera, {camera.world->world_from_camera.inverse() * p})[0];
    camera.world->marks.push_back({id, p, seen_px});
  }
  CHECK_FALSE(WhyNotOfThisLens(camera));
  // 610 px are 0.6 m there, so that 2 px are 2 mm.
  CameraModel other = camera;
  other.k(0, 2) += 2.0;
  REQUIRE(WhyNotOfThisLens(other));
  CHECK(*WhyNotOfThisLens(other) ==
        "the world frame is not of this lens: the reference tags that set it lie 2.0 mm from where "
        "it puts them, and 0.0 mm when it was set: set it again (rift track --world)");
  other.world->residual_m = 0.0015;  // tags that were laid by hand
  CHECK_FALSE(WhyNotOfThisLens(other));
  CameraModel from_below = camera;
  from_below.world->world_from_camera.translation().z() = -0.6;
  CHECK(WhyNotOfThisLens(from_below));
  camera.world.reset();
  CHECK_FALSE(WhyNotOfThisLens(camera));
}

TEST_CASE("Places are taken up to the limit of their mean, and up to twice that of one of them") {
  const CameraModel camera = test::PaperCamera();
  std::vector<WorldPoint> points = SixTags(camera);
  points[3].p_in_world.x() += 0.012;
  const std::vector<double> off_m = LeaveOneOut_m(camera, points);
  const double worst_m = *std::max_element(off_m.begin(), off_m.end());
  REQUIRE(WorldFromPoints(camera, points, "").residual_m < 0.45 * worst_m);
  CHECK_NOTHROW(CheckPoints(camera, points, 0.5 * worst_m));
  CHECK_THROWS_WITH(CheckPoints(camera, points, 0.499 * worst_m), Contains("for one twice that"));

  // Four at each place, off by as much to every side, so that none stands out.
  points.clear();
  for (const Eigen::Vector2d& place :
       {Eigen::Vector2d(-0.5, -0.25), {0.5, -0.2}, {0.55, 0.3}, {-0.45, 0.35}}) {
    for (const Eigen::Vector2d& off :
         {Eigen::Vector2d(0.004, 0.0), {-0.004, 0.0}, {0.0, 0.004}, {0.0, -0.004}}) {
      points.push_back(Exact(camera, {place + off})[0]);
      points.back().p_in_world.head<2>() = place;
    }
  }
  const double mean_m = WorldFromPoints(camera, points, "").residual_m;
  const std::vector<double> each_m = LeaveOneOut_m(camera, points);
  REQUIRE(*std::max_element(each_m.begin(), each_m.end()) < 1.9 * mean_m);
  CHECK_NOTHROW(CheckPoints(camera, points, mean_m));
  CHECK_THROWS_WITH(CheckPoints(camera, points, std::nextafter(mean_m, 0.0)),
                    Contains("mm RMS (limit"));
}

TEST_CASE("Which of five places are wrong takes more to tell, of six more than one is") {
  const CameraModel camera = test::PaperCamera();
  for (const std::size_t count : {5U, 6U}) {
    std::vector<WorldPoint> points = SixTags(camera);
    points.resize(count);
    points[0].p_in_world.x() += 0.15;
    points[1].p_in_world.y() -= 0.12;
    points[4].p_in_world.x() -= 0.1;
    CHECK_THROWS_WITH(CheckPoints(camera, points, kLimit_m),
                      Contains(count == 5 ? "which one is wrong takes more tags to tell"
                                          : "more than one is wrong"));
  }
}

TEST_CASE("Why places do not fit is a whole line with how far off they are") {
  const CameraModel camera = test::PaperCamera();
  const std::string head = "the places of the points do not fit what the camera sees, ";
  std::vector<WorldPoint> points = SixTags(camera);
  std::swap(points[1].p_in_world, points[5].p_in_world);
  const auto rms_mm = [&] { return 1e3 * WorldFromPoints(camera, points, "").residual_m; };
  CHECK_THROWS_WITH(CheckPoints(camera, points, kLimit_m),
                    fmt::format("{}{:.1f} mm RMS (limit 5 mm): tag 2 and tag 6 are swapped: with "
                                "their places exchanged all fit",
                                head, rms_mm()));
  points = SixTags(camera);
  points[3].p_in_world.x() += 0.012;
  const double worst_mm = 1e3 * LeaveOneOut_m(camera, points)[3];
  REQUIRE(rms_mm() < 5.0);
  CHECK(worst_mm == Approx(12.0).margin(1.0));
  CHECK_THROWS_WITH(
      CheckPoints(camera, points, kLimit_m),
      fmt::format("{0}{1:.1f} mm RMS, and one {2:.1f} mm off where the others put it (limit 5 mm, "
                  "for one twice that): tag 4 is wrong: the others put it {2:.1f} mm away; measure "
                  "it again",
                  head, rms_mm(), worst_mm));
  points = SixTags(camera);
  for (WorldPoint& point : points) point.p_in_world.x() *= 1.1;
  CHECK_THROWS_WITH(
      CheckPoints(camera, points, kLimit_m),
      fmt::format("{}{:.1f} mm RMS (limit 5 mm): more than one is wrong, or the scale "
                  "differs in x and y: measure them again",
                  head, rms_mm()));
}

}  // namespace
}  // namespace rift::vision
