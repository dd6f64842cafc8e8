// What is found out before a robot moves.
#include <catch2/catch.hpp>
#include <filesystem>
#include <stdexcept>
#include <string>

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

}  // namespace
}  // namespace rift
