#include "rift/vision/tracking/world_setting.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "rift/yaml/node.hpp"
#include "vision/mjpeg_server.hpp"
#include "vision/small_recording.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;
using test::FloorTag;
using test::RobotAt;
using test::SmallCamera;
using test::SmallRecording;

TEST_CASE("Marks on the floor are read with their names, ids and places") {
  const FloorMarks tags = ReadFloorMarks(
      "tags:\n- {id: 2114, x_m: -0.5, y_m: 0.25}\n- {id: 3, x_m: 1, y_m: 2, z_m: 0.125}\n",
      "w.yaml");
  REQUIRE((tags.tags.size() == 2 && tags.points.empty()));
  CHECK(tags.tags[0].id == 2114);
  CHECK((tags.tags[0].x_m == -0.5 && tags.tags[0].y_m == 0.25 && tags.tags[0].z_m == 0.0));
  CHECK(tags.tags[1].z_m == 0.125);
  const FloorMarks points = ReadFloorMarks(
      "points:\n- {name: a, x_m: 1, y_m: 2}\n- {name: a, x_m: 2, y_m: 2}\n", "w.yaml");
  REQUIRE((points.points.size() == 2 && points.tags.empty()));
  CHECK(points.points[1].name == "a");
  const std::string either =
      "w.yaml: a world frame wants either `tags:` or `points:`, each with x_m and y_m";
  CHECK_THROWS_WITH(ReadFloorMarks("tags: []\n", "w.yaml"), either);
  CHECK_THROWS_WITH(ReadFloorMarks("tags: [{id: 1}]\npoints: [{name: a}]\n", "w.yaml"), either);
  CHECK_THROWS_WITH(ReadFloorMarks("tags:\n- {id: 1}\n- {id: 2}\n- {id: 1}\n", "w.yaml"),
                    Contains("w.yaml:4") && Contains("this tag has a place already"));
  CHECK_THROWS_AS(ReadFloorMarks("tags:\n- {id: 2115}\n", "w.yaml"), yaml::Error);
  for (const char* one : {"x_m: 1001", "y_m: -1001", "z_m: 1001"}) {
    CHECK_THROWS_AS(ReadFloorMarks("tags:\n- {id: 1, " + std::string(one) + "}\n", "w.yaml"),
                    yaml::Error);
  }
}

/// What a world frame is set with, over a recording at 20 pictures a second.
struct Setup {
  explicit Setup(const SmallRecording& recording, TagOptions tag = {},
                 const CameraModel& camera = WithoutWorld())
      : Setup(recording.Path(), {.fps = 20.0}, tag, camera) {}
  Setup(const std::string& name, const CaptureOptions& capture, const TagOptions& tag = {},
        const CameraModel& camera = WithoutWorld())
      : session(name, camera, capture, tag),
        setting{.session = session,
                .options = options,
                .is_stopped = [] { return false; },
                .say = [this](const std::string& line) { said.push_back(line); }} {}

  static CameraModel WithoutWorld() {
    CameraModel camera = SmallCamera();
    camera.world.reset();
    return camera;
  }

  SessionOptions options;
  std::vector<std::string> said;
  CameraSession session;
  WorldSetting setting;
};

TEST_CASE("A robot that stands still sets the origin below its tag, whenever it comes in time") {
  SmallRecording recording;
  recording.Add({}, 9);
  recording.Add(RobotAt(0.1, -0.05, 0.5), 8);
  Setup setup(recording);
  setup.options.world_patience_s = 0.45;
  setup.options.world_average_s = 0.35;
  const WorldFrame world = WorldFromRobot(setup.setting);
  CHECK(world.origin == kFirstPoseOrigin);
  CHECK(world.marks.empty());
  const Eigen::Isometry3d tag_in_world = world.world_from_camera *
                                         SmallCamera().world->world_from_camera.inverse() *
                                         RobotAt(0.1, -0.05, 0.5).world_from_tag;
  CHECK((tag_in_world.translation() - Eigen::Vector3d(0.0, 0.0, 0.03)).norm() < 3e-3);
  CHECK(tag_in_world.linear()(0, 0) > 0.999);

  // A frame that was set before, for a floor 2 mm below, has no part in it.
  CameraModel lower = SmallCamera();
  lower.world->world_from_camera.translation().z() += 0.002;
  Setup again(recording, {}, lower);
  again.options.world_average_s = 0.35;
  CHECK(WorldFromRobot(again.setting).world_from_camera.matrix() ==
        world.world_from_camera.matrix());

  Setup impatient(recording);
  impatient.options.world_patience_s = 0.4;
  CHECK_THROWS_WITH(WorldFromRobot(impatient.setting),
                    "tag 0 was not seen within 0.4 s: the world frame was not set");
  Setup too_long(recording);
  too_long.options.world_average_s = 0.41;
  CHECK_THROWS_WITH(WorldFromRobot(too_long.setting),
                    "camera ended: all 17 pictures were read, 0 of them passed over; the world "
                    "frame was not set");
  Setup stopped(recording);
  stopped.setting.is_stopped = [] { return true; };
  CHECK_THROWS_WITH(WorldFromRobot(stopped.setting), "stopped before the world frame was set");
}

