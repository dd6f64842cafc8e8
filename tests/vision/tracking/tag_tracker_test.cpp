#include "rift/vision/tracking/tag_tracker.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "rift/geometry/pose2.hpp"
#include "support/mirror.hpp"
#include "vision/rendered_tags.hpp"
#include "vision/small_recording.hpp"

namespace rift::vision {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;

/// Frames of a robot with times as a camera of 30 fps gives them.
class Film {
 public:
  explicit Film(const CameraModel& camera, const SyntheticCameraOptions& options = {},
                const Scene& scene = {})
      : renderer_(camera, options, scene) {}
  Frame Next(const std::optional<RobotMotion>& robot, PixelFormat format = PixelFormat::kGrey) {
    Frame frame = renderer_.Render(robot, format, generator_);
    frame.index = index_;
    frame.captured_s = 100.0 + kFrame_s * static_cast<double>(index_++);
    return frame;
  }

 private:
  SyntheticCamera renderer_;
  std::mt19937_64 generator_{1};
  std::uint64_t index_ = 0;
};

/// How far sightings are from the truth, over many.
struct Errors {
  int missed = 0;
  int flipped = 0;
  double corner2_px2 = 0.0;
  int corners = 0;
  double side_px = 0.0;
  double worst_position_m = 0.0;
  double worst_yaw_rad = 0.0;
  double position_in_sigmas2 = 0.0;
  double yaw_in_sigmas2 = 0.0;
  int seen = 0;

