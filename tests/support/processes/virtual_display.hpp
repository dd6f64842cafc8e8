#pragma once

#include <sys/types.h>

#include <string>

namespace rift::test {

/// An X server without a screen for the length of a scope.
class VirtualDisplay {
 public:
  VirtualDisplay();
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  /// False where Xvfb is not installed.
  bool Runs() const { return !number_.empty(); }
  std::string Name() const { return ":" + number_; }

 private:
  pid_t pid_ = -1;
  std::string number_;
};

}  // namespace rift::test
