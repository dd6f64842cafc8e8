// What a person does in the window of rift drive --view.
#include <catch2/catch.hpp>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "drive_scene.hpp"
#include "hardware/keyboard.hpp"
#include "rift/sessions/drive/session.hpp"
#include "support/processes/environment.hpp"
#include "track/window_user.hpp"

namespace rift {
namespace {

TEST_CASE("A key in the window stops a robot that drives and none that waits for Enter") {
  const test::VirtualDisplay server;
  if (!test::CanUseWindows(server)) return;
  const test::Environment display("DISPLAY", server.Name());
  const std::string press = test::WindowOf("rift drive") + "windowfocus --sync %1 key ";
  test::Uninterrupted(test::kAll, [&press](test::Scene& scene) {
    hardware::Keyboard keyboard;
    const auto experiment =
        experiment::LoadExperiment(scene.folder / "task.yaml", {}, files::ReadFile);
    std::atomic<bool> is_asked = false, has_waited = false;
    sessions::DriveSession session(
        {.address = {scene.floor.Port(), scene.floor.Camera(), scene.folder / "cam.yaml"},
         .view = true},
        {.say = [&](const std::string& line) { is_asked = is_asked || line.starts_with("hands"); },
         .show = [](const std::string&) {},
         .hide = [] {},
         .ring = [] {},
         .ask = [](const std::string&, std::string_view keys) { return keys.front(); }});
    std::optional<hardware::DriveRun> run;
    {
      const std::jthread hands([&](const std::stop_token& over) {
        const auto wait_for = [&](const auto& is_so) {
          while (!over.stop_requested() && !is_so()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
          }
        };
        wait_for([&] { return is_asked.load(); });
        wait_for([&] { return test::Succeeds(press + "space"); });
        std::this_thread::sleep_for(std::chrono::milliseconds(500));  // some pictures
        has_waited = !over.stop_requested();
        keyboard.Press('\n');
        wait_for([&] { return scene.floor.Moves(); });
        wait_for([&] { return test::Succeeds(press + "space"); });
      });
      try {
        run = session.DriveInto(scene.folder.Path() / "run", experiment);
      } catch (const std::runtime_error& busy) {
        return false;
      }
    }
    CHECK(has_waited);
    const auto& stop = run->evidence.stop;
    if (!run->has_begun || stop->reason > hardware::StopReason::kSignal) return false;  // busy
    CHECK(stop->reason == hardware::StopReason::kOperator);
    CHECK(stop->text == "a key was pressed in the window");
    CHECK_FALSE(scene.floor.Moves());
    return true;
  });
}

}  // namespace
}  // namespace rift
