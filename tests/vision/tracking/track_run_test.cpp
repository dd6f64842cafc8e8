#include "rift/vision/tracking/track_run.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>

#include "rift/vision/camera/jpeg.hpp"
#include "rift/vision/camera/steady_now.hpp"
#include "support/http.hpp"
#include "vision/small_recording.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;
using test::FloorTag;
using test::RobotAt;
using test::SmallCamera;
using test::SmallRecording;

struct Row {
  double t_s;
  Sighting sighting;
};

/// The camera with reference tag 5 where it sees it, or so far off to the right.
CameraModel MarkedCamera(double off_px = 0.0) {
  CameraModel camera = SmallCamera();
  const Eigen::Vector3d p_in_camera =
      camera.world->world_from_camera.inverse() * Eigen::Vector3d(0.2, 0.1, 0.0);
  const Eigen::Vector2d seen_px =
      PixelsFromPoints(camera, {p_in_camera})[0] + Eigen::Vector2d(off_px, 0.0);
  camera.world->marks = {{5, {0.2, 0.1, 0.0}, seen_px}};
  return camera;
}

/// A run over a recording, with its log and what was said.
struct Tracked {
  explicit Tracked(const std::string& path, const CameraModel& camera = SmallCamera(),
                   const CaptureOptions& capture = {.fps = 20.0}, const TagOptions& tag = {})
      : session(path, camera, capture, tag), parts{.session = session, .options = options} {
    parts.log = [this](double t_s, const Sighting& sighting) {
      rows.push_back({t_s, sighting});
      return true;
    };
    parts.is_stopped = [] { return false; };
    parts.say = [this](const std::string& line) { said.push_back(line); };
  }
  std::string States() const {
    std::string letters;
    for (const Row& row : rows) {
      letters += EnumNames(TrackState{})[static_cast<std::size_t>(row.sighting.state)][0];
    }
    return letters;
  }

  CameraSession session;
  SessionOptions options;
  TrackParts parts;
  std::vector<Row> rows;
  std::vector<std::string> said;
};

TEST_CASE("A recording is logged from the first sighting on: seen, predicted and then lost") {
  SmallRecording recording;
  recording.Add({}, 2);
  recording.Add(RobotAt(0.05, -0.02, 0.3), 3);
  recording.Add({}, 7);
  recording.Add(RobotAt(0.05, -0.02, 0.3), 2);
  Tracked tracked(recording.Path());
  const double begin_s = SteadyNow_s();
  const TrackRun run = RunTracking(tracked.parts);
  // At 20 pictures a second five lie within the 0.25 s for which a motion is gone on with.
  REQUIRE(tracked.States() == "tttppppplltt");
  for (std::size_t i = 0; i < tracked.rows.size(); ++i) {
    const auto& [t_s, sighting] = tracked.rows[i];
    INFO(i);
    CHECK(t_s == (2.0 + static_cast<double>(i)) / 20.0);
    CHECK(sighting.captured_s == t_s);
    CHECK(sighting.frame_index == i + 2);
    CHECK(sighting.tag_id == 0);
    CHECK(std::isnan(sighting.latency_s));
    if (sighting.state == TrackState::kLost) {
      for (const Eigen::Vector2d& corner : sighting.corners) CHECK(corner.norm() == 0.0);
    } else {
      CHECK(sighting.Planar().x_m == Approx(0.05).margin(5e-4));
      CHECK(sighting.Planar().y_m == Approx(-0.02).margin(5e-4));
    }
  }
  CHECK(run.is_recording);
  CHECK(run.frames == 14);
  CHECK(run.rows == 5);
  CHECK(run.repeated == 0);
  CHECK(run.first_t_s == 0.1);
  CHECK(run.last_t_s == 0.65);
  CHECK(run.states == std::array<int, 4>{5, 5, 0, 4});
  CHECK(run.misses[static_cast<std::size_t>(Miss::kNone)] == 5);
  CHECK(run.misses[static_cast<std::size_t>(Miss::kNoTag)] == 9);
  CHECK(run.latencies_s.empty());
  CHECK(run.costs_s.size() == 14);
  CHECK(std::accumulate(run.costs_s.begin(), run.costs_s.end(), 0.0) < SteadyNow_s() - begin_s);
  CHECK(run.zero_s == Approx(begin_s).margin(5.0));
  CHECK(run.state == CameraState::kEnded);
  CHECK(run.reason == "all 14 pictures were read, 0 of them passed over");
  CHECK_FALSE(run.has_failed);
  CHECK(run.most_tags_of_this_id == 1);
  CHECK_FALSE(run.moved_m);
  CHECK(run.instead.others.empty());
  CHECK(tracked.said.empty());
}

