#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdint>

#include "pseudo_terminal.hpp"
#include "support/until.hpp"

namespace rift::hardware {

/// Whatever stdin is by itself, in this scope it is a terminal on which the test types.
class Keyboard {
 public:
  Keyboard() : before_(::dup(STDIN_FILENO)) {
    const int terminal = ::open(terminal_.path().c_str(), O_RDWR | O_NOCTTY);
    ::dup2(terminal, STDIN_FILENO);
    ::close(terminal);
  }
  ~Keyboard() {
    ::dup2(before_, STDIN_FILENO);
    ::close(before_);
  }
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// For somebody who reads at the same time.
  void Press(char key) { terminal_.Write({static_cast<std::uint8_t>(key)}); }
  /// The terminal goes away.
  void HangUp() { terminal_.Close(); }
  /// Returns when the key can be read: the system hands it over in its own time.
  void Type(char key) {
    Press(key);
    pollfd wanted{STDIN_FILENO, POLLIN, 0};
    REQUIRE(::poll(&wanted, 1, static_cast<int>(1000 * test::kGiveUp.count())) == 1);
  }

 private:
  PseudoTerminal terminal_;
  int before_;
};

}  // namespace rift::hardware
