#pragma once

#include <csignal>
#include <string>

namespace rift::terminal {

/// While it lives, Ctrl-C and SIGTERM ask for a clean stop instead of ending the process; one that
/// comes a second later or more ends it. Sooner it is the same one, as `timeout` sends two.
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

/// While it lives, Ctrl-C and SIGTERM end the process there and then with `line` on stderr and exit
/// code kStopped: for long work that writes nothing. At most one lives at a time.
class EndSignal {
 public:
  explicit EndSignal(const std::string& line);
  ~EndSignal();
  EndSignal(const EndSignal&) = delete;
  EndSignal& operator=(const EndSignal&) = delete;

 private:
  struct sigaction interrupt_ {};
  struct sigaction terminate_ {};
};

}  // namespace rift::terminal