TEST_CASE("A row that the log does not take is counted and is none of the run's") {
  SmallRecording recording;
  recording.Add(RobotAt(0.0, 0.0, 0.0), 4);
  Tracked tracked(recording.Path());
  int asked = 0;
  tracked.parts.log = [&](double, const Sighting&) { return ++asked == 2 || asked == 3; };
  const TrackRun run = RunTracking(tracked.parts);
  CHECK(run.repeated == 2);
  CHECK(run.rows == 2);
  CHECK(run.first_t_s == 0.05);
  CHECK(run.last_t_s == 0.1);
}

TEST_CASE("Rows whose tag was lifted off the floor are counted, where there is a floor") {
  SmallRecording recording;
  recording.Add(RobotAt(0.0, 0.0, 0.0), 4);
  recording.Add(RobotAt(0.0, 0.0, 0.0, 0.08), 2);
  CHECK(RunTracking(Tracked(recording.Path()).parts).off_floor == 2);
  CameraModel first_pose = SmallCamera();
  first_pose.world->origin = kFirstPoseOrigin;
  const TrackRun run = RunTracking(Tracked(recording.Path(), first_pose).parts);
  CHECK((run.rows == 6 && run.off_floor == 0));
}

TEST_CASE("Each robot has its rows, and begins with its own first sighting") {
  SmallRecording recording({.tags = {FloorTag(5, 0.2, 0.1)}});
  recording.Add({});
  recording.Add(RobotAt(-0.1, 0.0, 0.0), 2);
  Tracked tracked(recording.Path());
  tracked.parts.further_ids = {5, 6};
  const TrackRun run = RunTracking(tracked.parts);
  std::vector<int> ids;
  for (const Row& row : tracked.rows) ids.push_back(row.sighting.tag_id);
  CHECK(ids == std::vector<int>{5, 0, 5, 0, 5});
  CHECK(run.rows == 5);
  CHECK(run.misses[static_cast<std::size_t>(Miss::kOtherTag)] == 4);  // of 0 once, of 6 always
  CHECK(run.instead.others.empty());
}

TEST_CASE("Two tags of the robot's id are the most that were seen at once") {
  SmallRecording recording({.tags = {FloorTag(0, 0.2, 0.1)}});
  recording.Add(RobotAt(-0.1, 0.0, 0.0));
  const TrackRun run = RunTracking(Tracked(recording.Path()).parts);
  CHECK(run.most_tags_of_this_id == 2);
  CHECK(run.states == std::array<int, 4>{0, 0, 1, 0});
}

TEST_CASE("Where the tag was never seen, those of the newest picture with others are told") {
  PlacedTag of_another_family = FloorTag(7, 0.2, -0.1);
  of_another_family.family = TagFamily::k25h9;
  SmallRecording with({.tags = {FloorTag(5, 0.2, 0.1), FloorTag(3, -0.2, 0.1), of_another_family}}),
      without;
  with.Add({});
  const auto found = [](const std::string& path) {
    std::vector<std::string> texts;
    const TrackRun run = RunTracking(Tracked(path).parts);
    CHECK(run.rows == 0);
    for (const TagInPicture& tag : run.instead.others) {
      texts.push_back(fmt::format("{} {}", NameOf(tag.family), tag.id));
    }
    std::sort(texts.begin(), texts.end());
    return texts;
  };
  const std::vector<std::string> all{"tag25h9 7", "tag36h11 3", "tag36h11 5"};
  CHECK(found(with.Path()) == all);
  // Newer pictures without any tag of the family do not hide them.
  without.Add({});
  std::ifstream file(without.Path() + "/0000.jpg", std::ios::binary);
  const std::vector<std::uint8_t> floor{std::istreambuf_iterator<char>(file), {}};
  with.Write(floor);
  with.Write(floor);
  CHECK(found(with.Path()) == all);
  CHECK(found(without.Path()).empty());
}

