#include "support/http.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#include <catch2/catch.hpp>
#include <cerrno>

#include "support/until.hpp"

namespace rift::test {

namespace {

bool Connect(int socket, int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return ::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
}

}  // namespace

std::string AskServer(int port, const std::string& request_line) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  const timeval longest{.tv_sec = kGiveUp.count(), .tv_usec = 0};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &longest, sizeof longest);
  std::string answer;
  if (Connect(socket, port)) {
    const std::string request = request_line + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
    REQUIRE(::write(socket, request.data(), request.size()) ==
            static_cast<ssize_t>(request.size()));
    char bytes[4096];
    ssize_t n = 0;
    while ((n = ::read(socket, bytes, sizeof bytes)) > 0) {
      answer.append(bytes, static_cast<size_t>(n));
    }
    INFO("the answer to " << request_line << " so far: " << answer);
    CHECK_FALSE((n < 0 && errno == EAGAIN));  // waited in vain for its end
  }
  ::close(socket);
  return answer;
}

SilentClient::SilentClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  REQUIRE(Connect(socket_, port));
}

SilentClient::~SilentClient() { ::close(socket_); }

SilentServer::SilentServer() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  REQUIRE(::listen(socket_, 8) == 0);
}

SilentServer::~SilentServer() { ::close(socket_); }

int SilentServer::Port() const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  REQUIRE(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
  return ntohs(address.sin_port);
}

bool SilentServer::HasClient() const {
  pollfd wanted{socket_, POLLIN, 0};
  return ::poll(&wanted, 1, 0) == 1;
}

bool SilentClient::IsConnected() const {
  char byte = 0;
  return ::recv(socket_, &byte, 1, MSG_DONTWAIT) < 0 && errno == EAGAIN;
}

}  // namespace rift::test
