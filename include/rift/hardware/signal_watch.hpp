#pragma once

#include <array>
#include <csignal>
#include <optional>
#include <string>

namespace rift::hardware {

/// While it lives, the signals of `kSignals` neither end nor suspend the process but are noted, so
/// that the robot can be stopped first. Others that end a process (SIGKILL, SIGXCPU, SIGUSR1 and so
/// on) do so, and the robot's own watchdog stops it. One at a time.
class SignalWatch {
 public:
  /// Besides those that ask for an end: Ctrl-\ (QUIT) and Ctrl-Z (TSTP), and what suspends a
  /// process in the background that reads from its terminal (TTIN), or sets it or writes to it
  /// (TTOU).
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGTTIN, SIGTTOU};

  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  /// The name of the first signal that came; none: none.
  std::optional<std::string> Seen() const;

 private:
  std::array<struct sigaction, kSignals.size()> before_;
};

}  // namespace rift::hardware
