// What a person does in the window of rift drive --view.
#include <xcb/xcb.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <optional>
#include <stdexcept>
#include <stop_token>
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

/// A drive under --view, at whose keyboard and window a person is.
class DriveInWindow {
 public:
  explicit DriveInWindow(test::Scene& scene)
      : scene_(scene),
        session_({.address = {scene.floor.Port(), scene.floor.Camera(), scene.folder / "cam.yaml"},
                  .view = true},
                 {.say = [this](const std::string& line) { Hear(line); },
                  .show = [](const std::string&) {},
                  .hide = [] {},
                  .ring = [] {},
                  .ask = [](const std::string&, std::string_view keys) { return keys.front(); }}) {}

  bool IsAsked() const { return is_asked_; }
  void Press(char key) { keyboard_.Press(key); }

  /// `hand`: what the person does until it is over. None where a busy machine did not let it begin.
  std::optional<hardware::DriveRun> By(const std::function<void(const std::stop_token&)>& hand) {
    const auto experiment =
        experiment::LoadExperiment(scene_.folder / "task.yaml", {}, files::ReadFile);
    const std::jthread person(hand);
    try {
      return session_.DriveInto(scene_.folder.Path() / "run", experiment);
    } catch (const std::runtime_error& busy) {
      return std::nullopt;
    }
  }

 private:
  void Hear(const std::string& line) { is_asked_ = is_asked_ || line.starts_with("hands"); }

  test::Scene& scene_;
  hardware::Keyboard keyboard_;
  std::atomic<bool> is_asked_ = false;
  sessions::DriveSession session_;
};

/// Looks again and again; until the drive is over at most.
void WaitFor(const std::stop_token& over, const std::function<bool()>& is_so) {
  while (!over.stop_requested() && !is_so()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

TEST_CASE("A key in the window stops a robot that drives and none that waits for Enter") {
  if (!test::CanUseWindows(Server())) return;
  const test::Environment display("DISPLAY", Server().Name());
  const std::string press = test::WindowOf("rift drive") + "windowfocus --sync %1 key ";
  test::Uninterrupted(test::kAll, [&press](test::Scene& scene) {
    DriveInWindow drive(scene);
    std::atomic<bool> has_waited = false;
    const auto run = drive.By([&](const std::stop_token& over) {
      const auto press_space = [&] { return test::Succeeds(press + "space"); };
      WaitFor(over, [&] { return drive.IsAsked(); });
      WaitFor(over, press_space);
      std::this_thread::sleep_for(std::chrono::milliseconds(500));  // some pictures
      has_waited = !over.stop_requested();
      drive.Press('\n');
      WaitFor(over, [&] { return scene.floor.Moves(); });
      WaitFor(over, press_space);
    });
    if (!run) return false;
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
    DriveInWindow drive(scene);
    std::atomic<bool> is_closed = false;
    const auto run = drive.By([&](const std::stop_token& over) {
      const std::string id = scene.folder / "window";
      const std::string find = test::WindowOf("rift drive") + " > " + id + " 2>/dev/null";
      WaitFor(over, [&] { return drive.IsAsked() && test::RunShell(find) == 0; });
      if (over.stop_requested()) return;
      AskToClose(Server().Name(), static_cast<xcb_window_t>(std::stoul(files::ReadFile(id))));
      is_closed = true;
      const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(10);
      WaitFor(over, [&] { return std::chrono::steady_clock::now() >= late; });
      drive.Press('q');  // or nothing would end it
    });
    if (!run || !is_closed) return false;  // a busy machine came first
    CHECK_FALSE(run->has_begun);
    REQUIRE(run->evidence.stop);
    CHECK(run->evidence.stop->text == "the window was closed");
    CHECK_FALSE(scene.floor.Moves());
    return true;
  });
}

}  // namespace
}  // namespace rift
