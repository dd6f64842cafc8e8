// The server of the page of a sweep that runs.
#include "sessions/sweep/page_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include "support/http.hpp"
#include "support/processes/process.hpp"
#include "support/until.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

struct Address {
  explicit Address(const std::string& url) {
    std::smatch found;
    REQUIRE(
        std::regex_match(url, found, std::regex(R"(http://127\.0\.0\.1:(\d+)(/[0-9a-f]{32}/))")));
    port = std::stoi(found[1]);
    path = found[2];
  }
  int port = 0;
  std::string path;
};

TEST_CASE("A page server is not watched and has served nothing before it was asked") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "live", "it runs");
  PageServer server({folder / "live", folder / "report"});
  CHECK_FALSE(server.IsWatched());
  CHECK_FALSE(server.WaitForLast(0));
  CHECK_FALSE(server.WaitForLast(30));
}

TEST_CASE("The first of its files that is there is served whole, and the last one is known") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "live", "it runs");
  test::WriteText(folder / "report", "it is over");
  PageServer server({folder / "live", folder / "report"});
  const Address at(server.Url());
  const std::string live = test::AskServer(at.port, "GET " + at.path);
  CHECK_THAT(live, Catch::StartsWith("HTTP/1.1 200 OK\r\n") && Catch::EndsWith("\r\n\r\nit runs"));
  CHECK_THAT(live, Contains("Content-Type: text/html; charset=utf-8") &&
                       Contains("Cache-Control: no-store"));
  test::WaitUntil("the server tells of it", [&] { return server.IsWatched(); });
  CHECK_FALSE(server.WaitForLast(0));
  fs::remove(folder / "live");
  CHECK_THAT(test::AskServer(at.port, "GET " + at.path), Catch::EndsWith("\r\n\r\nit is over"));
  CHECK(server.WaitForLast(60'000));
  CHECK(server.WaitForLast(0));  // it stays known
}

TEST_CASE("Other paths, other methods and files that are gone are not found, and nobody watches") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "live", "it runs");
  PageServer server({folder / "live"});
  const Address at(server.Url());
  for (const std::string& line : {std::string("GET /"), "GET " + at.path + "x", "POST " + at.path,
                                  "GET /" + std::string(32, '0') + "/", std::string("GET /live")}) {
    INFO(line);
    const std::string answer = test::AskServer(at.port, line);
    CHECK_THAT(answer, Contains("404 Not Found") && !Contains("it runs"));
  }
  fs::remove(folder / "live");
  CHECK_THAT(test::AskServer(at.port, "GET " + at.path), Contains("404 Not Found"));
  CHECK_FALSE(server.IsWatched());
}

/// A connection to a port of this machine that says nothing.
class SilentClient {
 public:
  explicit SilentClient(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  }
  ~SilentClient() { ::close(socket_); }
  int Descriptor() const { return socket_; }

 private:
  int socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
};

TEST_CASE("A client that says nothing does not keep the page from others") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "live", "it runs");
  const PageServer server({folder / "live"});
  const Address at(server.Url());
  const SilentClient silent(at.port);
  CHECK_THAT(test::AskServer(at.port, "GET " + at.path), Catch::EndsWith("\r\n\r\nit runs"));
}

/// A client that asks for a page and looks for its answer later.
class AskingClient {
 public:
  explicit AskingClient(const Address& at) : connection_(at.port) {
    const std::string request = "GET " + at.path + " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
    REQUIRE(::write(connection_.Descriptor(), request.data(), request.size()) ==
            static_cast<ssize_t>(request.size()));
  }
  bool HasAnswerWithin(int ms) const {
    pollfd entry{connection_.Descriptor(), POLLIN, 0};
    return ::poll(&entry, 1, ms) == 1;
  }

 private:
  SilentClient connection_;
};

TEST_CASE("Sixteen clients are answered at a time, and the next one when one of them is gone") {
  using Clock = std::chrono::steady_clock;
  const test::TemporaryFolder folder;
  test::WriteText(folder / "live", "it runs");
  const PageServer server({folder / "live"});
  const Address at(server.Url());
  CHECK_THAT(test::AskServer(at.port, "GET " + at.path), Contains("200 OK"));
  // A machine that is too busy for it in the two seconds that a silent client is given tries again.
  test::WaitUntil("sixteen silent clients were there at once", [&] {
    const Clock::time_point begun = Clock::now();
    std::vector<std::unique_ptr<SilentClient>> silent;
    for (int i = 0; i < 16; ++i) silent.push_back(std::make_unique<SilentClient>(at.port));
    const AskingClient next(at);
    const bool is_answered = next.HasAnswerWithin(50);
    if (Clock::now() - begun > std::chrono::seconds(1)) return false;
    CHECK_FALSE(is_answered);
    silent.pop_back();
    CHECK(next.HasAnswerWithin(60'000));
    return true;
  });
}

TEST_CASE("Two page servers have addresses of their own, and one that is gone answers nobody") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "live", "it runs");
  auto first = std::make_unique<PageServer>(std::vector<fs::path>{folder / "live"});
  const PageServer second({folder / "live"});
  const Address a(first->Url()), b(second.Url());
  CHECK(a.port != b.port);
  CHECK(a.path != b.path);
  CHECK_THAT(test::AskServer(b.port, "GET " + a.path), Contains("404 Not Found"));
  first.reset();
  CHECK(test::AskServer(a.port, "GET " + a.path).empty());
  CHECK_THAT(test::AskServer(b.port, "GET " + b.path), Contains("200 OK"));
}

}  // namespace
}  // namespace rift::sessions
