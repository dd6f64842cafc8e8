#pragma once

#include <string>

namespace rift::test {

/// The whole answer of the server at `port` of this machine to a request by hand, its first line
/// "GET /x" or the like; empty when there is no server. Fails the test when the answer does not
/// end.
std::string AskServer(int port, const std::string& request_line);

/// A client of the server at `port` of this machine that asks nothing.
class SilentClient {
 public:
  explicit SilentClient(int port);
  SilentClient(const SilentClient&) = delete;
  SilentClient& operator=(const SilentClient&) = delete;
  ~SilentClient();

  /// False once the server has ended the connection.
  bool IsConnected() const;

 private:
  int socket_;
};

/// A server of this machine that takes connections and says nothing.
class SilentServer {
 public:
  SilentServer();
  SilentServer(const SilentServer&) = delete;
  SilentServer& operator=(const SilentServer&) = delete;
  ~SilentServer();

  int Port() const;
  /// Somebody has connected.
  bool HasClient() const;

 private:
  int socket_;
};

}  // namespace rift::test