TEST_CASE("A camera from which no picture comes is given up, and no world frame is waited for") {
  synthetic::MjpegServer silent(std::vector<std::uint8_t>{}, {.pictures = 0, .then_silent = true});
  Setup setup(silent.Url(), {.silent_s = 0.02, .open_timeout_s = 0.02});
  setup.options.give_up_s = 0.02;
  // Where nothing ends it, a person does after a while.
  setup.setting.is_stopped = [asked = 0]() mutable { return ++asked > 200; };
  CHECK_THROWS_WITH(WorldFromRobot(setup.setting),
                    StartsWith("camera frozen: no first picture within ") &&
                        EndsWith(" s; the world frame was not set"));
}

TEST_CASE("A robot that moves while its pose is averaged is refused with how far it moved") {
  // Six pictures at rest, six 1.5 mm on: 610 / 0.57 px a metre, so 1.6 px.
  SmallRecording recording;
  recording.Add(RobotAt(0.1, 0.0, 0.5), 6);
  recording.Add(RobotAt(0.1, 0.0015, 0.5), 7);
  for (const double average_s : {0.25, 0.55}) {
    Setup setup(recording);
    setup.options.world_average_s = average_s;
    if (average_s < 0.3) {
      CHECK_NOTHROW(WorldFromRobot(setup.setting));
      continue;
    }
    CHECK_THROWS_WITH(
        WorldFromRobot(setup.setting),
        "tag 0 moved by 1.6 px while its first pose was averaged over 0.55 s (at most "
        "0.5): let the robot stand still, or give --world-average 0 to take a single "
        "picture");
  }
  Setup single(recording);
  single.options.world_average_s = 0.0;
  CHECK(WorldFromRobot(single.setting).residual_m == 0.0);
  // Of three pictures the first is held against the last, 0.9 px on.
  SmallRecording short_one;
  short_one.Add(RobotAt(0.1, 0.0, 0.5), 2);
  short_one.Add(RobotAt(0.1, 0.00084, 0.5), 2);
  Setup three(short_one);
  three.options.world_average_s = 0.09;
  CHECK_THROWS_WITH(WorldFromRobot(three.setting), Contains("tag 0 moved by"));
  // One that creeps by 0.8 px is 0.55 px on from its first third to its last.
  SmallRecording creeping;
  for (int i = 0; i < 13; ++i) creeping.Add(RobotAt(0.1, 0.0008 * i / 11.0 * 0.57 / 0.61, 0.5));
  Setup crept(creeping);
  crept.options.world_average_s = 0.55;
  CHECK_THROWS_WITH(WorldFromRobot(crept.setting), Contains("tag 0 moved by 0."));
  // A single picture that is 0.9 px off is no motion of the four that are averaged.
  SmallRecording nudged;
  nudged.Add(RobotAt(0.1, 0.00084, 0.5));
  nudged.Add(RobotAt(0.1, 0.0, 0.5), 12);
  Setup of_many(nudged);
  of_many.options.world_average_s = 0.55;
  CHECK_NOTHROW(WorldFromRobot(of_many.setting));
  // 0.4 px are the noise of a corner.
  SmallRecording still;
  still.Add(RobotAt(0.1, 0.0, 0.5), 6);
  still.Add(RobotAt(0.1, 0.0004, 0.5), 7);
  Setup at_rest(still);
  at_rest.options.world_average_s = 0.55;
  CHECK_NOTHROW(WorldFromRobot(at_rest.setting));
}

