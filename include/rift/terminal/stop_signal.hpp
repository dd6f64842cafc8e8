#pragma once

#include <csignal>

namespace rift::terminal {

/// While it lives, Ctrl-C and SIGTERM ask for a clean stop instead of ending the process; a second
/// one ends it.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  bool IsAsked() const;

 private:
  struct sigaction interrupt_ {};
  struct sigaction terminate_ {};
};

}  // namespace rift::terminal
