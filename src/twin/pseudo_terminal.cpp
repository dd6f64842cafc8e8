#include "pseudo_terminal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace rift::twin {
namespace {

[[noreturn]] void Fail() {
  throw std::runtime_error(fmt::format("no pseudo terminal to be had: {}", strerror(errno)));
}

/// Bytes as they are, without echo, from before anyone opens it.
void MakeRaw(int port) {
  termios line{};
  if (::tcgetattr(port, &line) != 0) Fail();
  ::cfmakeraw(&line);
  if (::tcsetattr(port, TCSANOW, &line) != 0) Fail();
}

}  // namespace

PseudoTerminal::PseudoTerminal()
    : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) Fail();
  std::array<char, 128> name{};
  if (::ptsname_r(master_, name.data(), name.size()) != 0) Fail();
  path_ = name.data();
  port_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (port_ < 0) Fail();
  MakeRaw(port_);
}

PseudoTerminal::~PseudoTerminal() {
  ::close(port_);
  ::close(master_);
}

std::vector<std::uint8_t> PseudoTerminal::Read() {
  // The port's claim for one program alone (TIOCEXCL) would outlive that program, since this side
  // keeps the port open. Its lock does not, and still keeps a second `rift drive` out.
  ::ioctl(port_, TIOCNXCL);
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 4096> chunk;
  const ssize_t got = ::read(master_, chunk.data(), chunk.size());
  if (got > 0) bytes.assign(chunk.begin(), chunk.begin() + got);
  return bytes;
}

void PseudoTerminal::Write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(master_, bytes.data(), bytes.size());
    if (written <= 0) return;
    bytes = bytes.subspan(static_cast<size_t>(written));
  }
}

}  // namespace rift::twin
