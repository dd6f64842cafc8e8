// What a person does in the window of rift drive --view.
#include <xcb/xcb.h>

#include <catch2/catch.hpp>
#include <cstdlib>
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

/// For all windows of this process: Qt opens one display, and takes the process along with it.
const test::VirtualDisplay& Server() {
  static const test::VirtualDisplay server;
  return server;
}

TEST_CASE("A key in the window stops a robot that drives and none that waits for Enter") {
  if (!test::CanUseWindows(Server())) return;
  const test::Environment display("DISPLAY", Server().Name());
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

/// Asks a window to close, as the button of its frame does.
void AskToClose(const std::string& display, xcb_window_t window) {
  xcb_connection_t* const x = xcb_connect(display.c_str(), nullptr);
  const auto atom = [x](std::string_view name) {
    const auto asked = xcb_intern_atom(x, 0, static_cast<std::uint16_t>(name.size()), name.data());
    xcb_intern_atom_reply_t* const reply = xcb_intern_atom_reply(x, asked, nullptr);
    const xcb_atom_t number = reply == nullptr ? xcb_atom_t{XCB_ATOM_NONE} : reply->atom;
    std::free(reply);
    return number;
  };
  xcb_client_message_event_t event{};
  event.response_type = XCB_CLIENT_MESSAGE;
  event.format = 32;
  event.window = window;
  event.type = atom("WM_PROTOCOLS");
  event.data.data32[0] = atom("WM_DELETE_WINDOW");
  const auto sent = xcb_send_event_checked(x, 0, window, XCB_EVENT_MASK_NO_EVENT,
                                           reinterpret_cast<const char*>(&event));
  std::free(xcb_request_check(x, sent));  // waits: the server drops what a client leaves behind
  xcb_disconnect(x);
}

TEST_CASE("Closing the window gives up a drive that waits for Enter") {
  if (!test::CanUseWindows(Server())) return;
  const test::Environment display("DISPLAY", Server().Name());
  test::Uninterrupted(test::kAll, [](test::Scene& scene) {
    hardware::Keyboard keyboard;
    const auto experiment =
        experiment::LoadExperiment(scene.folder / "task.yaml", {}, files::ReadFile);
    std::atomic<bool> is_asked = false, is_closed = false;
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
      const std::jthread hand([&](const std::stop_token& over) {
        const std::string id = scene.folder / "window";
        const std::string find = test::WindowOf("rift drive") + " > " + id + " 2>/dev/null";
        while (!over.stop_requested() && !(is_asked && test::RunShell(find) == 0)) {
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        if (over.stop_requested()) return;
        AskToClose(Server().Name(), static_cast<xcb_window_t>(std::stoul(files::ReadFile(id))));
        is_closed = true;
        const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(10);
        while (!over.stop_requested() && std::chrono::steady_clock::now() < late) {
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        keyboard.Press('q');  // or nothing would end it
      });
      try {
        run = session.DriveInto(scene.folder.Path() / "run", experiment);
      } catch (const std::runtime_error& busy) {
        return false;
      }
    }
    if (!is_closed) return false;  // a busy machine came first
    CHECK_FALSE(run->has_begun);
    REQUIRE(run->evidence.stop);
    CHECK(run->evidence.stop->text == "the window was closed");
    CHECK_FALSE(scene.floor.Moves());
    return true;
  });
}

}  // namespace
}  // namespace rift