  void Add(const CameraModel& camera, const RobotMotion& robot, const TrackResult& result) {
    if (!result.sighting) {
      ++missed;
      return;
    }
    const Sighting& sighting = *result.sighting;
    ++seen;
    const TagCorners truth = test::TrueCorners(camera, robot);
    for (int i = 0; i < 4; ++i) {
      corner2_px2 += (sighting.corners[i] - truth[i]).squaredNorm();
      side_px += (truth[(i + 1) % 4] - truth[i]).norm();
      ++corners;
    }
    const Eigen::Matrix3d turn =
        sighting.map_from_tag.linear() * robot.world_from_tag.linear().transpose();
    if (Eigen::AngleAxisd(turn).angle() > 0.1) ++flipped;
    REQUIRE(sighting.map_from_tag.linear().determinant() == Approx(1.0));
    const Eigen::Vector3d& true_place = robot.world_from_tag.translation();
    const Eigen::Vector2d off = (sighting.map_from_tag.translation() - true_place).head<2>();
    const Eigen::Vector3d forward = robot.world_from_tag.linear().col(0);
    const double yaw_off =
        geometry::WrapToPi(sighting.Planar().yaw_rad - std::atan2(forward.y(), forward.x()));
    worst_position_m = std::max(worst_position_m, off.norm());
    worst_yaw_rad = std::max(worst_yaw_rad, std::abs(yaw_off));
    position_in_sigmas2 += off.dot(sighting.covariance.topLeftCorner<2, 2>().inverse() * off) / 2.0;
    yaw_in_sigmas2 += yaw_off * yaw_off / sighting.covariance(5, 5);
  }
  double CornerRms_px() const { return std::sqrt(corner2_px2 / corners); }
};

Errors Acquire(const CameraModel& camera, const std::vector<RobotMotion>& robots,
               PixelFormat format, const TagOptions& options = {}) {
  Film film(camera);
  TagTracker tracker(camera, options);
  Errors errors;
  for (const RobotMotion& robot : robots) {
    tracker.Forget();
    errors.Add(camera, robot, tracker.Track(film.Next(robot, format)));
  }
  return errors;
}

TEST_CASE(
    "A picture of another size than its camera was calibrated at is refused with both sizes") {
  TagTracker tracker(test::SmallCamera(), {});
  for (const auto& [width_px, height_px] : {std::pair{641, 480}, {640, 479}}) {
    Frame frame;
    frame.width_px = width_px;
    frame.height_px = height_px;
    CHECK_THROWS_WITH(
        tracker.Track(frame),
        fmt::format("frames are {} x {} but camera small was calibrated at 640 x 480: "
                    "set the stream to that size or calibrate again",
                    width_px, height_px));
  }
}

TEST_CASE("A 75 px tag is found wherever it is and its corners to a twentieth of a pixel") {
  const CameraModel camera = test::PaperCamera(0.72);
  const Errors errors = Acquire(camera, test::RandomRobots(camera, 80), PixelFormat::kJpeg);
  CHECK(errors.side_px / errors.corners == Approx(75.0).margin(5.0));
  CHECK(errors.missed == 0);
  CHECK(errors.flipped == 0);
  CHECK(errors.CornerRms_px() < 0.035);
  CHECK(errors.worst_position_m < 0.0005);
  CHECK(geometry::DegFromRad(errors.worst_yaw_rad) < 0.1);
}

TEST_CASE("A 62 px tag is found wherever it is and its covariance says how well") {
  const CameraModel camera = test::PaperCamera(0.87);
  const Errors errors = Acquire(camera, test::RandomRobots(camera, 80), PixelFormat::kGrey);
  CHECK(errors.missed == 0);
  CHECK(errors.flipped == 0);
  CHECK(errors.CornerRms_px() < 0.04);
  CHECK(errors.worst_position_m < 0.0006);
  CHECK(geometry::DegFromRad(errors.worst_yaw_rad) < 0.1);
  // The stated scatter of a corner is that of a small tag: rather too careful than too sure.
  CHECK(errors.position_in_sigmas2 / errors.seen == Approx(0.8).margin(0.5));
  CHECK(errors.yaw_in_sigmas2 / errors.seen == Approx(0.8).margin(0.5));
}

TEST_CASE("A tag that leans as on the ramp is not flipped") {
  const CameraModel camera = test::PaperCamera(0.87);
  TagOptions options;
  options.ground = Ground::kFree;
  const Errors errors =
      Acquire(camera, test::RandomRobots(camera, 50, 0.2404), PixelFormat::kGrey, options);
  CHECK(errors.missed == 0);
  CHECK(errors.flipped == 0);
}

/// At v = 0.6 m/s on a circle of 0.2 m: faster than the robot drives.
RobotMotion OnCircle(double t_s) {
  const double angle = 3.0 * t_s;
  return test::RobotAt(0.2 * std::cos(angle), 0.1 + 0.2 * std::sin(angle), angle + 1.57);
}

TEST_CASE("A driving robot is followed by its edges after two frames") {
  const CameraModel camera = test::PaperCamera();
  Film film(camera);
  TagTracker tracker(camera, {});
  Errors errors;
  for (int i = 0; i < 40; ++i) {
    const RobotMotion robot = OnCircle(i * kFrame_s);
    const TrackResult result = tracker.Track(film.Next(robot));
    errors.Add(camera, robot, result);
    REQUIRE(result.sighting);
    CHECK(result.sighting->frame_index == static_cast<std::uint64_t>(i));
    CHECK((result.sighting->mode == TrackMode::kPicture) == (i == 0));
    if (i >= 2) CHECK(result.sighting->mode == TrackMode::kEdges);
  }
  CHECK(errors.CornerRms_px() < 0.04);
  CHECK(errors.worst_position_m < 0.0005);
}

TEST_CASE("A robot that is put elsewhere is found again in the same frame") {
  const CameraModel camera = test::PaperCamera();
  Film film(camera);
  TagTracker tracker(camera, {});
  tracker.Track(film.Next(test::RobotAt(0.0, 0.0, 0.0)));
  CHECK(tracker.Track(film.Next(test::RobotAt(0.0, 0.0, 0.0))).sighting->mode == TrackMode::kEdges);
  const TrackResult nudged = tracker.Track(film.Next(test::RobotAt(0.008, 0.004, 0.4)));
  REQUIRE(nudged.sighting);
  CHECK(nudged.sighting->mode == TrackMode::kRegion);
  const TrackResult carried = tracker.Track(film.Next(test::RobotAt(0.3, 0.2, 2.0)));
  REQUIRE(carried.sighting);
  CHECK(carried.sighting->mode == TrackMode::kPicture);
  CHECK(carried.sighting->Planar().x_m == Approx(0.3).margin(0.0005));
}

TEST_CASE("A turn by a quarter between two frames does not fool the edges") {
  const CameraModel camera = test::PaperCamera();
  Film film(camera);
  TagTracker tracker(camera, {});
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double yaw_rad = geometry::WrapToPi(0.3 + quarter * geometry::kPi / 2);
    const TrackResult result = tracker.Track(film.Next(test::RobotAt(0.1, 0.0, yaw_rad)));
    REQUIRE(result.sighting);
    CHECK(geometry::WrapToPi(result.sighting->Planar().yaw_rad - yaw_rad) ==
          Approx(0.0).margin(0.002));
  }
}

