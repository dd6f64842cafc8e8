#include "rift/vision/tracking/tag_visibility.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "rift/vision/tracking/off_floor.hpp"
#include "support/mirror.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

/// 600 px a radian, 640 x 480, 2.03 m above the floor, its view `tilt_rad` from straight down
/// towards +y.
CameraModel Above(double tilt_rad) {
  CameraModel camera{.name = "above", .width_px = 640, .height_px = 480};
  camera.k << 600.0, 0.0, 319.5, 0.0, 600.0, 239.5, 0.0, 0.0, 1.0;
  camera.world.emplace();
  camera.world->world_from_camera.linear() =
      Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX()).toRotationMatrix() *
      Eigen::Matrix3d(Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal());
  camera.world->world_from_camera.translation() = Eigen::Vector3d(0.0, 0.0, 2.03);
  camera.world->origin = "4 reference tags";
  return camera;
}

TEST_CASE("Seen from straight above, a tag has the same short side wherever it lies") {
  const CameraModel camera = Above(0.0);
  test::OnBothSides("x", "y", [&](const test::Side& side) {
    for (const double at_m : {-0.5, 0.0, 0.5}) {
      const Eigen::Vector3d p =
          side.IsFirst() ? Eigen::Vector3d(at_m, 0.0, 0.03) : Eigen::Vector3d(0.0, at_m, 0.03);
      const auto side_px = ShortSide_px(camera, 0.05, p);
      REQUIRE(side_px);
      CHECK(*side_px == Approx(600.0 * 0.05 / 2.0));
    }
  });
  CHECK(*ShortSide_px(camera, 0.05, {0.0, 0.0, 1.03}) == Approx(30.0));  // twice as near
}

TEST_CASE("A tag that is seen at an angle is short along the way to it") {
  const double tilt_rad = 0.8, size_m = 0.05;
  const CameraModel camera = Above(tilt_rad);
  const double far_m = 2.0 * std::tan(tilt_rad);  // where the middle of the picture is
  const auto side_px = ShortSide_px(camera, size_m, {0.0, far_m, 0.03});
  REQUIRE(side_px);
  // Its near and its far edge, a height of 2 m below: the difference of the two slopes.
  const auto slope = [&](double y_m) { return std::tan(std::atan(y_m / 2.0) - tilt_rad); };
  const double foreshortened_px =
      600.0 * (slope(far_m + 0.5 * size_m) - slope(far_m - 0.5 * size_m));
  // A side runs along the way, half a side beside it.
  CHECK(*side_px == Approx(foreshortened_px).epsilon(0.002));
  CHECK(*ShortSideInMiddle_px(camera, {.size_m = size_m, .height_m = 0.03}) ==
        Approx(*side_px).epsilon(1e-6));
  CHECK_FALSE(ShortSide_px(camera, size_m, {0.0, -8.0, 0.03}));  // behind the camera
}

TEST_CASE("AprilTag leaves out no more pixels than the tag can spare") {
  const CameraModel camera = Above(0.0);
  TagOptions tag{.height_m = 0.03, .acquire_decimate = 3, .search_px = 14.0};
  const auto with_side = [&](double side_px) {
    tag.size_m = side_px * 2.0 / 600.0;
    return DecimateFor(camera, tag);
  };
  CHECK(with_side(10.0) == 1);
  CHECK(with_side(27.9) == 1);
  CHECK(with_side(28.1) == 2);
  CHECK(with_side(41.9) == 2);
  CHECK(with_side(42.1) == 3);
  CHECK(with_side(200.0) == 3);
  tag.family = TagFamily::kStandard41h12;  // five cells a side: as easy as eight of 8 / 5 the side
  CHECK(with_side(17.4) == 1);
  CHECK(with_side(17.6) == 2);
  CameraModel no_world = camera;
  no_world.world.reset();
  CHECK(DecimateFor(no_world, tag) == 3);
  CHECK_FALSE(ShortSideInMiddle_px(no_world, tag));
}

TEST_CASE("A tag too small to be measured well, or at all, is said with what would do") {
  const CameraModel camera = Above(0.0);
  TagOptions tag{.height_m = 0.03};
  const auto with_side = [&](double side_px) {
    tag.size_m = side_px * 2.0 / 600.0;
    return SmallTagWarning(camera, tag).value_or("");
  };
  CHECK(with_side(20.1).empty());
  CHECK_THAT(with_side(18.0), Contains("the tag of 0.06 m has 18 px in the middle") &&
                                  Contains("good are 20: poses will be coarse") &&
                                  Contains("1.2 times as large"));
  CHECK_THAT(with_side(15.0),
             Contains("it takes 16: it will not be found") && Contains("1.5 times as large"));
  CHECK(LeastSide_px(TagFamily::kStandard41h12) == 10.0);
  CameraModel no_world = camera;
  no_world.world.reset();
  CHECK_FALSE(SmallTagWarning(no_world, tag));
}

