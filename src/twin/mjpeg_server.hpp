#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace rift::twin {

/// An http camera on 127.0.0.1: GET /stream.mjpg is answered with multipart/x-mixed-replace. Any
/// number of clients, each given the newest picture when it has taken the last one, so that a slow
/// one misses pictures and delays no other. Has a thread of its own.
class MjpegServer {
 public:
  /// port 0: a free one. Throws std::runtime_error when the port is taken.
  explicit MjpegServer(int port);
  ~MjpegServer();
  MjpegServer(const MjpegServer&) = delete;
  MjpegServer& operator=(const MjpegServer&) = delete;

  std::string Url() const;
  /// To all clients, now.
  void Publish(std::vector<std::uint8_t> jpeg);
  int Clients() const;

 private:
  class Core;
  std::unique_ptr<Core> core_;
};

}  // namespace rift::twin
