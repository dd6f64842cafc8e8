#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <string>

#include "support/until.hpp"
#include "twin/mjpeg_server.hpp"

namespace rift::twin {

inline int PortOf(const std::string& url) { return std::stoi(url.substr(url.rfind(':') + 1)); }

/// A client of the twin's camera, in plain sockets.
class MjpegClient {
 public:
  explicit MjpegClient(int port, int receive_buffer = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) {
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    sockaddr_in there{};
    there.sin_family = AF_INET;
    there.sin_port = htons(static_cast<std::uint16_t>(port));
    there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::connect(socket_, reinterpret_cast<const sockaddr*>(&there), sizeof there) == 0);
  }
  ~MjpegClient() { ::close(socket_); }
  MjpegClient(const MjpegClient&) = delete;
  MjpegClient& operator=(const MjpegClient&) = delete;

  void Ask(const std::string& path) {
    const std::string request = "GET " + path + " HTTP/1.1\r\nHost: here\r\n\r\n";
    REQUIRE(::send(socket_, request.data(), request.size(), MSG_NOSIGNAL) ==
            static_cast<ssize_t>(request.size()));
  }
  /// Everything until `text` was seen or nothing came for kGiveUp.
  std::string Until(const std::string& text) {
    std::string got;
    std::array<char, 65536> chunk;
    while (got.find(text) == std::string::npos) {
      pollfd wanted{socket_, POLLIN, 0};
      if (::poll(&wanted, 1, static_cast<int>(1000 * test::kGiveUp.count())) <= 0) return got;
      const ssize_t n = ::recv(socket_, chunk.data(), chunk.size(), 0);
      if (n <= 0) return got;
      got.append(chunk.data(), static_cast<size_t>(n));
    }
    return got;
  }

 private:
  int socket_;
};

inline void WaitForClients(const MjpegServer& server, int count) {
  test::WaitUntil(std::to_string(count) + " clients", [&] { return server.Clients() == count; });
}

}  // namespace rift::twin
