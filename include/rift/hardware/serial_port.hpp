#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "rift/hardware/wire.hpp"

namespace rift::hardware {

/// The line broke while it was open: unplugged, radio gone, other end closed.
class LineGone : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Bytes to and from a robot; nothing here ever waits longer than it says.
class ByteLine {
 public:
  virtual ~ByteLine() = default;

  /// True when all bytes were taken within the line's write timeout; else some may be on their way.
  /// Throws LineGone.
  virtual bool Write(Bytes bytes) = 0;
  /// What has arrived, without waiting. Throws LineGone.
  virtual std::vector<std::uint8_t> Read() = 0;
  /// Bytes taken that have not left yet, as far as the system tells. Throws LineGone.
  virtual size_t Unsent() = 0;
};

/// Time, so that tests can make it. Seconds on std::chrono::steady_clock, as vision stamps frames.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual double Now_s() = 0;
  virtual void Wait(double dt_s) = 0;
};

class SteadyClock : public Clock {
 public:
  double Now_s() override;
  void Wait(double dt_s) override;
};

/// A tty or pty, raw, 8N1, without flow control, for this process alone. The only user of termios.
class SerialPort : public ByteLine {
 public:
  /// Throws std::runtime_error when there is no such port, it may not be opened (and which group
  /// may), another program has it, or it is no serial port; std::invalid_argument for the terminal
  /// that this process was started from, and for a baud rate that the device refuses.
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
