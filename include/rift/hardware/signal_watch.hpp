#pragma once

#include <array>
#include <csignal>
#include <optional>
#include <string>

namespace rift::hardware {

/// While it lives, SIGINT, SIGTERM and SIGHUP do not end the process but are noted, so that the
/// robot can be stopped first. One at a time.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  /// The name of the first signal that came; none: none.
  std::optional<std::string> Seen() const;

 private:
  static constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_;
};

}  // namespace rift::hardware
