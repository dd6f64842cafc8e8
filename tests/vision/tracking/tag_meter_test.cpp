#include "vision/tracking/tag_meter.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "rift/vision/camera/picture_reader.hpp"
#include "vision/small_recording.hpp"
#include "vision/tracking/edge_fit.hpp"

namespace rift::vision {
namespace {

TEST_CASE("From 245 grey values of white on a picture is too bright to tell a tag's height") {
  // 15 mm above the floor, far off it.
  const CameraModel camera = test::SmallCamera();
  const RobotMotion robot = test::RobotAt(0.02, 0.01, 0.3, 0.045);
  const TagCorners corners = test::TrueCorners(camera, robot);
  const TagOptions options{.max_fit_px = 5.0};
  double highest_below = 0.0, lowest_above = 255.0;
  for (const double white_grey : {244.0, 245.0, 246.0, 247.0}) {
    SyntheticCamera renderer(
        camera, {.grain_grey = 0.0, .falloff = 0.0, .white_grey = white_grey, .noise_grey = 0.0});
    std::mt19937_64 random(1);
    const GreyPatch patch =
        *PictureReader().Read(renderer.Render(robot, PixelFormat::kGrey, random));
    const auto square = FitSquare(camera, patch, corners, ShapeOf(TagFamily::k36h11), 30.0,
                                  {options.edge_sigma_px, options.shared_sigma_px, 8});
    REQUIRE(square);
    const auto seen = TagMeter(camera, options)
                          .Measure(patch, corners, CellsOfTag(0), TrackMode::kRegion, std::nullopt)
                          .sighting;
    REQUIRE(seen);
    INFO("white " << square->white_grey);
    CHECK(seen->is_on_floor == (square->white_grey > 245.0));
    if (square->white_grey > 245.0) lowest_above = std::min(lowest_above, square->white_grey);
    if (square->white_grey <= 245.0) highest_below = std::max(highest_below, square->white_grey);
  }
  // The limit was looked at from either side.
  CHECK(highest_below > 244.0);
  CHECK(lowest_above < 246.0);
}

TEST_CASE("A sighting without a floor is free, and in the world where the camera has one") {
  CameraModel camera = test::SmallCamera();
  const RobotMotion robot = test::RobotAt(0.02, 0.01, 0.3);
  SyntheticCamera renderer(camera, {.noise_grey = 0.0});
  std::mt19937_64 random(1);
  const GreyPatch patch = *PictureReader().Read(renderer.Render(robot, PixelFormat::kGrey, random));
  const TagCorners corners = test::TrueCorners(camera, robot);
  const auto measure = [&](const CameraModel& by, TrackMode mode) {
    return *TagMeter(by, {}).Measure(patch, corners, CellsOfTag(0), mode, std::nullopt).sighting;
  };
  const Sighting in_world = measure(camera, TrackMode::kEdges);
  CHECK(in_world.mode == TrackMode::kEdges);
  CHECK(in_world.in_world);
  CHECK(in_world.is_on_floor);
  CHECK(in_world.map_from_tag.isApprox(camera.world->world_from_camera * in_world.camera_from_tag));
  camera.world->origin = kFirstPoseOrigin;
  const Sighting free = measure(camera, TrackMode::kPicture);
  CHECK(free.mode == TrackMode::kPicture);
  CHECK(free.in_world);
  CHECK_FALSE(free.is_on_floor);
  camera.world.reset();
  const Sighting nowhere = measure(camera, TrackMode::kRegion);
  CHECK_FALSE(nowhere.in_world);
  CHECK_FALSE(nowhere.is_on_floor);
  for (int i = 0; i < 4; ++i) CHECK((nowhere.corners[i] - corners[i]).norm() < 0.1);
}

}  // namespace
}  // namespace rift::vision
