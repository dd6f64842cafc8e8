#pragma once

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace rift::hardware {

/// The other end of a serial port that a test opens.
class PseudoTerminal {
 public:
  PseudoTerminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) {
      throw std::runtime_error("no pseudo terminal to be had");
    }
    path_ = ::ptsname(master_);
  }
  ~PseudoTerminal() { Close(); }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  void Close() {
    if (master_ >= 0) ::close(master_);
    master_ = -1;
  }
  const std::string& path() const { return path_; }

  void Write(const std::vector<std::uint8_t>& bytes) {
    if (!bytes.empty() && ::write(master_, bytes.data(), bytes.size()) < 0) {
      throw std::runtime_error("cannot write to the pseudo terminal");
    }
  }

  /// What comes within `timeout_ms`; empty when nothing does or the port is closed.
  std::vector<std::uint8_t> Read(int timeout_ms) {
    pollfd wanted{master_, POLLIN, 0};
    std::array<std::uint8_t, 4096> chunk;
    if (::poll(&wanted, 1, timeout_ms) <= 0) return {};
    const ssize_t got = ::read(master_, chunk.data(), chunk.size());
    if (got <= 0) return {};
    return {chunk.begin(), chunk.begin() + got};
  }

 private:
  int master_;
  std::string path_;
};

}  // namespace rift::hardware