TEST_CASE("A first pose is that of one robot, and two tags of its id make no world frame") {
  SmallRecording recording({.tags = {FloorTag(0, -0.2, 0.1)}});
  recording.Add(RobotAt(0.1, 0.0, 0.5), 30);
  Setup setup(recording);
  CHECK_THROWS_WITH(WorldFromRobot(setup.setting),
                    "2 tags with the robot's id 0 are in the picture, and nobody knows which one "
                    "is the robot's: take away all but the robot's; the world frame was not set");
}

/// Four tags on the floor, and where a file says that they lie.
const std::vector<PlacedTag> kTags{FloorTag(1, -0.22, -0.15), FloorTag(2, 0.22, -0.15),
                                   FloorTag(3, 0.22, 0.15), FloorTag(4, -0.22, 0.15)};

std::vector<FloorMark> MarksOf(const std::vector<PlacedTag>& tags, double unit = 1.0) {
  std::vector<FloorMark> marks;
  for (const PlacedTag& tag : tags) {
    const Eigen::Vector3d p = unit * tag.world_from_tag.translation();
    marks.push_back({.id = tag.id, .x_m = p.x(), .y_m = p.y(), .z_m = p.z()});
  }
  return marks;
}

TEST_CASE("Reference tags set the world frame, whose scale the robot's tag confirms") {
  SmallRecording recording({.tags = kTags});
  recording.Add(RobotAt(0.02, 0.01, 0.0));
  Setup setup(recording);
  const WorldFrame world = WorldFromFloorTags(setup.setting, MarksOf(kTags));
  CHECK(world.origin == "4 reference tags");
  CHECK(world.marks.size() == 4);
  CHECK(world.world_from_camera.isApprox(SmallCamera().world->world_from_camera, 3e-3));
  CHECK(setup.said.empty());

  Setup larger(recording, {.size_m = 0.055});
  CHECK_THROWS_WITH(WorldFromFloorTags(larger.setting, MarksOf(kTags)),
                    Contains("in this frame the robot's tag is 0.047") &&
                        Contains(" m wide, printed it is 0.055 m"));
  Setup in_centimetres(recording);
  CHECK_THROWS_WITH(WorldFromFloorTags(in_centimetres.setting, MarksOf(kTags, 100.0)),
                    Contains("the places are centimetres"));
  // From ten times on the factor is what is said, before that what does not fit. For its height the
  // tag looks a twentieth larger.
  Setup by_twelve(recording), by_nine(recording);
  by_twelve.options.world_limit_m = by_nine.options.world_limit_m = 1e-5;
  CHECK_THROWS_WITH(WorldFromFloorTags(by_twelve.setting, MarksOf(kTags, 12.0)),
                    Contains("is the tag's size right"));
  CHECK_THROWS_WITH(WorldFromFloorTags(by_nine.setting, MarksOf(kTags, 9.3)),
                    Contains("do not fit what the camera sees"));
  Setup in_inches(recording);
  in_inches.options.world_limit_m = 1.0;
  CHECK_THROWS_WITH(WorldFromFloorTags(in_inches.setting, MarksOf(kTags, 39.37)),
                    Contains("the places are inches"));
  Setup wrong(recording);
  std::vector<FloorMark> marks = MarksOf(kTags);
  marks[0].x_m += 0.05;
  CHECK_THROWS_WITH(WorldFromFloorTags(wrong.setting, marks),
                    Contains("do not fit what the camera sees") && Contains("(limit 5 mm)"));
  Setup lenient(recording);
  lenient.options.world_limit_m = 0.5;
  CHECK_NOTHROW(WorldFromFloorTags(lenient.setting, marks));
  Setup unknown(recording);
  marks[0].id = 587;
  CHECK_THROWS_WITH(WorldFromFloorTags(unknown.setting, marks), Contains("tag id 587"));
}

