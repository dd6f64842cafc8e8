#include "page_server.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <optional>
#include <random>
#include <stdexcept>
#include <string_view>
#include <utility>

// After <utility>, which Boost.Asio 1.74 does not include where it needs it.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "rift/files/files.hpp"

namespace rift::sessions {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;

constexpr double kWatching_s = 10.0;
constexpr char kLast = 'l', kOther = 'o';  // which of the files was served

std::string Token() {
  std::random_device random;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", random());
  return token;
}

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A client that says nothing, or takes nothing, may not keep the next one waiting for longer.
constexpr std::chrono::seconds kMostRequest{2}, kMostResponse{10};

/// What `start` begins on the connection, or its time limit; only asynchronous calls have one.
beast::error_code Await(asio::io_context& context, beast::tcp_stream& connection,
                        std::chrono::seconds limit, const auto& start) {
  beast::error_code result;
  connection.expires_after(limit);
  start([&result](beast::error_code failed, size_t) { result = failed; });
  context.restart();
  context.run();
  return result;
}

struct Page {
  std::string text;
  char mark;
};

std::optional<Page> PageOf(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    if (auto text = files::ReadIfThere(file)) {
      return Page{std::move(*text), file == files.back() ? kLast : kOther};
    }
  }
  return std::nullopt;
}

void Answer(asio::io_context& context, tcp::socket socket, const std::string& path,
            const std::vector<std::filesystem::path>& files, int requests) {
  beast::tcp_stream connection(std::move(socket));
  beast::flat_buffer buffer;
  http::request<http::empty_body> request;
  const auto read = [&](auto done) { http::async_read(connection, buffer, request, done); };
  if (Await(context, connection, kMostRequest, read)) return;
  const bool is_asked = request.method() == http::verb::get && request.target() == path;
  const std::optional<Page> page = is_asked ? PageOf(files) : std::nullopt;
  http::response<http::string_body> response{page ? http::status::ok : http::status::not_found,
                                             request.version()};
  response.set(http::field::content_type, "text/html; charset=utf-8");
  response.set(http::field::cache_control, "no-store");
  if (page) response.body() = page->text;
  response.keep_alive(false);
  response.prepare_payload();
  const auto write = [&](auto done) { http::async_write(connection, response, done); };
  if (Await(context, connection, kMostResponse, write)) return;
  beast::error_code ignored;
  connection.socket().shutdown(tcp::socket::shutdown_both, ignored);
  const bool is_told = !page || ::write(requests, &page->mark, 1) == 1 || errno == EAGAIN;
  if (!is_told) ::_exit(0);  // nobody is there any more
}

[[noreturn]] void Serve(tcp::acceptor& acceptor, const std::string& path,
                        const std::vector<std::filesystem::path>& files, int requests) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C is for the sweep, which ends this process as well
  std::signal(SIGPIPE, SIG_IGN);
  asio::io_context context;
  while (true) {
    beast::error_code failed;
    tcp::socket socket = acceptor.accept(context, failed);
    if (failed) continue;
    try {
      Answer(context, std::move(socket), path, files, requests);
    } catch (const std::exception&) {  // a page that cannot be read now is there the next time
    }
  }
}

}  // namespace

PageServer::PageServer(const std::vector<std::filesystem::path>& files) {
  asio::io_context context;
  tcp::acceptor acceptor(context);
  try {
    acceptor = tcp::acceptor(context, tcp::endpoint(asio::ip::address_v4::loopback(), 0));
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(
        fmt::format("--serve: no port of 127.0.0.1 to be had: {}", error.code().message()));
  }
  const std::string path = fmt::format("/{}/", Token());
  url_ = fmt::format("http://127.0.0.1:{}{}", acceptor.local_endpoint().port(), path);
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC | O_NONBLOCK) != 0) {
    throw std::runtime_error(fmt::format("--serve: no pipe: {}", std::strerror(errno)));
  }
  process_ = ::fork();
  if (process_ == 0) {
    ::close(pipe[0]);
    Serve(acceptor, path, files, pipe[1]);
  }
  ::close(pipe[1]);
  requests_ = pipe[0];
  if (process_ < 0) {
    const std::string reason = std::strerror(errno);
    ::close(requests_);
    throw std::runtime_error(fmt::format("--serve: no process: {}", reason));
  }
}

PageServer::~PageServer() {
  ::kill(process_, SIGKILL);
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
  ::close(requests_);
}

void PageServer::NoteRequests() {
  std::array<char, 64> bytes{};
  for (ssize_t n = 0; (n = ::read(requests_, bytes.data(), bytes.size())) > 0;) {
    last_request_s_ = Now_s();
    const std::string_view served(bytes.data(), static_cast<size_t>(n));
    has_served_last_ = has_served_last_ || served.find(kLast) != served.npos;
  }
}

bool PageServer::IsWatched() {
  NoteRequests();
  return Now_s() - last_request_s_ < kWatching_s;
}

bool PageServer::WaitForLast(int timeout_ms) {
  const double end_s = Now_s() + 1e-3 * timeout_ms;
  for (NoteRequests(); !has_served_last_; NoteRequests()) {
    const int left_ms = static_cast<int>(std::ceil(1e3 * (end_s - Now_s())));
    pollfd entry{requests_, POLLIN, 0};
    const bool has_news = left_ms > 0 && ::poll(&entry, 1, left_ms) > 0;  // else late or a signal
    if (!has_news || (entry.revents & POLLIN) == 0) return false;
  }
  return true;
}

}  // namespace rift::sessions
