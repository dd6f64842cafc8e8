#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "drive_scene.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/files/files.hpp"
#include "rift/trajectory/log.hpp"
#include "support/http.hpp"
#include "support/inputs/paper_waypoints.hpp"
#include "support/processes/broken_streams.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/file_size_limit.hpp"
#include "support/processes/running_rift.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"

namespace rift {
namespace {

using test::kAll;
using test::Scene;
using test::Uninterrupted;
using test::WaitForMotion;
using test::WasInterrupted;
using test::WasInterruptedOrLate;

constexpr rlim_t kRoom = 14'000;  // more than the experiment, less than a drive

void CheckWholeDrive(Scene& scene, const test::ProcessResult& result) {
  INFO(result.out << result.err << scene.floor.Told());
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.err, Catch::Contains("worst stopping distance"));
  CHECK_THAT(result.out, Catch::Contains("the robot acknowledged the stop"));
  const auto summary = scene.Summary();
  CHECK(summary["outcome"] == "reached");
  CHECK(summary["stop"]["acknowledged"] == true);
  CHECK(summary["latency"]["capture_to_command"]["p99_s"] > 0.0);
  const std::string path = scene.folder / "run/trajectory.csv";
  const auto poses =
      trajectory::ReadLog(files::ReadFile(path), path, trajectory::Format::kAuto).trajectory.poses;
  REQUIRE(poses.size() > 50);
  const geometry::Pose2 end = scene.floor.Pose();
  CHECK((end.Position() - test::PaperWaypoints().back().Position()).norm() < 0.08);
  CHECK(std::hypot(poses.back().x_m - end.x_m, poses.back().y_m - end.y_m) < 0.03);
  for (const char* name : {"experiment.yaml", "camera.yaml", "stages.csv", "encoders.csv"}) {
    CHECK(std::filesystem::exists(scene.folder.Path() / "run" / name));
  }

