#include "twin/mjpeg_server.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <ctime>
#include <optional>
#include <string>
#include <thread>

#include "mjpeg_client.hpp"
#include "support/sanitizer.hpp"

namespace rift::twin {
namespace {

std::vector<std::uint8_t> Picture(const std::string& name, size_t size = 0) {
  std::string bytes(size, 'x');
  bytes += name;
  return {bytes.begin(), bytes.end()};
}

TEST_CASE("Every client of the stream is given the picture") {
  MjpegServer server(0);
  MjpegClient one(PortOf(server.Url())), other(PortOf(server.Url()));
  one.Ask("/stream.mjpg");
  other.Ask("/stream.mjpg");
  WaitForClients(server, 2);
  server.Publish(Picture("[first]"));
  for (MjpegClient* client : {&one, &other}) {
    const std::string got = client->Until("[first]");
    CHECK(got.starts_with("HTTP/1.1 200 OK\r\n"));
    CHECK(got.find("multipart/x-mixed-replace; boundary=frame") != std::string::npos);
    CHECK(got.find("Content-Length: 7\r\n") != std::string::npos);
  }
}

TEST_CASE("A client that does not read holds up no other and then sees the newest picture") {
  MjpegServer server(0);
  MjpegClient slow(PortOf(server.Url()), 4096), quick(PortOf(server.Url()));
  slow.Ask("/stream.mjpg");
  quick.Ask("/stream.mjpg");
  WaitForClients(server, 2);
  constexpr size_t kMegabyte = 1 << 20;
  constexpr int kPictures = 40;
  for (int i = 1; i <= kPictures; ++i) {
    const std::string name = "[" + std::to_string(i) + "]";
    server.Publish(Picture(name, kMegabyte));
    CHECK(quick.Until(name + "\r\n").ends_with(name + "\r\n"));
  }
  const std::string late = slow.Until("[" + std::to_string(kPictures) + "]\r\n");
  CHECK(late.find("[1]") != std::string::npos);
  CHECK(late.ends_with("[40]\r\n"));
  // The one it was being sent, what the system holds, and the newest.
  CHECK(late.size() < 12 * kMegabyte);
}

TEST_CASE("Clients that go away are forgotten and do not end the server") {
  MjpegServer server(0);
  for (int i = 0; i < 3; ++i) {
    MjpegClient client(PortOf(server.Url()));
    client.Ask("/stream.mjpg");
    WaitForClients(server, 1);
    server.Publish(Picture("half", 8 << 20));  // more than is taken before it goes
  }
  WaitForClients(server, 0);
  MjpegClient client(PortOf(server.Url()));
  client.Ask("/other");
  CHECK(client.Until("/stream.mjpg").starts_with("HTTP/1.1 404"));
}

TEST_CASE("The stream is one answer of parts, each with its type, its length and its picture") {
  MjpegServer server(0);
  CHECK(server.Url() ==
        "http://127.0.0.1:" + std::to_string(PortOf(server.Url())) + "/stream.mjpg");
  MjpegClient client(PortOf(server.Url()));
  client.Ask("/stream.mjpg");
  WaitForClients(server, 1);
  server.Publish(Picture("[first]"));
  CHECK(client.Until("[first]\r\n") ==
        "HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=frame\r\n"
        "Cache-Control: no-store\r\nConnection: close\r\n\r\n"
        "--frame\r\nContent-Type: image/jpeg\r\nContent-Length: 7\r\n\r\n[first]\r\n");
  server.Publish(Picture("[second]", 3));
  CHECK(client.Until("[second]\r\n") ==
        "--frame\r\nContent-Type: image/jpeg\r\nContent-Length: 11\r\n\r\nxxx[second]\r\n");
}

TEST_CASE("Of another path than the stream's the client is told where that is, and gets none") {
  for (const char* other : {"/", "/stream.mjpg2", "/stream.mjp", "/a/stream.mjpg"}) {
    MjpegServer server(0);
    MjpegClient client(PortOf(server.Url())), watcher(PortOf(server.Url()));
    client.Ask(other);
    CHECK(client.Until("mjpg\n") ==
          "HTTP/1.1 404 Not Found\r\nContent-Type: text/plain\r\nConnection: close\r\n\r\n"
          "the stream is /stream.mjpg\n");
    watcher.Ask("/stream.mjpg");
    WaitForClients(server, 1);
    server.Publish(Picture("[one]"));
    CHECK(watcher.Until("[one]\r\n").ends_with("[one]\r\n"));
    CHECK(server.Clients() == 1);
    CHECK(client.Until("[one]").empty());  // its connection was closed
  }
}

TEST_CASE("What a client says while it watches is passed over") {
  MjpegServer server(0);
  MjpegClient client(PortOf(server.Url()));
  client.Ask("/stream.mjpg");
  WaitForClients(server, 1);
  for (const std::string name : {"[1]", "[2]", "[3]"}) {
    client.Ask("/other");
    server.Publish(Picture(name));
    const std::string got = client.Until(name + "\r\n");
    CHECK(got.ends_with(name + "\r\n"));
    CHECK(got.find("404") == std::string::npos);
  }
  CHECK(server.Clients() == 1);
}

/// Leaves this process as many descriptors as it has open, and `more`.
class FewDescriptors {
 public:
  explicit FewDescriptors(rlim_t more) {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const int next = ::dup(0);  // the lowest free one
    ::close(next);
    const rlimit few{static_cast<rlim_t>(next) + more, before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &few);
  }
  ~FewDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  FewDescriptors(const FewDescriptors&) = delete;
  FewDescriptors& operator=(const FewDescriptors&) = delete;

 private:
  rlimit before_{};
};

TEST_CASE("A server out of descriptors waits for one instead of spinning, and then serves") {
  SKIP_UNDER_SANITIZER();
  using Clock = std::chrono::steady_clock;
  MjpegServer server(0);
  std::optional<MjpegClient> client;
  {
    const FewDescriptors one(1);
    client.emplace(PortOf(server.Url()));
    client->Ask("/stream.mjpg");
    const Clock::time_point begun = Clock::now();
    const std::clock_t used_before = std::clock();
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    const double used_s = static_cast<double>(std::clock() - used_before) / CLOCKS_PER_SEC;
    const std::chrono::duration<double> passed = Clock::now() - begun;
    CHECK(used_s < 0.3 * passed.count());
    CHECK(server.Clients() == 0);
  }
  WaitForClients(server, 1);
  server.Publish(Picture("[late]"));
  CHECK(client->Until("[late]\r\n").ends_with("[late]\r\n"));
}

TEST_CASE("A port that is taken is refused in one line") {
  MjpegServer server(0);
  const int port = PortOf(server.Url());
  CHECK_THROWS_WITH(MjpegServer(port),
                    "cannot serve pictures on 127.0.0.1:" + std::to_string(port) +
                        ": Address already in use; set twin.http_port to another, or to 0 for a "
                        "free one");
}

}  // namespace
}  // namespace rift::twin
