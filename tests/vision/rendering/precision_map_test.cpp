// What rift track --check predicts, held to a tag that another renderer shows.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "rift/geometry/pose2.hpp"
#include "rift/vision/rendering/precision_map.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"
#include "rift/vision/tracking/tag_visibility.hpp"
#include "vision/ray_renderer.hpp"
#include "vision/small_recording.hpp"

namespace rift::vision {
namespace {

using test::HungCamera;
using test::RayRenderer;
using test::RayTag;

/// The look of RayRenderer, whose light is even.
SyntheticCameraOptions LookOfRays() {
  SyntheticCameraOptions look;
  look.blur_px = 0.7;
  look.noise_grey = 3.0;
  look.falloff = 0.0;
  return look;
}

struct Squares {
  double predicted_m2 = 0.0, measured_m2 = 0.0, predicted_rad2 = 0.0, measured_rad2 = 0.0;
  int predicted = 0, measured = 0;

  double PositionRatio() const {
    return std::sqrt((measured_m2 / measured) / (predicted_m2 / predicted));
  }
  double YawRatio() const {
    return std::sqrt((measured_rad2 / measured) / (predicted_rad2 / predicted));
  }
};

/// The same places as the map's, with the rays' pictures of the tag.
Squares AtPlaces(const CameraModel& camera, const PrecisionMap& map, double least_px) {
  RayRenderer renderer(camera);
  TagTracker tracker(camera, {});
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  Squares squares;
  double t_s = 0.0;
  for (const PrecisionPlace& place : map.places) {
    if (!place.floor_m || place.side_px < least_px || place.found < place.views) continue;
    for (std::size_t i = 0; i < place.off_m.size(); ++i) {
      squares.predicted_m2 += std::pow(place.off_m[i], 2);
      squares.predicted_rad2 += std::pow(place.yaw_off_rad[i], 2);
      ++squares.predicted;
    }
    for (int view = 0; view < place.views; ++view) {
      const RayTag tag{.x_m = place.floor_m->x() + 0.001 * u(random),
                       .y_m = place.floor_m->y() + 0.001 * u(random),
                       .yaw_rad = M_PI * u(random)};
      Frame frame = renderer.Render({tag});
      tracker.Forget();
      TrackResult result;
      for (int attempt = 0; attempt < 3 && !result.sighting; ++attempt) {
        frame.captured_s = t_s += 0.03;
        result = tracker.Track(frame);
      }
      REQUIRE(result.sighting);
      const geometry::Pose2 pose = result.sighting->Planar();
      squares.measured_m2 += (pose.Position() - Eigen::Vector2d(tag.x_m, tag.y_m)).squaredNorm();
      squares.measured_rad2 += std::pow(geometry::WrapToPi(pose.yaw_rad - tag.yaw_rad), 2);
      ++squares.measured;
    }
  }
  return squares;
}

TEST_CASE("The predicted precision is that of another renderer's pictures within 20 percent") {
  const double tilt_deg = GENERATE(0.0, 35.0);
  const CameraModel camera = HungCamera(0.95, tilt_deg, 700.0);
  const PrecisionMap map =
      PredictPrecision(camera, {}, LookOfRays(), {.columns = 6, .rows = 4, .views = 6});
  REQUIRE(map.places.size() == 24);
  const Squares squares = AtPlaces(camera, map, kGoodSide_px);
  INFO("tilt " << tilt_deg << " deg, " << squares.measured << " views: position "
               << squares.PositionRatio() << ", heading " << squares.YawRatio());
  REQUIRE(squares.measured >= 90);
  CHECK(squares.PositionRatio() > 0.8);
  CHECK(squares.PositionRatio() < 1.2);
  CHECK(squares.YawRatio() > 0.8);
  CHECK(squares.YawRatio() < 1.2);
}

TEST_CASE("The smallest tag that a precision map names is found, and one of half its side is not") {
  const CameraModel camera = HungCamera(0.95, 20.0, 700.0);
  const PrecisionMap map =
      PredictPrecision(camera, {}, LookOfRays(), {.columns = 3, .rows = 3, .views = 2});
  CHECK(map.least_side_px > 8.0);
  CHECK(map.least_side_px <= kGoodSide_px);
  RayRenderer renderer(camera);
  const auto is_found = [&](const PrecisionPlace& place, double size_m) {
    TagOptions options;
    options.size_m = size_m;
    TagTracker tracker(camera, options);
    Frame frame = renderer.Render(
        {{.x_m = place.floor_m->x(), .y_m = place.floor_m->y(), .yaw_rad = 0.4, .size_m = size_m}});
    for (int attempt = 0; attempt < 3; ++attempt) {
      frame.captured_s += 0.03;
      if (tracker.Track(frame).sighting) return true;
    }
    return false;
  };
  int places = 0;
  for (const PrecisionPlace& place : map.places) {
    if (!place.least_size_m) continue;
    ++places;
    INFO("place at " << place.at_px.transpose() << " px: " << *place.least_size_m << " m");
    CHECK(is_found(place, 1.15 * *place.least_size_m));
    CHECK_FALSE(is_found(place, 0.5 * *place.least_size_m));
  }
  CHECK(places == 9);
}

TEST_CASE("A precision map shows where the picture has no floor, and needs a world frame") {
  CameraModel camera = HungCamera(0.5, 75.0, 700.0);
  const PrecisionMap map =
      PredictPrecision(camera, {}, LookOfRays(), {.columns = 1, .rows = 4, .views = 1});
  CHECK_FALSE(map.places.front().floor_m);
  CHECK(map.places.back().floor_m);
  CHECK(map.places.back().shift_by_height > 1.0);
  camera.world.reset();
  CHECK_THROWS_WITH(PredictPrecision(camera, {}, LookOfRays(), {}),
                    Catch::Contains("no world frame"));
}

TEST_CASE("Places lie evenly over the picture, each with its floor, its side and its slant") {
  const CameraModel camera = test::SmallCamera();
  std::vector<std::pair<int, int>> told;
  const PrecisionMap map =
      PredictPrecision(camera, {}, LookOfRays(), {.columns = 2, .rows = 1, .views = 2},
                       [&](int done, int all) { told.emplace_back(done, all); });
  CHECK(told == std::vector<std::pair<int, int>>{{1, 2}, {2, 2}});
  CHECK((map.columns == 2 && map.rows == 1));
  REQUIRE(map.places.size() == 2);
  const double side_px = 610.0 * 0.0475 / 0.57;
  for (int i = 0; i < 2; ++i) {
    const PrecisionPlace& place = map.places[static_cast<std::size_t>(i)];
    CHECK(place.at_px == Eigen::Vector2d(160.0 + 320.0 * i, 240.0));
    REQUIRE(place.floor_m);
    const Eigen::Vector2d expected((place.at_px.x() - 319.5) / 610.0 * 0.57, -0.5 / 610.0 * 0.57);
    CHECK((*place.floor_m - expected).norm() < 1e-9);
    CHECK(place.side_px == Approx(side_px));
    CHECK(place.shift_by_height == Approx(expected.norm() / 0.57));
    CHECK((place.views == 2 && place.found == 2));
    REQUIRE((place.off_m.size() == 2 && place.yaw_off_rad.size() == 2));
    for (const double off_m : place.off_m) CHECK((off_m > 0.0 && off_m < 3e-4));
    for (const double off_rad : place.yaw_off_rad) CHECK((off_rad > 0.0 && off_rad < 5e-3));
    CHECK(*place.least_size_m == Approx(0.0475 * map.least_side_px / side_px));
  }
  // Halved from 6 and 48 px until they are within one: by 42 / 64.
  const double steps = (map.least_side_px - 6.0) * 64.0 / 42.0;
  CHECK(steps == Approx(std::round(steps)).margin(1e-9));
}

}  // namespace
}  // namespace rift::vision
