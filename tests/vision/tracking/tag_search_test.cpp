// How finely and how far around its last place the tracker looks for a tag that it lost.
#include <catch2/catch.hpp>
#include <optional>
#include <random>
#include <string>

#include "rift/vision/tracking/tag_tracker.hpp"
#include "vision/rendered_tags.hpp"
#include "vision/small_recording.hpp"

namespace rift::vision {
namespace {

/// A grey picture with the robot there, at this time.
Frame Shot(SyntheticCamera& camera, const std::optional<RobotMotion>& robot, double at_s) {
  std::mt19937_64 random(3);
  Frame frame = camera.Render(robot, PixelFormat::kGrey, random);
  frame.captured_s = at_s;
  return frame;
}

TEST_CASE("Each further picture is searched finer, the third one whole, and then from the start") {
  // A tag of 17.5 px, which is not found where every fourth pixel is looked at.
  constexpr double kSize_m = 17.5 * 0.57 / 610.0;
  const CameraModel model = test::SmallCamera();
  SyntheticCamera camera(model, {.tag_size_m = kSize_m, .noise_grey = 1.0});
  const Frame tag = Shot(camera, test::RobotAt(0.02, 0.01, 0.3), 0.0),
              none = Shot(camera, std::nullopt, 0.0);
  for (const int acquire_decimate : {7, 8}) {
    const auto seen = [&](const std::string& pictures) {
      TagTracker tracker(
          model, {.size_m = kSize_m, .acquire_decimate = acquire_decimate, .search_px = 1.0});
      std::string found;
      double t_s = 0.0;
      for (const char picture : pictures) {
        Frame frame = picture == 't' ? tag : none;
        frame.captured_s = t_s += 1.0;  // nothing is gone on with from one to the next
        found += tracker.Track(frame).sighting ? 'y' : '-';
      }
      return found;
    };
    // Every seventh or eighth pixel, then every fourth, then each.
    CHECK(seen("ttt") == "--y");
    CHECK(seen("..t") == "--y");
    CHECK(seen("...ttt") == "-----y");
    CHECK(seen(".....t") == "-----y");
    CHECK(seen("....tt") == "-----y");
  }
}

TEST_CASE("A lost tag is looked for within 400 px of its last place, however long it was away") {
  // 32 px of tag, which is not found where every eighth pixel is looked at.
  const CameraModel model = test::SmallCamera();
  const TagOptions options{.size_m = 0.03, .acquire_decimate = 8, .search_px = 4.0};
  SyntheticCamera camera(model, {.tag_size_m = 0.03, .noise_grey = 1.0});
  constexpr double kMetre_px = 610.0 / 0.57;
  for (const auto& [moved_px, is_found] : {std::pair{380.0, true}, {425.0, false}}) {
    TagTracker tracker(model, options);
    const double first_m = -220.0 / kMetre_px;
    const Frame begin = Shot(camera, test::RobotAt(first_m, 0.0, 0.0), 0.0);
    REQUIRE_FALSE(tracker.Track(begin).sighting);
    Frame again = begin;
    again.captured_s = 0.03;
    REQUIRE(tracker.Track(again).sighting);
    // In 1 s and at 1.5 m/s it can have got 1600 px from there.
    const double now_m = first_m + moved_px / kMetre_px;
    const TrackResult result = tracker.Track(Shot(camera, test::RobotAt(now_m, 0.0, 0.0), 1.03));
    INFO(moved_px);
    REQUIRE(result.sighting.has_value() == is_found);
    if (is_found) CHECK(result.sighting->mode == TrackMode::kRegion);
  }
}

TEST_CASE("Around a tag as much is read as is asked for, and what is printed around its square") {
  const CameraModel model = test::SmallCamera();
  for (const TagFamily family : {TagFamily::k36h11, TagFamily::kStandard41h12}) {
    INFO(NameOf(family));
    const double size_m = family == TagFamily::k36h11 ? 0.0475 : 0.03;
    SyntheticCameraOptions look{.tag_family = family, .noise_grey = 1.0};
    look.tag_size_m = size_m;
    SyntheticCamera camera(model, look);
    TagTracker tracker(
        model, {.family = family, .size_m = size_m, .acquire_decimate = 1, .region_margin = 0.2});
    for (int i = 0; i < 3; ++i) {
      const TrackResult still =
          tracker.Track(Shot(camera, test::RobotAt(0.01, 0.02, 0.0), 0.03 * i));
      REQUIRE(still.sighting);
      CHECK(still.sighting->mode == (i == 0 ? TrackMode::kPicture : TrackMode::kEdges));
    }
    // Moved by 0.7 of a cell its edges are still in what is read.
    const double cell_m = size_m / ShapeOf(family).square;
    const TrackResult moved =
        tracker.Track(Shot(camera, test::RobotAt(0.01 + 0.7 * cell_m, 0.02, 0.0), 0.09));
    REQUIRE(moved.sighting);
    CHECK(moved.sighting->mode == TrackMode::kEdges);
  }
}

}  // namespace
}  // namespace rift::vision