  const test::ProcessResult again = test::RunRift(scene.Arguments());
  CHECK(again.exit_code == 2);
  CHECK_THAT(again.err, Catch::Contains("holds a run already"));
}

TEST_CASE("The binary drives a robot under a camera to the last waypoint") {
  Uninterrupted(kAll, [](Scene& scene) {
    const test::ProcessResult result = test::RunRift(scene.Arguments());
    if (WasInterruptedOrLate(scene, result.exit_code)) return false;
    CheckWholeDrive(scene, result);
    return true;
  });
}

TEST_CASE("A drive whose streams are closed or full arrives and its robot hears commands alone") {
  // A ping is held to all broken streams (drive_command_test.cpp): a drive takes seconds.
  const std::vector<test::Streams> broken{
      {"2>&-"}, {">&-", false}, {">/dev/full 2>/dev/full", false}};
  for (const test::Streams& streams : broken) {
    Uninterrupted(kAll, [&streams](Scene& scene) {
      const test::ProcessResult result = test::RunRift(scene.ShortArguments(), streams.redirection);
      INFO(streams.redirection << ": " << result.out << result.err << scene.floor.Told());
      CHECK(scene.floor.NoCommands() == "");
      if (WasInterruptedOrLate(scene, result.exit_code)) return false;
      CHECK(result.exit_code == (streams.take_results ? 0 : 3));
      CHECK(scene.Summary()["outcome"] == "reached");
      CHECK(scene.Summary()["stop"]["acknowledged"] == true);
      return true;
    });
  }
}

TEST_CASE("A dry run of the binary decides and the robot stands where it stood") {
  Uninterrupted(kAll, [](Scene& scene) {
    const geometry::Pose2 start = scene.floor.Pose();
    std::vector<std::string> arguments = scene.Arguments();
    arguments.insert(arguments.end(), {"--dry-run", "--seconds", "2"});
    const test::ProcessResult result = test::RunRift(arguments);
    INFO(result.out << result.err);
    CHECK(scene.floor.Pose() == start);
    if (WasInterrupted(scene, result.exit_code)) return false;
    CHECK(result.exit_code == 0);
    CHECK_THAT(result.err, Catch::Contains("nothing moves"));
    CHECK_THAT(result.out, Catch::Contains("zeros alone"));
    CHECK(scene.Summary()["dry_run"] == true);
    CHECK(scene.Summary()["outcome"] == "timed_out");
    const std::string decided = files::ReadFile(scene.folder / "run/commands.csv");
    const auto count = [&decided](const std::string& text) {
      int found = 0;
      for (std::size_t at = 0; (at = decided.find(text, at)) != decided.npos; ++at) ++found;
      return found;
    };
    CHECK(count(",0,0\n") < count("\n") - 1);  // and not only while it settled
    return true;
  });
}

TEST_CASE("Ctrl-C in the countdown ends the drive before anything moves") {
  Scene scene;
  const geometry::Pose2 start = scene.floor.Pose();
  std::vector<std::string> arguments = scene.Arguments();
  arguments.insert(arguments.end(), {"--countdown", "60"});
  test::RunningRift rift(arguments);
  rift.WaitUntil("the countdown began",
                 [&] { return rift.Err().find("starts in 60 s") != std::string::npos; });
  rift.Signal(SIGINT);
  const test::ProcessResult result = rift.Wait();
  INFO(result.out << result.err);
  CHECK(result.exit_code == 1);
  CHECK_THAT(result.out, Catch::Contains("stopped before the start: SIGINT came"));
  CHECK(scene.floor.Pose() == start);
  CHECK_FALSE(std::filesystem::exists(scene.folder.Path() / "run/trajectory.csv"));
}

TEST_CASE("Ctrl-C while the camera opens ends the drive at once") {
  Scene scene;
  const test::SilentServer camera;
  std::vector<std::string> arguments = scene.Arguments();
  *(std::find(arguments.begin(), arguments.end(), "--camera") + 1) =
      fmt::format("http://127.0.0.1:{}/video", camera.Port());
  arguments.insert(arguments.end(), {"--set", "track.capture.open_timeout_s=600"});
  test::RunningRift rift(arguments);
  rift.WaitUntil("the camera is asked", [&] { return camera.HasClient(); });
  rift.Signal(SIGINT);
  const test::ProcessResult result = rift.Wait();
  INFO(result.out << result.err);
  CHECK(result.exit_code == 1);
  CHECK_THAT(result.out, Catch::Contains("stopped before the start: SIGINT came"));
  CHECK_FALSE(std::filesystem::exists(scene.folder.Path() / "run"));
}

TEST_CASE("A camera that repeats its last picture stops the robot whatever else changes in it") {
  using Repeat = test::Floor::Repeat;
  for (const Repeat repeat : {Repeat::kNothing, Repeat::kComment, Repeat::kPixels}) {
    Uninterrupted(kAll, [repeat](Scene& scene) {
      test::RunningRift rift(scene.Arguments());
      rift.WaitUntil("the first leg began or the drive is over", [&] {
        return rift.Err().find("loop delay") != std::string::npos || !rift.IsRunning();
      });
      WaitForMotion(rift, scene);
      scene.floor.RepeatPicture(repeat);
      const test::ProcessResult result = rift.Wait();
      if (WasInterrupted(scene, result.exit_code, "pose_stands")) return false;
      INFO(static_cast<int>(repeat) << result.out << result.err << scene.floor.Told());
      CHECK(result.exit_code == 1);
      const std::string reason = scene.Summary()["stop"]["reason"];
      const bool is_same_picture = repeat != Repeat::kPixels && reason == "picture_repeats";
      CHECK((is_same_picture || reason == "pose_stands"));
      CHECK(scene.Summary()["stop"]["acknowledged"] == true);
      return true;
    });
  }
}

TEST_CASE("A signal to the binary stops the robot and the run is saved with its reason") {
  for (const auto& [signal, name] : {std::pair{SIGINT, "SIGINT"},
                                     {SIGTERM, "SIGTERM"},
                                     {SIGHUP, "SIGHUP"},
                                     {SIGQUIT, "SIGQUIT"},
                                     {SIGTSTP, "SIGTSTP"}}) {
    Uninterrupted(kAll, [signal = signal, name = name](Scene& scene) {
      test::RunningRift rift(scene.Arguments());
      WaitForMotion(rift, scene);
      rift.Signal(signal);
      const test::ProcessResult result = rift.Wait();
      if (WasInterrupted(scene, result.exit_code)) return false;
      INFO(result.out << result.err);
      CHECK(result.exit_code == 1);
      CHECK_FALSE(scene.floor.Moves());
      CHECK(scene.Summary()["stop"]["reason"] == "signal");
      CHECK(scene.Summary()["stop"]["acknowledged"] == true);
      CHECK_THAT(scene.Summary()["reason"].get<std::string>(), Catch::Contains(name));
      return true;
    });
  }
}

TEST_CASE("The robot of a killed binary stops by itself") {
  Uninterrupted(kAll, [](Scene& scene) {
    test::RunningRift rift(scene.Arguments());
    WaitForMotion(rift, scene);
    rift.Signal(SIGKILL);
    const test::ProcessResult result = rift.Wait();
    if (WasInterrupted(scene, result.exit_code)) return false;
    INFO(result.out << result.err);
    CHECK(result.exit_code == 128 + SIGKILL);
    test::WaitUntil("the robot stands", [&] { return !scene.floor.Moves(); });
    return true;
  });
}

std::string LogOf(const Scene& scene) {
  return files::ReadIfThere(scene.folder / "run/trajectory.csv").value_or("");
}

/// Or for the end of a drive that was interrupted.
void WaitForRows(test::RunningRift& rift, Scene& scene) {
  WaitForMotion(rift, scene);
  const size_t before = LogOf(scene).size();
  test::WaitUntil("a second of the drive is on disk or the drive is over",
                  [&] { return LogOf(scene).size() > before + 3000 || !rift.IsRunning(); });
}

TEST_CASE("A killed drive leaves its rows, which rift gap and a replay read") {
  Uninterrupted(kAll, [](Scene& scene) {
    test::RunningRift rift(scene.Arguments());
    WaitForRows(rift, scene);
    rift.Signal(SIGKILL);
    const geometry::Pose2 end = scene.floor.Pose();
    const test::ProcessResult result = rift.Wait();
    if (WasInterrupted(scene, result.exit_code)) return false;
    INFO(result.out << result.err);
    CHECK(result.exit_code == 128 + SIGKILL);
    CHECK(scene.Summary()["state"] == "interrupted");
    const auto rows = trajectory::ReadLog(LogOf(scene), "log").trajectory.poses;
    CHECK((rows.back().Position() - end.Position()).norm() < 0.2);  // a second at most
    const std::string log = scene.folder / "run/trajectory.csv";
    test::WriteText(log, files::ReadFile(log) + "1.5,0.3");
    const test::ProcessResult gap =
        test::RunRift({"gap", log, test::SourceDir() + "/data/example/robot1.csv"});
    INFO(gap.err);
    CHECK(gap.exit_code == 0);
    CHECK_THAT(gap.err, Catch::Contains("cut short"));

    const test::ProcessResult shown = test::RunRift(
        {"drive", "--replay", scene.folder / "run", "--video", scene.folder / "run.mp4"});
    INFO(shown.err);
    CHECK(shown.exit_code == 0);
    CHECK_THAT(shown.out, Catch::StartsWith("interrupted: ") &&
                              Catch::Contains("\n" + std::to_string(rows.size()) + " poses over "));
    CHECK(std::filesystem::file_size(scene.folder / "run.mp4") > 1000);
    return true;
  });
}

/// After the log can no longer be written: the robot is told to stop, then the operator why.
bool IsStoppedForItsLog(test::RunningRift& rift, Scene& scene, const std::string& says) {
  const test::ProcessResult result = rift.Wait();
  INFO(result.out << result.err);
  const std::optional<nlohmann::json> summary = test::StoppedForItsLog(result);
  if (!summary) return false;
  CHECK(result.exit_code == 3);
  CHECK_FALSE(scene.floor.Moves());
  CHECK_THAT(result.err, Catch::Contains("rift: the log is not whole") && Catch::Contains(says));
  CHECK((*summary)["state"] == "interrupted");
  return true;
}

TEST_CASE("A run folder that is removed during the drive stops the robot first") {
  Uninterrupted(kAll, [](Scene& scene) {
    std::vector<std::string> arguments = scene.Arguments();
    arguments.push_back("--json");
    test::RunningRift rift(arguments);
    WaitForRows(rift, scene);
    if (!rift.IsRunning()) return false;
    std::filesystem::remove_all(scene.folder / "run");
    if (!IsStoppedForItsLog(rift, scene, "was removed or moved")) return false;
    CHECK_FALSE(std::filesystem::exists(scene.folder / "run"));
    return true;
  });
}

TEST_CASE("A log that finds no room stops the robot first and keeps its rows") {
  Uninterrupted(kAll, [](Scene& scene) {
    std::vector<std::string> arguments = scene.Arguments();
    arguments.push_back("--json");
    std::optional<test::FileSizeLimit> limit(kRoom);
    test::RunningRift rift(arguments);
    limit.reset();
    if (!IsStoppedForItsLog(rift, scene, "File too large")) return false;
    CHECK_THAT(LogOf(scene), Catch::EndsWith("\n"));
    CHECK(LogOf(scene).size() > kRoom / 2);
    CHECK(scene.Summary()["state"] == "interrupted");
    return true;
  });
}

TEST_CASE("What is no drive cannot be replayed and is refused in one line") {
  const test::TemporaryFolder folder;
  const auto refused = [](const std::vector<std::string>& words) {
    std::vector<std::string> arguments{"drive", "--replay"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const test::ProcessResult result = test::RunRift(arguments);
    CHECK(result.exit_code == 2);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    return result.err;
  };
  CHECK_THAT(refused({folder / "none"}), Catch::Contains("none holds no drive"));
  CHECK_THAT(refused({folder.Path()}), Catch::Contains("no experiment.yaml in it"));
  CHECK_THAT(refused({folder.Path(), "--port", "/dev/rfcomm0"}), Catch::Contains("--port"));
}

TEST_CASE("A camera that goes away in the middle stops the robot even without a display") {
  const test::Environment display("DISPLAY", "");
  Uninterrupted(10, [](Scene& scene) {
    std::vector<std::string> arguments = scene.Arguments();
    arguments.push_back("--view");
    const test::ProcessResult result = test::RunRift(arguments);
    if (WasInterrupted(scene, result.exit_code)) return false;
    INFO(result.out << result.err);
    CHECK(result.exit_code == 1);
    CHECK_FALSE(scene.floor.Moves());
    CHECK_THAT(result.err,
               Catch::Contains("DISPLAY is not set") && Catch::Contains("driving without --view"));
    CHECK(scene.Summary()["stop"]["reason"] == "camera_gone");
    CHECK(scene.Summary()["stop"]["acknowledged"] == true);
    return true;
  });
}

TEST_CASE("Nobody to press a key and no yes is refused before the port is opened") {
  Scene scene;
  std::vector<std::string> arguments = scene.Arguments();
  arguments.pop_back();
  const test::ProcessResult result = test::RunRift(arguments);
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.err, Catch::Contains("give --yes"));
  CHECK_FALSE(std::filesystem::exists(scene.folder.Path() / "run"));
}

/// A device that shows one of the recorded pictures of 960x720 for ever: the robot stands still.
struct Device {
  Device() {
    std::filesystem::create_directory(folder.Path() / "frames");
    std::filesystem::copy_file(test::SourceDir() + "/data/camera/frames/000.jpg",
                               folder / "frames/000.jpg");
  }
  test::TemporaryFolder folder;
  const test::Environment shim{"LD_PRELOAD", test::BuildDir() + "/tests/librift_v4l2_shim.so"};
  const test::Environment jpegs{"RIFT_SHIM_JPEGS", folder / "frames"};
};

TEST_CASE("A device is asked for the size of its calibration as in tracking") {
  const std::string calibration = test::SourceDir() + "/data/camera/camera.yaml";
  const Device device;
  Uninterrupted(kAll, [&calibration](Scene& scene) {
    std::vector<std::string> arguments = scene.Arguments();
    const auto set = [&arguments](const std::string& flag, const std::string& value) {
      *(std::find(arguments.begin(), arguments.end(), flag) + 1) = value;
    };
    set("--camera", "/dev/video0");
    set("--calibration", calibration);
    // One picture for ever repeats, and until the robot first tells that its wheels stand, they are
    // taken to do as they are told.
    arguments.insert(
        arguments.end(),
        {"--set", "trial.timeout_s=3", "--set", "track.capture.same_s=60", "--set",
         "hardware.turn.enabled=false", "--set", "hardware.evidence.repeats_s=60", "--any-start"});
    const test::ProcessResult result = test::RunRift(arguments);
    if (WasInterrupted(scene, result.exit_code)) return false;
    INFO(result.out << result.err);
    CHECK(result.exit_code == 1);
    CHECK_THAT(result.err, Catch::Contains("the robot stands at x"));
    CHECK(scene.Summary()["outcome"] == "timed_out");
    CHECK(scene.Summary()["poses"] > 5);
    const std::string kept = files::ReadFile(scene.folder / "run/camera.yaml");
    CHECK(vision::ReadCamera(kept, "camera.yaml").width_px == 960);
    return true;
  });

  const test::TemporaryFolder folder;
  const test::ProcessResult tracked =
      test::RunRift({"track", "--camera", "/dev/video0", "--calibration", calibration, "--out",
                     folder / "log.csv", "--duration", "2", "--set", "track.capture.same_s=60"});
  INFO(tracked.out << tracked.err);
  CHECK(tracked.exit_code == 0);
}

TEST_CASE("How far the reference tags may lie off before a drive is an option of it") {
  // Marks that the picture shows 20 px from where they set the frame.
  const std::string calibration = test::SourceDir() + "/data/camera/camera.yaml";
  Scene scene;
  test::WriteText(scene.folder / "moved.yaml", files::ReadFile(calibration));
  const Device device;
  const test::ProcessResult framed = test::RunRift(
      {"track", "--camera", "/dev/video0", "--calibration", scene.folder / "moved.yaml", "--world",
       test::SourceDir() + "/data/camera/tags.yaml"});
  INFO(framed.err);
  REQUIRE(framed.exit_code == 0);
  const std::string path = scene.folder / "moved.yaml";
  vision::CameraModel camera = vision::ReadCamera(files::ReadFile(path), path);
  for (vision::ReferenceMark& mark : camera.world->marks) mark.seen_px.x() += 20.0;
  camera.k(0, 2) += 20.0;  // else the frame would be of another lens
  test::WriteText(path, vision::WriteCamera(camera));
  for (const bool is_allowed : {false, true}) {
    std::vector<std::string> arguments{
        "drive",         scene.folder / "task.yaml",
        "--port",        scene.floor.Port(),
        "--camera",      "/dev/video0",
        "--calibration", path,
        "--out",         scene.folder / (is_allowed ? "allowed" : "warned"),
        "--yes",         "--any-start",
        "--set",         "trial.timeout_s=1",
        "--set",         "track.capture.same_s=60",
        "--set",         "hardware.turn.enabled=false"};
    if (is_allowed) arguments.insert(arguments.end(), {"--moved", "0.1"});
    const test::ProcessResult result = test::RunRift(arguments);
    INFO(result.err);
    CHECK(result.exit_code == 1);
    const bool is_warned = result.err.find("the camera was moved") != std::string::npos;
    CHECK(is_warned == !is_allowed);
  }
}

TEST_CASE("A camera that is found moved when a drive is over is said") {
  Uninterrupted(kAll, [](Scene& scene) {
    // The robot's own tag for a reference tag: it lies elsewhere at the end.
    vision::CameraModel camera = test::SmallCamera();
    const geometry::Pose2 start = scene.floor.Pose();
    const Eigen::Vector3d p(start.x_m, start.y_m, 0.03);
    const Eigen::Vector3d p_in_camera = camera.world->world_from_camera.inverse() * p;
    camera.world->marks = {{0, p, vision::PixelsFromPoints(camera, {p_in_camera})[0]}};
    test::WriteText(scene.folder / "cam.yaml", vision::WriteCamera(camera));
    const test::ProcessResult result = test::RunRift(scene.ShortArguments());
    if (WasInterruptedOrLate(scene, result.exit_code)) return false;
    INFO(result.out << result.err);
    CHECK(result.exit_code == 0);
    CHECK_THAT(result.err, !Catch::Contains("warning: the camera was moved"));
    CHECK_THAT(result.err, Catch::Contains("warning: after this drive the camera was moved: the "
                                           "reference tags lie"));
    return true;
  });
}

// Before it drives where ten pictures show it at rest by then, which a loaded machine may not have.
TEST_CASE("A tag of another size than told is said by a drive") {
  Uninterrupted(kAll, [](Scene& scene) {
    std::vector<std::string> arguments = scene.ShortArguments();
    arguments.insert(arguments.end(), {"--any-start", "--set", "track.tag.size_m=0.052", "--set",
                                       "trial.timeout_s=1"});
    const test::ProcessResult result = test::RunRift(arguments);
    INFO(result.out << result.err);
    const bool is_said =
        result.err.find("warning: the tag is not on the floor in 10 of 10") != std::string::npos;
    // By such poses it is stopped as well, sooner or later, so that what was said counts first.
    if (!is_said && WasInterrupted(scene, result.exit_code)) return false;
    CHECK(is_said);
    return true;
  });
}

TEST_CASE("Wrong inputs of a drive are answered with one line that says what to do") {
  const Scene scene;
  const auto replaced = [&scene](const std::string& flag, const std::string& value) {
    std::vector<std::string> arguments = scene.Arguments();
    *(std::find(arguments.begin(), arguments.end(), flag) + 1) = value;
    return test::RunRift(arguments);
  };
  vision::CameraModel camera = test::SmallCamera();
  camera.width_px = 640;
  test::WriteText(scene.folder / "size.yaml", vision::WriteCamera(camera));
  camera.world.reset();
  test::WriteText(scene.folder / "nowhere.yaml", vision::WriteCamera(camera));
  test::WriteText(scene.folder / "picture", "");
  struct Wrong {
    std::string flag, value;
    int exit_code;
    std::string says;
  };
  for (const Wrong& wrong : {
           Wrong{"--port", "/dev/no_such_port", 3, "there is no serial port /dev/no_such_port"},
           Wrong{"--port", "/dev/null", 3, "is no serial port"},
           Wrong{"--calibration", scene.folder / "nowhere.yaml", 2, "has no world frame"},
           Wrong{"--calibration", scene.folder / "none.yaml", 2, "No such file"},
           Wrong{"--calibration", scene.folder / "size.yaml", 2, "960x540 pixels and its"},
           Wrong{"--camera", "/dev/video99", 3, "/dev/video99"},
           Wrong{"--camera", "http://127.0.0.1:1/video", 3, "http://127.0.0.1:1/video"},
           Wrong{"drive", scene.folder / "none.yaml", 2, "No such file"},
       }) {
    const test::ProcessResult result = replaced(wrong.flag, wrong.value);
    INFO(wrong.flag << " " << wrong.value << ": " << result.err);
    CHECK(result.exit_code == wrong.exit_code);
    CHECK_THAT(result.err, Catch::StartsWith("rift: ") && Catch::Contains(wrong.says));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  }
}

}  // namespace
}  // namespace rift
