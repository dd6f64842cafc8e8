#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "rift/vision/tracking/session_options.hpp"

namespace rift::sessions {

/// Where a robot and its camera are to be found; what is empty stays as it was.
struct DriveAddress {
  std::string port;
  std::string camera;
  std::string calibration;

  /// Calls field(key, member, what the value is called, help) for every member.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("port", self.port, "TTY", "the robot's serial port, such as /dev/rfcomm0");
    field("camera", self.camera, "DEVICE|URL",
          "the camera above the floor: /dev/video0, or an http:// or rtsp:// stream");
    field("calibration", self.calibration, "FILE.yaml",
          "the camera's lens and where it hangs, as rift track writes them");
  }
};

/// What drives have in common, whatever is driven.
struct DriveSetup {
  DriveAddress address;
  vision::SessionOptions session;  ///< of it moved_m
  bool view = false;               ///< in a window; closing it stops the robot
  bool yes = false;                ///< nobody is asked: the robot starts at once
  bool any_start = false;          ///< wherever it stands
  bool dry_run = false;            ///< all of a drive but motor power
};

/// Whom drives tell and ask. `say` is called from several threads.
struct Console {
  /// One line.
  std::function<void(const std::string&)> say;
  /// A line in place of the one shown before; `hide` takes the last one away.
  std::function<void(const std::string&)> show;
  std::function<void()> hide;
  /// Calls a person who looks elsewhere.
  std::function<void()> ring;
  /// What a person answers with one key of `keys`; Enter is the first of them, 'q' gives up.
  std::function<char(const std::string& question, std::string_view keys)> ask;
};

}  // namespace rift::sessions
