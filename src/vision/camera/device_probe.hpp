#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rift::vision {

/// A second opening of a V4L2 device beside OpenCV's, which knows neither why it cannot open a
/// device nor that one is gone: OpenCV 4.6 hangs in read() when DQBUF answers EIO.
class DeviceProbe {
 public:
  /// Throws CameraError: unplugged (no such device), busy, wrong format (no camera, no right to
  /// open it).
  explicit DeviceProbe(const std::string& path);
  ~DeviceProbe();
  DeviceProbe(const DeviceProbe&) = delete;
  DeviceProbe& operator=(const DeviceProbe&) = delete;

  /// Whether the device still answers. Any thread may ask.
  bool IsPresent() const;
  /// The pixel formats (FOURCC) that it offers.
  std::vector<std::uint32_t> Formats() const;

 private:
  void CheckCaptures() const;
  void CheckIdle() const;

  std::string path_;
  int descriptor_ = -1;
};

/// "MJPG"
std::string FourccText(std::uint32_t fourcc);

}  // namespace rift::vision
