#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace rift::twin {

/// The robot's end of a serial line whose other end is a port for one program at a time. The port
/// may be closed and opened again: this side keeps it open.
class PseudoTerminal {
 public:
  /// Throws std::runtime_error when the system gives none.
  PseudoTerminal();
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  const std::string& path() const { return path_; }
  /// What has come, without waiting.
  std::vector<std::uint8_t> Read();
  /// Without waiting; bytes that are not read are lost when the buffer is full, as on a serial
  /// line.
  void Write(std::span<const std::uint8_t> bytes);

 private:
  int master_;
  int port_ = -1;
  std::string path_;
};

}  // namespace rift::twin
