#include "rift/view/window.hpp"

#include <fmt/format.h>
#include <xcb/xcb.h>
#include <opencv2/highgui.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "painter.hpp"
#include "rift/view/film.hpp"
#include "rift/view/video.hpp"

namespace rift::view {

std::string MissingDisplay() {
  const char* name = std::getenv("DISPLAY");
  if (name == nullptr || *name == '\0') {
    return "no window: DISPLAY is not set (on Wayland, Xwayland sets it)";
  }
  // Qt ends the whole process when it cannot connect, so this asks first.
  xcb_connection_t* connection = xcb_connect(nullptr, nullptr);
  const bool failed = xcb_connection_has_error(connection) != 0;
  xcb_disconnect(connection);
  return failed ? fmt::format("no window: the display {} does not answer", name) : std::string();
}

namespace {

/// Where libdbus looks for the bus of a session.
bool HasMessageBus() {
  if (std::getenv("DBUS_SESSION_BUS_ADDRESS") != nullptr) return true;
  const char* folder = std::getenv("XDG_RUNTIME_DIR");
  std::error_code ignored;
  return folder != nullptr &&
         std::filesystem::exists(std::filesystem::path(folder) / "bus", ignored);
}

}  // namespace

void RequireDisplay() {
  if (const std::string missing = MissingDisplay(); !missing.empty()) {
    throw std::runtime_error(missing);
  }
  // The display that was looked at is the one to open: with another plugin Qt aborts when that one
  // is missing.
  setenv("QT_QPA_PLATFORM", "xcb", 1);
  // Qt looks for a message bus, and libdbus starts one where there is none: a fork of a process of
  // many threads, after which one start in a hundred hangs for ever.
  if (!HasMessageBus()) setenv("DBUS_SESSION_BUS_ADDRESS", "disabled:", 1);
}

namespace {

constexpr const char* kWindow = "rift";

class Window {
 public:
  Window() {
    RequireDisplay();
    cv::namedWindow(kWindow, cv::WINDOW_AUTOSIZE | cv::WINDOW_GUI_NORMAL);
  }
  ~Window() {
    if (IsOpen()) cv::destroyWindow(kWindow);
  }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  bool IsOpen() const { return cv::getWindowProperty(kWindow, cv::WND_PROP_VISIBLE) > 0.0; }
};

std::vector<std::string> Keys(const Playback& playback) {
  return {fmt::format("{}speed {:g} x", playback.paused ? "PAUSED, " : "", playback.speed),
          "space: pause   arrows: speed", "r: from the start   q: quit"};
}

}  // namespace

void PlayInWindow(const Film& film, const ViewOptions& options) {
  using Clock = std::chrono::steady_clock;
  const Window window;
  const Painter painter(film.fixed, {options.width_px, options.height_px});
  const int last = static_cast<int>(film.scenes.size()) - 1;
  const double duration_s = last / film.fps;
  const int wait_ms = std::max(1, static_cast<int>(500.0 / film.fps));
  Playback playback{.speed = options.speed};
  Clock::time_point then = Clock::now();
  do {
    const int index = std::min(last, static_cast<int>(std::lround(playback.t_s * film.fps)));
    cv::imshow(kWindow, painter.Paint(film.scenes[index], Keys(playback)));
    playback = AfterKey(playback, cv::waitKeyEx(wait_ms));
    const Clock::time_point now = Clock::now();
    playback = AfterTime(playback, std::chrono::duration<double>(now - then).count(), duration_s);
    then = now;
  } while (!playback.left && window.IsOpen() &&
           !(playback.t_s >= duration_s && playback.over_since_s >= options.hold_s));
}

void ShowFilm(const Film& film, const std::string& video, bool window,
              const std::function<void(const std::string&)>& say) {
  if (!video.empty()) WriteVideo(film, video, {});
  if (!window) return;
  const std::string no_display = MissingDisplay();
  if (no_display.empty()) {
    PlayInWindow(film, {});
  } else {
    say("note: --view shows nothing: " + no_display);
  }
}

}  // namespace rift::view
