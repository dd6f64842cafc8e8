#include "rift/view/display.hpp"

#include <fmt/format.h>
#include <xcb/xcb.h>

#include <cstdlib>
#include <stdexcept>

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

void RequireDisplay() {
  if (const std::string missing = MissingDisplay(); !missing.empty()) {
    throw std::runtime_error(missing);
  }
  // The display that was looked at is the one to open: with another plugin Qt aborts when that one
  // is missing.
  setenv("QT_QPA_PLATFORM", "xcb", 1);
}

}  // namespace rift::view
