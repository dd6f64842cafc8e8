// What is found out before a robot moves.
#include <atomic>
#include <catch2/catch.hpp>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

#include "drive_scene.hpp"
#include "rift/sessions/drive/session.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;

TEST_CASE("A log that cannot be made ends a drive before anything moves") {
  test::Uninterrupted(test::kAll, [](test::Scene& scene) {
    const fs::path run = scene.folder.Path() / "run";
    const geometry::Pose2 start = scene.floor.Pose();
    const auto experiment = experiment::LoadExperiment(
        scene.folder / "task.yaml", {"hardware.start.countdown_s=0.2"}, files::ReadFile);
    bool is_counting = false;
    sessions::DriveSession session(
        {.address = {scene.floor.Port(), scene.floor.Camera(), scene.folder / "cam.yaml"},
         .yes = true},
        {.say =
             [&](const std::string& line) {
               if (!line.starts_with("starts in")) return;
               is_counting = true;
               test::WriteText(run / "commands.csv", "mine");
             },
         .show = [](const std::string&) {},
         .hide = [] {},
         .ring = [] {},
         .ask = [](const std::string&, std::string_view keys) { return keys.front(); }});
    std::string error;
    try {
      session.DriveInto(run, experiment);
    } catch (const std::runtime_error& thrown) {
      error = thrown.what();
    }
    if (!is_counting) return false;  // a busy machine came first
    CHECK_THAT(error, Catch::StartsWith("stopped before the start: ") &&
                          Catch::Contains("run/commands.csv"));
    CHECK(scene.floor.Pose() == start);
    CHECK_FALSE(scene.floor.Moves());
    CHECK(files::ReadFile(run / "commands.csv") == "mine");
    fs::remove(run / "commands.csv");
    CHECK(fs::is_empty(run));
    return true;
  });
}

/// The floor with the robot at its start; `is_second` puts another tag of its id beside it.
std::vector<std::uint8_t> PictureOf(bool is_second) {
  const geometry::Pose2 start = control::StartPose(test::PaperWaypoints());
  vision::Scene scene;
  const auto beside = test::RobotAt(start.x_m + 0.1, start.y_m + 0.1, 0.0).world_from_tag;
  if (is_second) scene.tags.push_back({.world_from_tag = beside});
  vision::SyntheticCamera camera(test::SmallCamera(), {}, scene);
  std::mt19937_64 generator(1);
  return camera
      .Render(test::RobotAt(start.x_m, start.y_m, start.yaw_rad), vision::PixelFormat::kJpeg,
              generator)
      .bytes;
}

struct Refused {
  std::string why;
  std::vector<std::string> told;
};

/// A drive that does not begin.
Refused RefusedDrive(const sessions::DriveAddress& address, const fs::path& task,
                     const std::function<void(const std::string&)>& hear = {}) {
  Refused refused;
  const test::TemporaryFolder folder;
  const auto experiment = experiment::LoadExperiment(
      task.string(), {"hardware.start.countdown_s=60", "track.tag.recheck_every=5"},
      files::ReadFile);
  sessions::DriveSession session(
      {.address = address, .yes = true, .any_start = true},
      {.say =
           [&](const std::string& line) {
             refused.told.push_back(line);
             if (hear) hear(line);
           },
       .show = [](const std::string&) {},
       .hide = [] {},
       .ring = [] {},
       .ask = [](const std::string&, std::string_view keys) { return keys.front(); }});
  try {
    session.DriveInto(folder.Path() / "run", experiment);
  } catch (const std::exception& error) {
    refused.why = error.what();
  }
  CHECK_FALSE(fs::exists(folder / "run"));
  return refused;
}

TEST_CASE("Two tags of the robot's id, and a recording, are refused with the first picture") {
  const test::Scene scene;
  const hardware::PseudoTerminal line;
  vision::synthetic::MjpegServer camera(PictureOf(true), {.fps = 20.0});
  CHECK(RefusedDrive({line.path(), camera.Url(), scene.folder / "cam.yaml"},
                     scene.folder / "task.yaml")
            .why ==
        "2 tags with the robot's id 0 are in the picture: take away all but the robot's");
  const std::string data = test::SourceDir() + "/data/camera";
  CHECK_THAT(RefusedDrive({line.path(), data + "/frames/*.jpg", data + "/camera.yaml"},
                          scene.folder / "task.yaml")
                 .why,
             Catch::StartsWith(data + "/frames/*.jpg is a recording"));
}

TEST_CASE("Another tag that the picture shows in place of the robot's is named with its key") {
  const test::Scene scene;
  vision::Scene floor;
  floor.tags.push_back({.id = 3, .world_from_tag = test::RobotAt(0.0, 0.0, 0.0).world_from_tag});
  vision::SyntheticCamera lens(test::SmallCamera(), {}, floor);
  std::mt19937_64 generator(1);
  vision::synthetic::MjpegServer camera(
      lens.Render({}, vision::PixelFormat::kJpeg, generator).bytes, {.fps = 4.0});
  const Refused refused = RefusedDrive(
      {scene.floor.Port(), camera.Url(), scene.folder / "cam.yaml"}, scene.folder / "task.yaml");
  CHECK(refused.why ==
        "the robot was not seen within 10 s: the picture shows tag36h11 id 3 "
        "(--set track.tag.id=3)");
}

TEST_CASE("A second tag of the robot's id that comes while it waits for its start is refused") {
  const std::vector<std::uint8_t> alone = PictureOf(false), two = PictureOf(true);
  std::atomic<bool> is_second = false;
  test::Uninterrupted(test::kAll, [&](test::Scene& scene) {
    is_second = false;
    vision::synthetic::MjpegServer camera([&] { return is_second ? two : alone; }, {.fps = 20.0});
    const Refused refused = RefusedDrive(
        {scene.floor.Port(), camera.Url(), scene.folder / "cam.yaml"}, scene.folder / "task.yaml",
        [&](const std::string& line) { is_second = is_second || line.starts_with("starts in"); });
    if (!is_second) return false;  // a busy machine came first
    CHECK(refused.why ==
          "not armed: 2 tags with the robot's id 0 are in the picture: take away all but the "
          "robot's");
    CHECK_FALSE(scene.floor.Moves());
    return true;
  });
}

}  // namespace
}  // namespace rift
