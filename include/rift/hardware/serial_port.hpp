#pragma once

#include <string>

#include "rift/hardware/byte_line.hpp"

namespace rift::hardware {

/// A tty or pty, raw, 8N1, without flow control, for this process alone. The only user of termios.
class SerialPort : public ByteLine {
 public:
  /// Throws std::runtime_error when there is no such port, it may not be opened (and which group
  /// may), another program has it, or it is no serial port; std::invalid_argument for a baud rate
  /// that the device refuses.
  SerialPort(const std::string& path, int baud, double write_timeout_s);
  ~SerialPort() override;
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  bool Write(Bytes bytes) override;
  std::vector<std::uint8_t> Read() override;
  size_t Unsent() override;

  const std::string& path() const { return path_; }

 private:
  void Claim();
  void Configure(int baud);
  [[noreturn]] void ThrowGone(int reason) const;

  std::string path_;
  double write_timeout_s_;
  int descriptor_ = -1;
};

}  // namespace rift::hardware
