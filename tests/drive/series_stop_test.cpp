// What ends a series of drives that asks nobody.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "drive_scene.hpp"
#include "hardware/keyboard.hpp"
#include "rift/sessions/drive/series.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using sessions::SeriesEnd;
using test::Scene;
using test::Uninterrupted;

/// Two drives of the scene with --yes, driven by this process wherever the robot stands.
class TwoDrives {
 public:
  explicit TwoDrives(Scene& scene, const std::vector<std::string>& before_each = {})
      : out_(scene.folder.Path() / "run"),
        series_{.out = out_,
                .plan = sessions::PlanRepeats(
                    experiment::LoadExperiment(scene.folder / "task.yaml", {}, files::ReadFile), 2,
                    out_),
                .before_each = before_each,
                .setup = {.address = {scene.floor.Port(), scene.floor.Camera(),
                                      scene.folder / "cam.yaml"},
                          .yes = true,
                          .any_start = true}} {}

  void Drive() {
    const sessions::Console console{
        .say = [this](const std::string& line) { Say(line); },
        .show = [](const std::string&) {},
        .hide = [] {},
        .ring = [] {},
        .ask = [](const std::string&, std::string_view keys) { return keys.front(); }};
    try {
      end = sessions::DriveAll(series_, console, [] {});
    } catch (const std::runtime_error& thrown) {
      error = thrown.what();
    }
  }
  bool WasTold(const std::string& words) {
    const std::lock_guard lock(mutex_);
    return std::any_of(told_.begin(), told_.end(),
                       [&](const std::string& line) { return line.find(words) != line.npos; });
  }
  /// Why the first drive was stopped; empty when it never began or arrived.
  std::string FirstStop() const {
    const nlohmann::json stop = FirstStopJson();
    return stop.is_null() ? "" : stop["reason"].get<std::string>();
  }
  bool FirstWasAcknowledged() const { return FirstStopJson()["acknowledged"] == true; }

  std::optional<SeriesEnd> end;
  std::string error;

 private:
  nlohmann::json FirstStopJson() const {
    const auto text = files::ReadIfThere(out_ / "1.unfinished/summary.json");
    const auto summary = text ? nlohmann::json::parse(*text) : nlohmann::json();
    return summary.contains("stop") ? summary["stop"] : nlohmann::json();
  }
  void Say(const std::string& line) {
    const std::lock_guard lock(mutex_);
    told_.push_back(line);
  }

  fs::path out_;
  sessions::DriveSeries series_;
  std::mutex mutex_;
  std::vector<std::string> told_;
};

TEST_CASE("A key ends a series that asks nobody and no drive follows") {
  Uninterrupted(test::kAll, [](Scene& scene) {
    hardware::Keyboard keyboard;
    TwoDrives drives(scene);
    {
      const std::jthread hand([&](const std::stop_token& over) {
        while (!over.stop_requested() && !scene.floor.Moves()) {
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        keyboard.Press('x');
      });
      drives.Drive();
    }
    INFO(drives.error);
    if (drives.FirstStop() != "operator") return false;  // a busy machine came first
    CHECK(drives.end == SeriesEnd::kQuit);
    CHECK_FALSE(drives.WasTold("drive 2 of 2"));
    CHECK(drives.WasTold("stopped; the same command goes on where it was"));
    CHECK_FALSE(scene.floor.Moves());
    return true;
  });
}

TEST_CASE("A fault ends a series that asks nobody unless a command puts the scene back") {
  for (const bool is_reset : {false, true}) {
    const std::vector<std::string> none, reset{"true"};
    constexpr int kMovingPictures = 20;
    Uninterrupted(kMovingPictures, [&](Scene& scene) {
      TwoDrives drives(scene, is_reset ? reset : none);
      drives.Drive();
      // Refused, or answered late, on a busy machine.
      if (drives.FirstStop().empty() || !drives.FirstWasAcknowledged()) return false;
      INFO(drives.FirstStop() << ": " << drives.error);
      CHECK((drives.end == SeriesEnd::kQuit) == !is_reset);
      CHECK(drives.WasTold("drive 2 of 2") == is_reset);
      CHECK(drives.WasTold("the series ends with this fault") == !is_reset);
      CHECK_FALSE(scene.floor.Moves());
      return true;
    });
  }
}

TEST_CASE("No drive follows one whose stop the robot did not acknowledge, and that is said") {
  constexpr int kMovingPictures = 5;
  Uninterrupted(kMovingPictures, [](Scene& scene) {
    scene.floor.FallSilentOnceItMoves();
    TwoDrives drives(scene, {"true"});  // which puts the scene back
    drives.Drive();
    if (drives.FirstStop().empty() || drives.FirstWasAcknowledged())
      return false;  // before it moved
    INFO(drives.FirstStop() << ": " << drives.error);
    CHECK(drives.end == SeriesEnd::kQuit);
    CHECK(drives.WasTold("THE ROBOT DID NOT ACKNOWLEDGE THE STOP"));
    CHECK_FALSE(drives.WasTold("drive 2 of 2"));
    return true;
  });
}

}  // namespace
}  // namespace rift
