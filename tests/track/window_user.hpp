#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "support/processes/running_rift.hpp"
#include "support/processes/shell.hpp"
#include "support/processes/virtual_display.hpp"

namespace rift::test {

/// Whether a shell ends with 0; what it prints is dropped.
inline bool Succeeds(const std::string& command) {
  return RunShell(command + " >/dev/null 2>&1") == 0;
}

/// Whether a window can be opened, and keys and clicks sent to it; says so where it cannot.
inline bool CanUseWindows(const VirtualDisplay& display) {
  if (display.Runs() && Succeeds("command -v xdotool")) return true;
  WARN("SKIPPED: Xvfb or xdotool is not installed");
  return false;
}

/// The words of xdotool that find the window of this title; what is to be done with it comes after.
inline std::string WindowOf(const std::string& title) {
  return "xdotool search --onlyvisible --name '^" + title + "$' ";
}

inline void WaitForPicture(RunningRift& rift, const std::string& window) {
  rift.WaitUntil("the window shows a picture", [&] {
    return Succeeds("test $(" + window +
                    "getwindowgeometry --shell | sed -n s/^HEIGHT=//p) -gt 300");
  });
}

inline int CountOf(const std::string& word, const std::string& text) {
  int count = 0;
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++count;
  return count;
}

}  // namespace rift::test