Sighting SeenAt(double z_m, bool is_on_floor) {
  Sighting sighting;
  sighting.in_world = true;
  sighting.is_on_floor = is_on_floor;
  sighting.map_from_tag.translation().z() = z_m;
  return sighting;
}

TEST_CASE("A tag that is hardly ever on the floor is said once, with its side and its height") {
  const CameraModel camera = Above(0.0);
  const TagOptions tag{.size_m = 0.05, .height_m = 0.03};
  OffFloorCheck check(camera, tag);
  for (int i = 0; i < 9; ++i) CHECK_FALSE(check.Add(SeenAt(0.10 + 0.01 * (i % 3), false)));
  const auto warning = check.Add(SeenAt(0.11, false));
  REQUIRE(warning);
  // At 0.11 m the tag is 1.92 m below the camera, not 2: its side would be 0.05 * 2 / 1.92.
  CHECK_THAT(*warning, Contains("in 10 of 10 pictures (z 0.110 m, track.tag.height_m 0.03)") &&
                           Contains("is its side 0.0521 m (--set track.tag.size_m=0.0521)") &&
                           Contains("its height 0.110 m (--tag-height 0.110)") &&
                           Contains("was the camera moved"));
  CHECK_FALSE(check.Add(SeenAt(0.11, false)));
}

TEST_CASE("A tag that is on the floor in more than a tenth of the pictures is not said") {
  const CameraModel camera = Above(0.0);
  const TagOptions tag;
  OffFloorCheck rarely(camera, tag), often(camera, tag);
  CHECK_FALSE(rarely.Add(SeenAt(0.03, true)));
  CHECK_FALSE(often.Add(SeenAt(0.03, true)));
  CHECK_FALSE(often.Add(SeenAt(0.03, true)));
  int said_rarely = 0, said_often = 0;
  for (int i = 0; i < 10; ++i) {
    said_rarely += rarely.Add(SeenAt(0.2, false)).has_value();
    said_often += often.Add(SeenAt(0.2, false)).has_value();
  }
  CHECK(said_rarely == 1);  // 10 of 11
  CHECK(said_often == 0);   // 10 of 12
  for (int i = 11; i < 18; ++i) CHECK_FALSE(often.Add(SeenAt(0.2, false)));
  CHECK(often.Add(SeenAt(0.2, false)));  // 18 of 20
}

TEST_CASE("No floor, no word of it: free ground, no world frame, a height that nobody can set") {
  CameraModel camera = Above(0.0);
  const TagOptions flat, free{.ground = Ground::kFree};
  OffFloorCheck on_ramps(camera, free), below(camera, flat);
  std::optional<std::string> of_ramps, of_below;
  for (int i = 0; i < 20; ++i) {
    if (const auto said = on_ramps.Add(SeenAt(0.2, false))) of_ramps = said;
    if (const auto said = below.Add(SeenAt(-0.1, false))) of_below = said;
  }
  CHECK_FALSE(of_ramps);
  REQUIRE(of_below);
  CHECK_THAT(*of_below, !Contains("--tag-height"));
  // A frame with z downwards: no side of a tag makes up for it.
  CameraModel upside_down = camera;
  upside_down.world->world_from_camera.translation().z() *= -1.0;
  OffFloorCheck from_below(upside_down, flat);
  std::optional<std::string> of_frame;
  for (int i = 0; i < 20; ++i) {
    if (const auto said = from_below.Add(SeenAt(0.2, false))) of_frame = said;
  }
  REQUIRE(of_frame);
  CHECK_THAT(*of_frame, Contains("the world frame puts the camera at z -2.0") &&
                            Contains("below the tag at 0.200 m") && !Contains("size_m"));
  // A frame from a first pose knows no floor either, and holds no tag to one.
  CameraModel first_pose = camera;
  first_pose.world->origin = kFirstPoseOrigin;
  OffFloorCheck from_robot(first_pose, flat);
  for (int i = 0; i < 20; ++i) CHECK_FALSE(from_robot.Add(SeenAt(0.03, false)));
  camera.world.reset();
  OffFloorCheck no_world(camera, flat);
  for (int i = 0; i < 20; ++i) CHECK_FALSE(no_world.Add(SeenAt(0.2, false)));
}

