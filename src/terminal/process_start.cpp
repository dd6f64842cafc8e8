#include "rift/terminal/process_start.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

namespace rift::terminal {
namespace {

/// Open for reading alone, so writes fail (EBADF). The lower descriptors must be open.
void OpenWhenClosed(int descriptor, const char* stand_in) {
  if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) return;
  if (::open(stand_in, O_RDONLY) == descriptor) return;
  throw std::runtime_error(
      fmt::format("descriptor {} is closed, and {} cannot be opened for it: {}", descriptor,
                  stand_in, strerror(errno)));
}

}  // namespace

void GuardProcessStart() {
  OpenWhenClosed(STDIN_FILENO, "/dev/null");
  // Not /dev/null: an output of that name would be taken for the closed stream (WriteFile()).
  OpenWhenClosed(STDOUT_FILENO, "/dev/zero");
  OpenWhenClosed(STDERR_FILENO, "/dev/zero");
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace rift::terminal