TEST_CASE("What stands in the way of a sighting is named") {
  const CameraModel camera = test::PaperCamera();
  TagTracker tracker(camera, {});
  const auto robot = test::RobotAt(0.0, 0.0, 0.0);
  CHECK(tracker.Track(Film(camera).Next({})).miss == Miss::kNoTag);
  SyntheticCameraOptions other;
  other.tag_id = 5;
  CHECK(tracker.Track(Film(camera, other).Next(robot)).miss == Miss::kOtherTag);
  Frame damaged = Film(camera).Next(robot, PixelFormat::kJpeg);
  damaged.bytes.resize(damaged.bytes.size() / 3);
  const TrackResult none = tracker.Track(damaged);
  CHECK(none.miss == Miss::kDamagedFrame);
  CHECK_FALSE(none.sighting);
  const TrackResult found = tracker.Track(Film(camera).Next(robot));
  CHECK(found.sighting);
  CHECK(found.miss == Miss::kNone);
}

TEST_CASE("Another tag in the robot's place is not taken for the robot") {
  const CameraModel camera = test::PaperCamera();
  SyntheticCameraOptions other;
  other.tag_id = 5;
  Film film(camera), impostor(camera, other);
  TagTracker tracker(camera, {});
  tracker.Track(film.Next(test::RobotAt(0.0, 0.0, 0.0)));
  impostor.Next({});
  const TrackResult result = tracker.Track(impostor.Next(test::RobotAt(0.0, 0.0, 0.0)));
  CHECK_FALSE(result.sighting);
  CHECK(result.miss == Miss::kOtherTag);
}

TEST_CASE("A second tag of the same id is counted and does not steal the track") {
  const CameraModel camera = test::PaperCamera();
  Scene scene;
  scene.tags.push_back({0, 0.0475, Eigen::Isometry3d(Eigen::Translation3d(0.4, 0.2, 0.0))});
  Film film(camera, {}, scene);
  TagOptions options;
  options.recheck_every = 3;
  TagTracker tracker(camera, options);
  Film alone(camera);
  tracker.Track(alone.Next(test::RobotAt(-0.2, 0.0, 0.0)));
  film.Next({});
  for (int i = 1; i < 6; ++i) {
    const TrackResult result = tracker.Track(film.Next(test::RobotAt(-0.2, 0.0, 0.0)));
    REQUIRE(result.sighting);
    CHECK(result.sighting->Planar().x_m == Approx(-0.2).margin(0.0005));
    CHECK(result.sighting->tags_of_this_id == (i < 3 ? 1 : 2));
    // The robot never stopped being where it can be; the other one is not in its reach.
    CHECK(result.State() == TrackState::kTracked);
  }
}