TEST_CASE("A tag that was asked for and shows unfit to be measured, or in a mirror, is told") {
  SmallRecording plain({.tags = {FloorTag(5, 0.2, 0.1)}});
  plain.Add(RobotAt(0.05, -0.02, 0.3));
  std::ifstream file(plain.Path() + "/0000.jpg", std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  const cv::Mat1b picture = DecodeJpeg(bytes, false, 8);
  const auto run_of = [](const cv::Mat1b& shown, std::vector<int> further_ids = {}) {
    SmallRecording recording;
    recording.Write(WriteJpeg(shown, 95, false));
    Tracked tracked(recording.Path());
    tracked.parts.further_ids = std::move(further_ids);
    return RunTracking(tracked.parts);
  };
  cv::Mat1b changed;
  cv::flip(picture, changed, 1);
  const TrackRun mirrored = run_of(changed);
  CHECK(mirrored.rows == 0);
  CHECK(mirrored.instead.is_mirrored);
  CHECK_FALSE(mirrored.instead.is_unmeasured);
  CHECK(mirrored.instead.others.empty());
  picture.convertTo(changed, -1, 0.15);  // less contrast than is asked for
  const TrackRun dim = run_of(changed);
  CHECK(dim.rows == 0);
  CHECK(dim.instead.is_unmeasured);
  CHECK_FALSE(dim.instead.is_mirrored);
  REQUIRE(dim.instead.others.size() == 1);
  CHECK(dim.instead.others[0].id == 5);
  CHECK(run_of(changed, {5}).instead.others.empty());
  const TrackRun none = run_of(cv::Mat1b(480, 640, std::uint8_t{100}));
  CHECK_FALSE((none.instead.is_mirrored || none.instead.is_unmeasured));
}

TEST_CASE("Reference tags that lie elsewhere are said once, with the largest distance") {
  const auto run_with = [](double off_px, double limit_m) {
    const CameraModel camera = MarkedCamera(off_px);
    SmallRecording recording({.tags = {FloorTag(5, 0.2, 0.1)}});
    recording.Add(RobotAt(-0.1, 0.0, 0.0), 3);
    Tracked tracked(recording.Path(), camera);
    tracked.options.check_every_s = 0.05;
    tracked.options.check_decimate = 1;
    tracked.options.moved_m = limit_m;
    const TrackRun run = RunTracking(tracked.parts);
    REQUIRE(run.moved_m);
    CHECK(*run.moved_m == Approx(off_px * 0.6 / 610.0).margin(2e-4));
    return tracked.said;
  };
  CHECK(run_with(0.0, 0.005).empty());
  CHECK(run_with(5.0, 0.0060).empty());  // 4.9 mm
  const std::vector<std::string> said = run_with(10.0, 0.005);
  REQUIRE(said.size() == 1);
  CHECK_THAT(
      said[0],
      Contains(
          "the camera was moved: the reference tags lie 9.8 mm off; set the world frame again"));
}

TEST_CASE("A camera that is moved after the last check is said when the run ends") {
  const CameraModel camera = MarkedCamera();
  SmallRecording still({.tags = {FloorTag(5, 0.2, 0.1)}}),
      moved({.tags = {FloorTag(5, 0.19, 0.1)}});
  still.Add(RobotAt(-0.1, 0.0, 0.0), 3);
  moved.Add(RobotAt(-0.11, 0.0, 0.0));
  std::ifstream file(moved.Path() + "/0000.jpg", std::ios::binary);
  still.Write({std::istreambuf_iterator<char>(file), {}});
  Tracked tracked(still.Path(), camera);
  const TrackRun run = RunTracking(tracked.parts);
  REQUIRE(run.moved_m);
  CHECK(*run.moved_m == Approx(0.01).margin(5e-4));
  REQUIRE(tracked.said.size() == 1);
  CHECK_THAT(tracked.said[0], Contains("the camera was moved"));
}

TEST_CASE("A world frame whose reference tags are not to be seen is noted once") {
  CameraModel camera = SmallCamera();
  camera.world->marks = {{5, {0.2, 0.1, 0.0}, {500.0, 100.0}},
                         {6, {0.0, 0.1, 0.0}, {300.0, 100.0}}};
  SmallRecording recording;
  recording.Add(RobotAt(-0.1, 0.0, 0.0), 4);
  Tracked tracked(recording.Path(), camera);
  tracked.options.check_every_s = 0.05;
  const TrackRun run = RunTracking(tracked.parts);
  CHECK_FALSE(run.moved_m);
  CHECK(tracked.said ==
        std::vector<std::string>{
            "note: none of the 2 reference tags that set the world frame is in the picture, so "
            "that nothing tells whether the camera was moved since: lay them where they lay, or "
            "set the frame again"});
}

TEST_CASE("A run ends with its time, its user, its window and no sooner") {
  SmallRecording recording;
  recording.Add(RobotAt(0.0, 0.0, 0.0), 6);
  SECTION("no time at all") {
    Tracked tracked(recording.Path());
    tracked.parts.duration_s = 0.0;
    CHECK(RunTracking(tracked.parts).frames == 0);
  }
  SECTION("time enough") {
    Tracked tracked(recording.Path());
    tracked.parts.duration_s = 1000.0;
    CHECK(RunTracking(tracked.parts).frames == 6);
  }
  SECTION("of a recording by its own time, however fast it is read") {
    Tracked tracked(recording.Path(), SmallCamera(), {.fps = 1.0});
    tracked.parts.duration_s = 2.0;
    const TrackRun run = RunTracking(tracked.parts);
    CHECK(run.frames == 3);
    CHECK(run.rows == 3);
    CHECK(run.last_t_s == 2.0);
    CHECK_FALSE(run.has_failed);
  }
  SECTION("stopped") {
    Tracked tracked(recording.Path());
    tracked.parts.is_stopped = [&] { return tracked.rows.size() >= 2; };
    const TrackRun run = RunTracking(tracked.parts);
    CHECK(run.rows == 2);
    CHECK_FALSE(run.has_failed);
  }
  SECTION("the window shows each picture in its time and the last one until it is closed") {
    Tracked tracked(recording.Path(), SmallCamera(), {.fps = 100.0});
    const double begin_s = SteadyNow_s();
    std::vector<std::uint64_t> shown;
    int held = 0;
    tracked.parts.show = [&](const std::optional<Frame>& frame,
                             const std::vector<std::optional<Sighting>>& seen,
                             const CaptureStatus& status, const std::optional<double>& moved_m) {
      CHECK_FALSE(moved_m);
      if (!frame) return true;
      REQUIRE(seen.size() == 1);
      REQUIRE(seen[0]);
      CHECK(std::isnan(seen[0]->latency_s));
      if (shown.empty() || shown.back() != frame->index) shown.push_back(frame->index);
      held += status.state == CameraState::kEnded && SteadyNow_s() - begin_s > 0.06;
      return held < 3;
    };
    const TrackRun run = RunTracking(tracked.parts);
    CHECK(shown == std::vector<std::uint64_t>{0, 1, 2, 3, 4, 5});
    CHECK(held == 3);
    CHECK(SteadyNow_s() - begin_s > 0.05);
    CHECK(run.frames == 6);
    CHECK_FALSE(run.has_failed);
  }
  SECTION("the window is closed at the second picture") {
    Tracked tracked(recording.Path(), SmallCamera(), {.fps = 1000.0});
    tracked.parts.show = [&](const std::optional<Frame>& frame, const auto&...) {
      return !frame || frame->index < 1;
    };
    CHECK(RunTracking(tracked.parts).frames == 2);
  }
}

TEST_CASE("A recording in which no picture can be read has failed with its reason") {
  SmallRecording recording;
  recording.Write({1, 2, 3});
  Tracked tracked(recording.Path());
  const TrackRun run = RunTracking(tracked.parts);
  CHECK(run.state == CameraState::kWrongFormat);
  CHECK(run.has_failed);
  CHECK(run.frames == 0);
  CHECK_THAT(run.reason, Contains("none of 1 pictures can be decoded"));
  REQUIRE(tracked.said.size() == 1);
  CHECK(tracked.said[0] == "camera wrong format: " + run.reason);
  // Who stops it then has ended it himself.
  Tracked stopped(recording.Path());
  stopped.parts.is_stopped = [&] { return !stopped.said.empty(); };
  const TrackRun ended = RunTracking(stopped.parts);
  CHECK(ended.state == CameraState::kWrongFormat);
  CHECK_FALSE(ended.has_failed);
}

TEST_CASE("A camera that changes the size of its pictures has failed, and the run is whole") {
  SmallRecording recording;
  recording.Add(RobotAt(0.0, 0.0, 0.0), 3);
  for (int i = 0; i < 12; ++i) {  // the first nine of them may be damaged
    recording.Write(WriteJpeg(cv::Mat1b(640, 480, std::uint8_t{100}), 90, false));
  }
  Tracked tracked(recording.Path());
  const TrackRun run = RunTracking(tracked.parts);
  CHECK((run.rows == 3 && run.frames == 3));
  CHECK(run.state == CameraState::kWrongFormat);
  CHECK(run.has_failed);
  CHECK(run.reason ==
        "after 3 pictures of 640x480 pixels, for which its calibration is, it gives 480x640: keep "
        "its size and turn while it tracks");
  CHECK(tracked.said == std::vector<std::string>{"camera wrong format: " + run.reason});
  SmallRecording other;
  other.Write(WriteJpeg(cv::Mat1b(640, 480, std::uint8_t{100}), 90, false));
  CHECK_THROWS_WITH(RunTracking(Tracked(other.Path()).parts), Contains("480 x 640"));
}

TEST_CASE("A session asks for the size of its calibration and holds the pictures to it") {
  SmallRecording recording;
  recording.Add(RobotAt(0.0, 0.0, 0.0), 2);
  CameraModel camera = SmallCamera();
  CameraSession session(recording.Path(), camera, {.width_px = 1, .height_px = 2}, {});
  CHECK((session.options().width_px == 640 && session.options().height_px == 480));
  const Frame first = session.FirstPicture().value();
  CHECK(first.index == 0);
  CHECK(session.LookAt(first, 1).robot_tags == 1);
  CHECK_FALSE(session.LookAt(first, 1).moved_m);
  CHECK(session.FirstPicture()->index == 1);
  session.Restart();
  CHECK(session.FirstPicture()->index == 0);

  camera.width_px = camera.height_px = 0;
  CameraSession sizeless(recording.Path(), camera, {.width_px = 1, .height_px = 2}, {});
  CHECK((sizeless.options().width_px == 1 && sizeless.options().height_px == 2));
  sizeless.FirstPicture();
  CHECK((sizeless.camera().width_px == 640 && sizeless.camera().height_px == 480));

  for (const auto& [width_px, height_px] : {std::pair{640, 0}, {0, 480}}) {  // one side is none
    camera.width_px = width_px;
    camera.height_px = height_px;
    CameraSession half(recording.Path(), camera, {}, {});
    half.FirstPicture();
    CHECK((half.camera().width_px == 640 && half.camera().height_px == 480));
  }

  camera.width_px = camera.height_px = 0;
  camera.k(0, 2) = 641.0;
  CameraSession of_another(recording.Path(), camera, {}, {});
  CHECK_THROWS_WITH(of_another.FirstPicture(),
                    Contains("gives 640x480 pixels, for which its calibration does not say whether "
                             "it was made: the principal point (641, 239.5) px"));
  camera.k(0, 2) = 319.5;

  for (const auto& [width_px, height_px] : {std::pair{640, 360}, {320, 480}}) {
    camera.width_px = width_px;
    camera.height_px = height_px;
    CameraSession other(recording.Path(), camera, {}, {});
    CHECK_THROWS_WITH(other.FirstPicture(),
                      fmt::format("the camera {} gives 640x480 pixels and its calibration is for "
                                  "{}x{}: set the camera to that size, or calibrate anew",
                                  recording.Path(), width_px, height_px));
  }
  SmallRecording none;
  none.Write({1, 2, 3});
  CameraSession failing(none.Path(), SmallCamera(), {}, {});
  CHECK_THROWS_WITH(
      failing.FirstPicture(),
      Contains("the camera " + none.Path() + " is wrong format: ") && Contains("can be decoded"));
}

TEST_CASE("Waiting for the first picture ends when somebody says so") {
  const test::SilentServer server;
  CameraSession waiting(fmt::format("http://127.0.0.1:{}/video", server.Port()), SmallCamera(),
                        {.open_timeout_s = 600.0}, {});
  int asked = 0;
  CHECK_FALSE(waiting.FirstPicture([&asked] { return ++asked < 3; }));
  CHECK(asked == 3);
}

TEST_CASE("The most that a camera was moved and that tags were seen are told when both are over") {
  const CameraModel camera = MarkedCamera();
  SmallRecording moved({.tags = {FloorTag(5, 0.19, 0.1), FloorTag(0, 0.1, -0.15)}}),
      still({.tags = {FloorTag(5, 0.2, 0.1)}});
  moved.Add(RobotAt(-0.1, 0.0, 0.0));
  still.Add(RobotAt(-0.1, 0.0, 0.0));
  std::ifstream file(still.Path() + "/0000.jpg", std::ios::binary);
  moved.Write({std::istreambuf_iterator<char>(file), {}});
  Tracked tracked(moved.Path(), camera, {.fps = 20.0},
                  {.recheck_every = 1, .doubt_recheck_every = 1});
  tracked.options.check_every_s = 0.05;
  tracked.options.check_decimate = 1;
  const TrackRun run = RunTracking(tracked.parts);
  REQUIRE(tracked.rows.size() == 2);
  CHECK(tracked.rows[0].sighting.tags_of_this_id == 2);
  CHECK(tracked.rows[1].sighting.tags_of_this_id == 1);
  CHECK(run.most_tags_of_this_id == 2);
  REQUIRE(run.moved_m);
  CHECK(*run.moved_m == Approx(0.01).margin(5e-4));
}

TEST_CASE("Reference tags too small for the checks are looked for once in every pixel") {
  const CameraModel camera = MarkedCamera();
  SmallRecording recording({.tags = {FloorTag(5, 0.2, 0.1, 0.018)}});  // 18 px
  recording.Add(RobotAt(-0.1, 0.0, 0.0), 2);
  Tracked tracked(recording.Path(), camera);
  tracked.options.check_decimate = 4;
  const TrackRun run = RunTracking(tracked.parts);
  REQUIRE(run.moved_m);
  CHECK(*run.moved_m < 1e-3);
  CHECK(tracked.said.empty());
  // Later on, which would cost time, they are not: that they were moved is not seen.
  SmallRecording moved({.tags = {FloorTag(5, 0.19, 0.1, 0.018)}});
  moved.Add(RobotAt(-0.1, 0.0, 0.0));
  std::ifstream file(moved.Path() + "/0000.jpg", std::ios::binary);
  recording.Write({std::istreambuf_iterator<char>(file), {}});
  Tracked longer(recording.Path(), camera);
  longer.options.check_decimate = 4;
  longer.options.check_every_s = 0.05;
  const TrackRun later = RunTracking(longer.parts);
  REQUIRE(later.moved_m);
  CHECK(*later.moved_m < 1e-3);
}

TEST_CASE("Reference tags are checked as soon as so much time has passed, in every such picture") {
  const CameraModel camera = MarkedCamera();
  SmallRecording still({.tags = {FloorTag(5, 0.2, 0.1)}}),
      moved({.tags = {FloorTag(5, 0.19, 0.1)}});
  still.Add(RobotAt(-0.1, 0.0, 0.0));
  moved.Add(RobotAt(-0.1, 0.0, 0.0));
  for (const SmallRecording* next : {&moved, &still}) {  // in the middle one it is moved
    std::ifstream file(next->Path() + "/0000.jpg", std::ios::binary);
    still.Write({std::istreambuf_iterator<char>(file), {}});
  }
  for (const auto& [every_s, is_seen] : {std::pair{0.25, true}, {0.26, false}}) {
    Tracked tracked(still.Path(), camera, {.fps = 4.0});
    tracked.options.check_every_s = every_s;
    tracked.options.check_decimate = 1;
    const TrackRun run = RunTracking(tracked.parts);
    REQUIRE(run.moved_m);
    CHECK((*run.moved_m > 0.009) == is_seen);
  }
}

}  // namespace
}  // namespace rift::vision