TEST_CASE("The height of a tag off the floor is the median of those that are in the world") {
  const CameraModel camera = Above(0.0);
  const TagOptions tag{.size_m = 0.05, .height_m = 0.03};
  OffFloorCheck check(camera, tag);
  Sighting elsewhere = SeenAt(0.03, true);
  elsewhere.in_world = false;
  for (int i = 0; i < 5; ++i) CHECK_FALSE(check.Add(elsewhere));
  // One outlier, at 1.5 m, takes the mean of ten to 0.249 m.
  std::optional<std::string> said;
  for (int i = 0; i < 10; ++i) said = check.Add(SeenAt(i == 3 ? 1.5 : 0.11, false));
  REQUIRE(said);
  CHECK_THAT(*said, Contains("in 10 of 10 pictures (z 0.110 m"));
}

TEST_CASE(
    "A height is proposed up to two metres, and nothing of a camera below the tag or its floor") {
  const auto said_at = [](double camera_m, double z_m, double height_m) {
    CameraModel camera = Above(0.0);
    camera.world->world_from_camera.translation().z() = camera_m;
    const TagOptions tag{.size_m = 0.05, .height_m = height_m};
    OffFloorCheck check(camera, tag);
    std::optional<std::string> said;
    for (int i = 0; i < 10; ++i) said = check.Add(SeenAt(z_m, false));
    return said.value_or("");
  };
  CHECK_THAT(said_at(3.0, 2.0, 0.03), Contains("--tag-height 2.000"));
  CHECK_THAT(said_at(3.0, 2.001, 0.03), Contains("is its side") && !Contains("--tag-height"));
  CHECK_THAT(said_at(3.0, 0.0, 0.03), Contains("--tag-height 0.000"));
  // Between the tag's floor and where it is seen, on either side.
  CHECK_THAT(said_at(0.1, 0.2, 0.03),
             Contains("puts the camera at z 0.100 m, below the tag at 0.200"));
  CHECK_THAT(said_at(0.1, 0.03, 0.2),
             Contains("puts the camera at z 0.100 m, below the tag at 0.200"));
}

TEST_CASE("What is said of a small tag and of one off the floor is a whole line each") {
  const CameraModel camera = Above(0.0);
  const auto with_side = [&](double side_px) {
    return SmallTagWarning(camera, {.size_m = side_px * 2.0 / 600.0, .height_m = 0.03})
        .value_or("");
  };
  CHECK(with_side(18.0) ==
        "the tag of 0.06 m has 18 px in the middle of the picture, good are 20: poses will be "
        "coarse; lower the camera, take more pixels, or print the tag 1.2 times as large");
  CHECK(with_side(15.0) ==
        "the tag of 0.05 m has 15 px in the middle of the picture, it takes 16: it will not be "
        "found; lower the camera, take more pixels, or print the tag 1.5 times as large");
  CHECK_THAT(with_side(16.1), Contains("good are 20: poses will be coarse"));
  const auto said = [](double camera_m, double z_m) {
    CameraModel hung = Above(0.0);
    hung.world->world_from_camera.translation().z() = camera_m;
    const TagOptions tag{.size_m = 0.05, .height_m = 0.03};
    OffFloorCheck check(hung, tag);
    check.Add(SeenAt(0.03, true));
    std::optional<std::string> text;
    for (int i = 0; i < 10; ++i) text = check.Add(SeenAt(z_m, false));
    return text.value_or("");
  };
  CHECK(said(2.03, 0.11) ==
        "the tag is not on the floor in 10 of 11 pictures (z 0.110 m, track.tag.height_m 0.03): is "
        "its side 0.0521 m (--set track.tag.size_m=0.0521), its height 0.110 m (--tag-height "
        "0.110), or was the camera moved since its world frame was set?");
  CHECK(said(2.03, -0.37) ==
        "the tag is not on the floor in 10 of 11 pictures (z -0.370 m, track.tag.height_m 0.03): "
        "is its side 0.0417 m (--set track.tag.size_m=0.0417), or was the camera moved since its "
        "world frame was set?");
  CHECK(said(0.1, 0.25) ==
        "the world frame puts the camera at z 0.100 m, below the tag at 0.250 m: set the frame "
        "again (--world), z is up");
}

}  // namespace
}  // namespace rift::vision