TEST_CASE("Without a world frame the pose is the camera's turned y up") {
  CameraModel camera = test::PaperCamera();
  const auto robot = test::RobotAt(0.2, 0.1, 0.7);
  const Frame frame = Film(camera).Next(robot);
  camera.world.reset();
  const TrackResult result = TagTracker(camera, {}).Track(frame);
  REQUIRE(result.sighting);
  CHECK_FALSE(result.sighting->in_world);
  const Eigen::Vector3d place = result.sighting->map_from_tag.translation();
  CHECK(place.x() == Approx(0.2).margin(0.0005));
  CHECK(place.y() == Approx(0.1).margin(0.0005));
  CHECK(place.z() == Approx(-0.84).margin(0.003));
  CHECK(result.sighting->Planar().yaw_rad == Approx(0.7).margin(0.003));
}

TEST_CASE("Latency is from capture to the tracker's clock") {
  const CameraModel camera = test::PaperCamera();
  const Frame frame = Film(camera).Next(test::RobotAt(0.0, 0.0, 0.0));
  TagTracker with_clock(camera, {}, [] { return 100.025; });
  CHECK(with_clock.Track(frame).sighting->latency_s == Approx(0.025));
  CHECK(std::isnan(TagTracker(camera, {}).Track(frame).sighting->latency_s));
}

TEST_CASE("A dim picture and a tag half as large are still read") {
  const CameraModel camera = test::PaperCamera();
  SyntheticCameraOptions dim;
  dim.exposure = 0.3;
  CHECK(
      TagTracker(camera, {}).Track(Film(camera, dim).Next(test::RobotAt(0.1, 0.0, 0.4))).sighting);
  SyntheticCameraOptions small;
  small.tag_size_m = 0.024;
  TagOptions options;
  options.size_m = 0.024;
  const TrackResult result =
      TagTracker(camera, options).Track(Film(camera, small).Next(test::RobotAt(0.1, 0.0, 0.4)));
  REQUIRE(result.sighting);
  CHECK(result.sighting->Planar().x_m == Approx(0.1).margin(0.001));
}

TEST_CASE("Frames of another size than the calibration are refused with both sizes") {
  const CameraModel camera = test::PaperCamera();
  Frame frame = Film(camera).Next({});
  frame.width_px = 1280;
  frame.height_px = 720;
  TagTracker tracker(camera, {});
  CHECK_THROWS_WITH(tracker.Track(frame),
                    Catch::Contains("1280 x 720") && Catch::Contains("1920 x 1080"));
}

TEST_CASE("An id that the family lacks is refused") {
  TagOptions options;
  options.id = 587;
  CHECK_THROWS_WITH(TagTracker(test::PaperCamera(), options), Catch::Contains("587"));
}

/// A tag of the robot's id on the floor beside it, for so many pictures and then no more.
std::vector<int> TagsSeen(const TagOptions& options, int with, int all) {
  const CameraModel camera = test::SmallCamera();
  const SyntheticCameraOptions look{.noise_grey = 1.0};
  Film both(camera, look, {.tags = {test::FloorTag(0, 0.15, 0.1)}}), alone(camera, look);
  TagTracker tracker(camera, options);
  std::vector<int> tags;
  for (int i = 0; i < all; ++i) {
    const auto robot = test::RobotAt(-0.1, 0.0, 0.0);
    const Frame beside = both.Next(robot), without = alone.Next(robot);
    const TrackResult result = tracker.Track(i < with ? beside : without);
    REQUIRE(result.sighting);
    tags.push_back(result.sighting->tags_of_this_id);
  }
  return tags;
}

TEST_CASE("The whole picture is searched again as often as is asked, and otherwise in doubt") {
  const TagOptions doubtful{.recheck_every = 100, .doubt_recheck_every = 4};
  CHECK(TagsSeen(doubtful, 1, 7) == std::vector<int>{2, 2, 2, 2, 1, 1, 1});
  const TagOptions never{.recheck_every = 0, .doubt_recheck_every = 1};
  CHECK(TagsSeen(never, 1, 4) == std::vector<int>{2, 2, 2, 2});
}

