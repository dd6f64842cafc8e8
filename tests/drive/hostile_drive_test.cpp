// Drives in an environment that is against them; commands/hostile_environment_test.cpp has the
// other commands, drive_binary_test.cpp streams and a folder that is removed.
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <list>
#include <nlohmann/json.hpp>
#include <thread>

#include "drive_scene.hpp"
#include "support/processes/broken_streams.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/small_disk.hpp"
#include "support/processes/terminal_run.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using test::Environment;
using test::kAll;
using test::Scene;
using test::Uninterrupted;
using test::WasInterruptedOrLate;

TEST_CASE("A run folder that cannot be written ends a drive before anything moves") {
  Scene scene;
  fs::create_directory(scene.folder / "run");
  test::SmallDisk disk(scene.folder / "run");
  RIFT_SKIP_WITHOUT(disk);
  disk.MakeReadOnly();
  const geometry::Pose2 start = scene.floor.Pose();
  const test::ProcessResult result = test::RunRift(scene.Arguments());
  INFO(result.out << result.err);
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Catch::Contains("run/experiment.yaml: Read-only file system"));
  CHECK(scene.floor.Pose() == start);
  CHECK_FALSE(scene.floor.Moves());
}

TEST_CASE("A disk that becomes full stops the robot first and keeps whole rows") {
  Uninterrupted(kAll, [](Scene& scene) {
    fs::create_directory(scene.folder / "run");
    test::SmallDisk disk(scene.folder / "run");
    if (!disk.IsThere()) {
      WARN("SKIPPED: this process may mount no disk (root)");
      return true;
    }
    disk.Resize(60);  // more than the experiment, less than a drive
    std::vector<std::string> arguments = scene.Arguments();
    arguments.push_back("--json");
    const test::ProcessResult result = test::RunRift(arguments);
    INFO(result.out << result.err);
    if (!test::StoppedForItsLog(result)) return false;
    CHECK(result.exit_code == 3);
    CHECK_FALSE(scene.floor.Moves());
    CHECK_THAT(result.err, Catch::Contains("rift: the log is not whole") &&
                               Catch::Contains("No space left on device"));
    const std::string log = files::ReadFile(scene.folder / "run/trajectory.csv");
    CHECK(log.size() > 1000);
    CHECK_THAT(log, Catch::EndsWith("\n"));
    CHECK(scene.Summary()["state"] == "interrupted");
    return true;
  });
}

TEST_CASE("A run folder that is replaced during the drive stops the robot first") {
  Uninterrupted(kAll, [](Scene& scene) {
    std::vector<std::string> arguments = scene.Arguments();
    arguments.push_back("--json");
    test::RunningRift rift(arguments);
    test::WaitForMotion(rift, scene);
    const fs::path run = scene.folder / "run", elsewhere = scene.folder / "elsewhere";
    test::WaitUntil("the log is there or the drive is over",
                    [&] { return fs::exists(run / "encoders.csv") || !rift.IsRunning(); });
    if (!rift.IsRunning()) return false;
    fs::rename(run, elsewhere);
    fs::copy(elsewhere, run);
    const test::ProcessResult result = rift.Wait();
    INFO(result.out << result.err);
    if (!test::StoppedForItsLog(result)) return false;
    CHECK(result.exit_code == 3);
    CHECK_FALSE(scene.floor.Moves());
    CHECK_THAT(result.err, Catch::Contains("was removed or moved"));
    return true;
  });
}

TEST_CASE("A drive without display, home and locale, with a clock that jumps, arrives") {
  Uninterrupted(kAll, [](Scene& scene) {
    std::list<Environment> changed;
    for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "HOME", "TERM", "LANG"}) {
      changed.emplace_back(name, std::nullopt);
    }
    changed.emplace_back("LC_ALL", "xx_XX.UTF-8");
    changed.emplace_back("LD_PRELOAD", test::BuildDir() + "/tests/librift_system_shim.so");
    changed.emplace_back("RIFT_SHIM_CLOCK", "1");
    const test::ProcessResult result = test::RunRift(scene.ShortArguments());
    if (WasInterruptedOrLate(scene, result.exit_code)) return false;
    INFO(result.out << result.err);
    CHECK(result.exit_code == 0);
    CHECK(scene.Summary()["outcome"] == "reached");
    CHECK(scene.Summary()["stop"]["acknowledged"] == true);
    return true;
  });
}

TEST_CASE("A drive in a terminal of 20 columns is started by Enter and its lines fit") {
  Uninterrupted(kAll, [](Scene& scene) {
    std::vector<std::string> arguments = scene.ShortArguments();
    arguments.pop_back();  // --yes
    bool is_started = false;
    const test::TerminalRun run = test::RunInTerminal(arguments, 20, [&](const std::string& shown) {
      const bool is_asked = shown.find("put the robot at t") != std::string::npos;
      if (is_started || !is_asked) return "";
      is_started = true;
      return "\n";
    });
    if (WasInterruptedOrLate(scene, run.exit_code)) return false;
    INFO(run.shown);
    CHECK(run.exit_code == 0);
    CHECK(is_started);
    CHECK(run.LongestInPlace("put the robot") == 19);
    CHECK(run.LongestInPlace("the robot drives") == 19);
    CHECK(scene.Summary()["outcome"] == "reached");
    return true;
  });
}

TEST_CASE("A drive whose words nobody reads waits before anything moves, and then arrives") {
  Uninterrupted(kAll, [](Scene& scene) {
    const test::UnreadPipe pipe(scene.folder / "pipe");
    pipe.Fill();
    const geometry::Pose2 start = scene.floor.Pose();
    test::RunningRift rift(scene.ShortArguments(), "2>" + pipe.Path());
    std::this_thread::sleep_for(std::chrono::seconds(3));
    CHECK(rift.IsRunning());
    CHECK(scene.floor.Pose() == start);
    CHECK_FALSE(scene.floor.Moves());
    std::string told = pipe.Drain();
    const test::ProcessResult result = rift.Wait();
    told += pipe.Drain();
    if (WasInterruptedOrLate(scene, result.exit_code)) return false;
    INFO(result.out << told);
    CHECK(result.exit_code == 0);
    CHECK_THAT(told, Catch::Contains("worst stopping distance"));
    CHECK(scene.Summary()["outcome"] == "reached");
    return true;
  });
}

TEST_CASE("A robot under way is driven on and stopped when nobody reads the words any more") {
  Uninterrupted(kAll, [](Scene& scene) {
    const test::UnreadPipe pipe(scene.folder / "pipe");
    test::RunningRift rift(scene.ShortArguments(), "2>" + pipe.Path());
    std::string told;
    test::WaitUntil("the first leg began or the drive is over", [&] {
      told += pipe.Drain();
      return told.find("loop delay") != told.npos || !rift.IsRunning();
    });
    WaitForMotion(rift, scene);
    pipe.Fill();
    test::WaitUntil("the drive is saved", [&] {
      if (!rift.IsRunning()) return true;
      const std::string file = scene.folder / "run/summary.json";
      return fs::exists(file) && scene.Summary().value("state", "") != "interrupted";
    });
    const bool moves = scene.floor.Moves();
    told += pipe.Drain();
    const test::ProcessResult result = rift.Wait();
    if (WasInterruptedOrLate(scene, result.exit_code)) return false;
    INFO(result.out << told);
    CHECK_FALSE(moves);
    CHECK(result.exit_code == 0);
    CHECK(scene.Summary()["outcome"] == "reached");
    CHECK(scene.Summary()["stop"]["acknowledged"] == true);
    return true;
  });
}

}  // namespace
}  // namespace rift
