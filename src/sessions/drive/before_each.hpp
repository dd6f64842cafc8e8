#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "rift/files/descriptor.hpp"
#include "rift/sessions/drive/setup.hpp"

namespace rift::sessions {

/// The address in a line of JSON, as `rift simulate --twin` prints it. Throws std::invalid_argument
/// for text that is no object of texts.
DriveAddress AddressOf(const std::string& json);

/// A program that prepares a scene before a trial: it resets things and ends, or, as the twin, it
/// prints one line of JSON (`{"port": ..., "camera": ..., "calibration": ...}`, each may be left
/// out) and is left running until this is destroyed; what it prints then is thrown away, so that it
/// never waits for a reader. It is no child of a shell, gets no keys and no Ctrl-C, and ends with
/// this process even when that is killed.
class SceneCommand {
 public:
  /// Waits for its line or its end. Throws std::runtime_error when it cannot be run, ends with
  /// anything but 0 or prints a line of more than 64 KiB. To be called by the main thread, whose
  /// end is what it ends with.
  explicit SceneCommand(const std::vector<std::string>& words);
  /// SIGTERM, and SIGKILL when it has not ended 10 s later.
  ~SceneCommand();
  SceneCommand(const SceneCommand&) = delete;
  SceneCommand& operator=(const SceneCommand&) = delete;

  const std::optional<DriveAddress>& address() const { return address_; }

 private:
  void End();

  std::string name_;
  pid_t pid_ = -1;
  files::Descriptor output_;
  std::jthread rest_;  ///< reads what is printed after the line
  std::optional<DriveAddress> address_;
};

}  // namespace rift::sessions