TEST_CASE("A robot that should have left the picture is not looked for in it") {
  const CameraModel camera = test::SmallCamera();
  Film film(camera, {.noise_grey = 1.0});
  TagTracker tracker(camera, {.lost_after_s = 1.0});
  REQUIRE(tracker.Track(film.Next(test::RobotAt(0.20, 0.0, 0.0))).sighting);
  REQUIRE(tracker.Track(film.Next(test::RobotAt(0.25, 0.0, 0.0))).sighting);
  for (int i = 0; i < 3; ++i) film.Next({});
  const TrackResult gone = tracker.Track(film.Next({}));
  CHECK_FALSE(gone.sighting);
  CHECK(gone.miss == Miss::kNoTag);
  REQUIRE(gone.predicted);
  CHECK(gone.predicted->Planar().x_m == Approx(0.25 + 4.0 * 0.05).margin(0.01));
  CHECK(gone.predicted->frame_index == 5);
  CHECK(gone.State() == TrackState::kPredicted);
}

TEST_CASE("A picture whose foot is damaged is none in which a second tag was looked for") {
  const CameraModel camera = test::SmallCamera();
  const SyntheticCameraOptions look{.noise_grey = 1.0};
  Film both(camera, look, {.tags = {test::FloorTag(0, 0.15, -0.15)}}), alone(camera, look);
  TagTracker tracker(camera, {.recheck_every = 100, .doubt_recheck_every = 3});
  std::vector<int> tags;
  for (int i = 0; i < 6; ++i) {
    const auto robot = test::RobotAt(-0.1, 0.15, 0.0);
    Frame frame = both.Next(robot, PixelFormat::kJpeg);
    const Frame without = alone.Next(robot, PixelFormat::kJpeg);
    // The robot is in the part that can be read; what is around it can not be searched.
    if (i == 3) frame.bytes.resize(frame.bytes.size() * 3 / 4);
    const TrackResult result = tracker.Track(i < 4 ? frame : without);
    REQUIRE(result.sighting);
    CHECK(result.sighting->mode == (i == 0 ? TrackMode::kPicture : TrackMode::kEdges));
    CHECK(result.State() == TrackState::kAmbiguous);
    tags.push_back(result.sighting->tags_of_this_id);
  }
  // It is made up for in the next one.
  CHECK(tags == std::vector<int>{2, 2, 2, 2, 1, 1});
}

/// A tag of 32 px, which is not found where every eighth pixel is looked at, but in every fourth.
const TagOptions kCoarse{.size_m = 0.03, .acquire_decimate = 8, .search_px = 4.0};
const SyntheticCameraOptions kSmallTag{.tag_size_m = 0.03, .noise_grey = 1.0};

TEST_CASE("Around its last place a tag is searched at full size, as far as it can have got") {
  const CameraModel camera = test::SmallCamera();
  Film film(camera, kSmallTag);
  // Within a thirtieth of a second 0.05 m and 1.5 m/s make 0.1 m.
  for (const auto& [x_m, y_m, is_in_reach] : {std::tuple{0.08, 0.0, true},
                                              {-0.08, 0.0, true},
                                              {0.0, 0.08, true},
                                              {0.0, -0.08, true},
                                              {0.16, 0.0, false},
                                              {0.0, -0.16, false}}) {
    INFO(x_m << " " << y_m);
    TagTracker tracker(camera, kCoarse);
    for (int i = 0; i < 2; ++i) {
      CHECK(tracker.Track(film.Next(test::RobotAt(0.02, 0.01, 0.0))).sighting.has_value() ==
            (i == 1));
    }
    const TrackResult moved = tracker.Track(film.Next(test::RobotAt(0.02 + x_m, 0.01 + y_m, 0.0)));
    REQUIRE(moved.sighting.has_value() == is_in_reach);
    if (!is_in_reach) continue;
    CHECK(moved.sighting->mode == TrackMode::kRegion);
    CHECK(moved.sighting->Planar().x_m == Approx(0.02 + x_m).margin(5e-4));
    CHECK(moved.sighting->Planar().y_m == Approx(0.01 + y_m).margin(5e-4));
  }
  // After a third of a second it can have got farther.
  TagTracker tracker(camera, kCoarse);
  for (int i = 0; i < 2; ++i) tracker.Track(film.Next(test::RobotAt(-0.08, 0.0, 0.0)));
  for (int i = 0; i < 9; ++i) CHECK_FALSE(tracker.Track(film.Next({})).sighting);
  const TrackResult back = tracker.Track(film.Next(test::RobotAt(0.08, 0.0, 0.0)));
  REQUIRE(back.sighting);
  CHECK(back.sighting->mode == TrackMode::kRegion);
}