TEST_CASE(
    "Pictures of another size than the calibration set no world frame, however well it fits") {
  SmallRecording recording({.tags = kTags});
  recording.Add(RobotAt(0.02, 0.01, 0.0));
  CameraModel larger = Setup::WithoutWorld();
  larger.width_px *= 2;
  larger.height_px *= 2;
  larger.k.topRows(2) *= 2.0;
  const std::string reason =
      " gives 640x480 pixels and its calibration is for 1280x960: set the camera to that size, or "
      "calibrate anew";
  Setup by_tags(recording, {}, larger);
  CHECK_THROWS_WITH(WorldFromFloorTags(by_tags.setting, MarksOf(kTags)), EndsWith(reason));
  Setup by_robot(recording, {}, larger);
  CHECK_THROWS_WITH(WorldFromRobot(by_robot.setting), EndsWith(reason));
}

TEST_CASE("A reference tag that is in the picture twice sets no world frame") {
  std::vector<PlacedTag> tags = kTags;
  tags.push_back(FloorTag(3, 0.0, 0.1));
  SmallRecording recording({.tags = tags});
  recording.Add({});
  Setup setup(recording);
  CHECK_THROWS_WITH(WorldFromFloorTags(setup.setting, MarksOf(kTags)),
                    "2 tags with the id 3 are in the picture, and the file names one place for it: "
                    "take away those that lie elsewhere");
}

TEST_CASE("Tags that a recording's first picture lacks are named, and an unseen robot is noted") {
  SmallRecording recording({.tags = {kTags[0], kTags[2], kTags[3]}});
  recording.Add({}, 2);
  Setup setup(recording);
  CHECK_THROWS_WITH(WorldFromFloorTags(setup.setting, MarksOf(kTags)),
                    "a world frame needs 4 reference tags, 3 of 4 are seen (not 2)");
  SmallRecording alone({.tags = kTags});
  alone.Add({});
  Setup without_robot(alone);
  CHECK_NOTHROW(WorldFromFloorTags(without_robot.setting, MarksOf(kTags)));
  CHECK(without_robot.said ==
        std::vector<std::string>{"note: the robot's tag 0 is not in the picture, so the scale of "
                                 "the frame is not checked"});
  Setup silent(alone);
  silent.setting.say = {};
  CHECK_NOTHROW(WorldFromFloorTags(silent.setting, MarksOf(kTags)));
}

TEST_CASE("Reference tags are waited for before a live camera, until patience ends") {
  const auto jpeg_of = [](const std::vector<PlacedTag>& tags) {
    SmallRecording recording({.tags = tags});
    recording.Add({});
    std::ifstream file(recording.Path() + "/0000.jpg", std::ios::binary);
    return std::vector<std::uint8_t>{std::istreambuf_iterator<char>(file), {}};
  };
  const auto set = [](const std::vector<std::uint8_t>& jpeg, double patience_s) -> std::string {
    synthetic::MjpegServer server(jpeg, {.pictures = 1, .then_silent = true});
    Setup setup(server.Url(), {});
    setup.options.world_patience_s = patience_s;
    // A person stops it soon after its only picture has come.
    setup.setting.is_stopped = [&, asked = 0]() mutable {
      return setup.session.capture().Status().delivered > 0 && ++asked > 2;
    };
    try {
      return WorldFromFloorTags(setup.setting, MarksOf(kTags)).origin;
    } catch (const std::exception& error) {
      return error.what();
    }
  };
  const auto three = jpeg_of({kTags[0], kTags[2], kTags[3]});
  CHECK(set(three, 1e6) == "stopped before the world frame was set");
  CHECK(set(three, 0.0) == "a world frame needs 4 reference tags, 3 of 4 are seen (not 2)");
  CHECK(set(jpeg_of(kTags), 1e6) == "4 reference tags");
}

TEST_CASE("A camera that never gives a picture ends the wait for the first one with its reason") {
  synthetic::MjpegServer silent(std::vector<std::uint8_t>{}, {.pictures = 0, .then_silent = true});
  CameraSession session(silent.Url(), SmallCamera(), {.silent_s = 0.02, .open_timeout_s = 0.02},
                        {});
  CHECK_THROWS_WITH(session.FirstPicture(), StartsWith("the camera " + silent.Url() +
                                                       " is frozen: no first picture within 0."));
}

}  // namespace
}  // namespace rift::vision
