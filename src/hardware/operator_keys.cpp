#include "rift/hardware/operator_keys.hpp"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace rift::hardware {

struct OperatorKeys::Saved {
  termios settings;
};

OperatorKeys::OperatorKeys() {
  termios settings{};
  if (::isatty(STDIN_FILENO) == 0 || ::tcgetattr(STDIN_FILENO, &settings) != 0) return;
  saved_ = std::make_unique<Saved>(Saved{settings});
  settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // signals stay: Ctrl-C must work
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &settings);
}

OperatorKeys::~OperatorKeys() {
  if (saved_) ::tcsetattr(STDIN_FILENO, TCSANOW, &saved_->settings);
}

std::optional<char> OperatorKeys::Pressed() {
  if (!saved_) return std::nullopt;
  pollfd wanted{STDIN_FILENO, POLLIN, 0};
  char key = 0;
  if (::poll(&wanted, 1, 0) <= 0 || ::read(STDIN_FILENO, &key, 1) != 1) return std::nullopt;
  return key;
}

}  // namespace rift::hardware