TEST_CASE("A tag that was forgotten is searched coarsely first, as at the start") {
  const CameraModel camera = test::SmallCamera();
  Film film(camera, kSmallTag);
  TagTracker tracker(camera, kCoarse);
  const auto robot = test::RobotAt(0.02, 0.01, 0.0);
  for (int round = 0; round < 2; ++round) {
    CHECK_FALSE(tracker.Track(film.Next(robot)).sighting);
    tracker.Forget();
  }
  CHECK_FALSE(tracker.Track(film.Next(robot)).sighting);
  CHECK(tracker.Track(film.Next(robot)).sighting);
}

TEST_CASE(
    "Of two tags near where one is expected the nearer is taken, of two at first the clearer") {
  const CameraModel camera = test::SmallCamera();
  test::OnBothSides("left", "right", [&](const test::Side& side) {
    const double sign = side.IsFirst() ? -1.0 : 1.0;
    const SyntheticCameraOptions look{.noise_grey = 1.0};
    Film alone(camera, look), beside(camera, look, {.tags = {test::FloorTag(0, 0.09 * sign, 0.0)}});
    TagTracker tracker(camera, {.region_margin = 2.0});
    REQUIRE(tracker.Track(alone.Next(test::RobotAt(0.0, 0.0, 0.0))).sighting);
    beside.Next({});
    // Moved by more than half a cell of 6 mm its edges are not found.
    const TrackResult moved = tracker.Track(beside.Next(test::RobotAt(0.0, 0.008, 0.3)));
    REQUIRE(moved.sighting);
    CHECK(moved.sighting->mode == TrackMode::kRegion);
    CHECK(moved.sighting->Planar().x_m == Approx(0.0).margin(1e-3));

    Film two(camera, look, {.tags = {test::FloorTag(0, 0.1 * sign, 0.0, 0.02)}});
    TagTracker at_first(camera, {.acquire_decimate = 1});
    const TrackResult clearer = at_first.Track(two.Next(test::RobotAt(-0.1 * sign, 0.0, 0.0)));
    REQUIRE(clearer.sighting);
    CHECK(clearer.sighting->tags_of_this_id == 2);
    CHECK(clearer.sighting->Planar().x_m == Approx(-0.1 * sign).margin(1e-3));
  });
}

TEST_CASE("A tag that is found and cannot be measured, and a rival alone, are named as that") {
  const CameraModel camera = test::SmallCamera();
  const SyntheticCameraOptions look{.noise_grey = 1.0};
  const auto robot = test::RobotAt(-0.1, 0.0, 0.0);
  Film alone(camera, look), beside(camera, look, {.tags = {test::FloorTag(0, 0.2, 0.1)}});
  const Frame first = alone.Next(robot);
  CHECK(TagTracker(camera, {.max_fit_px = 1e-6}).Track(first).miss == Miss::kNoEdges);
  CHECK(TagTracker(camera, {.min_margin = 1e3}).Track(first).miss == Miss::kDoubtfulBits);
  TagTracker tracker(camera, {.recheck_every = 1});
  REQUIRE(tracker.Track(first).sighting);
  beside.Next({});
  REQUIRE(tracker.Track(beside.Next(robot)).sighting);
  const TrackResult hidden = tracker.Track(beside.Next({}));
  CHECK_FALSE(hidden.sighting);
  CHECK(hidden.miss == Miss::kRival);
  REQUIRE(hidden.predicted);
  CHECK(hidden.predicted->Planar().x_m == Approx(-0.1).margin(1e-3));
}

}  // namespace
}  // namespace rift::vision
