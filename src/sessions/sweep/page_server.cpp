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
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <string_view>
#include <utility>

// After <utility>, which Boost.Asio 1.74 does not include where it needs it.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
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

/// A client that says nothing, or takes nothing, is left alone after that.
constexpr std::chrono::seconds kMostRequest{2}, kMostResponse{10};

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

struct Served {
  std::string path;
  std::vector<std::filesystem::path> files;  ///< the first that is there
  int requests = -1;                         ///< where each answer is told
};

/// One request and its answer. It lives as long as something is awaited.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, const Served& served, std::function<void()> on_end)
      : stream_(std::move(socket)), served_(served), on_end_(std::move(on_end)) {}
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { on_end_(); }

  void Start() {
    stream_.expires_after(kMostRequest);
    http::async_read(stream_, buffer_, request_,
                     [self = shared_from_this()](beast::error_code failed, size_t) {
                       if (!failed) self->Answer();
                     });
  }

 private:
  void Answer() {
    const bool is_asked = request_.method() == http::verb::get && request_.target() == served_.path;
    std::optional<Page> page;
    try {
      if (is_asked) page = PageOf(served_.files);
    } catch (const std::exception&) {
      return;  // a page that cannot be read now is there the next time
    }
    response_.result(page ? http::status::ok : http::status::not_found);
    response_.version(request_.version());
    response_.set(http::field::content_type, "text/html; charset=utf-8");
    response_.set(http::field::cache_control, "no-store");
    if (page) {
      mark_ = page->mark;
      response_.body() = std::move(page->text);
    }
    response_.keep_alive(false);
    response_.prepare_payload();
    stream_.expires_after(kMostResponse);
    http::async_write(stream_, response_,
                      [self = shared_from_this()](beast::error_code failed, size_t) {
                        if (!failed) self->End();
                      });
  }

  void End() {
    beast::error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_both, ignored);
    const bool is_told = !mark_ || ::write(served_.requests, &*mark_, 1) == 1 || errno == EAGAIN;
    if (!is_told) ::_exit(0);  // nobody is there any more
  }

  beast::tcp_stream stream_;
  const Served& served_;
  std::function<void()> on_end_;
  beast::flat_buffer buffer_;
  http::request<http::empty_body> request_;
  http::response<http::string_body> response_;
  std::optional<char> mark_;  ///< of the page that is sent
};

/// Answers up to kMostAtOnce clients at a time; the others wait to be accepted.
class Acceptor {
 public:
  Acceptor(tcp::acceptor& acceptor, const Served& served)
      : acceptor_(acceptor), served_(served), pause_(acceptor.get_executor()) {}

  void Accept() {
    acceptor_.async_accept([this](beast::error_code failed, tcp::socket socket) {
      if (failed) return Pause();  // no descriptor is left
      ++open_;
      if (open_ < kMostAtOnce) Accept();
      const auto on_end = [this] {
        if (open_-- == kMostAtOnce) Accept();
      };
      std::make_shared<Connection>(std::move(socket), served_, on_end)->Start();
    });
  }

 private:
  static constexpr int kMostAtOnce = 16;  // each may hold a page of some MB

  void Pause() {
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](beast::error_code) { Accept(); });
  }

  tcp::acceptor& acceptor_;
  const Served& served_;
  asio::steady_timer pause_;
  int open_ = 0;
};

[[noreturn]] void Serve(asio::io_context& context, tcp::acceptor& acceptor, const Served& served) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C is for the sweep, which ends this process as well
  std::signal(SIGPIPE, SIG_IGN);
  context.notify_fork(asio::io_context::fork_child);
  Acceptor accepting(acceptor, served);
  accepting.Accept();
  while (true) {
    try {
      context.run();
    } catch (const std::exception&) {  // of one connection: the others go on
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
  requests_ = files::Descriptor(pipe[0]);
  const files::Descriptor theirs(pipe[1]);
  process_ = ::fork();
  if (process_ == 0) {
    requests_ = {};
    Serve(context, acceptor, {.path = path, .files = files, .requests = theirs.Number()});
  }
  if (process_ < 0) {
    throw std::runtime_error(fmt::format("--serve: no process: {}", std::strerror(errno)));
  }
}

PageServer::~PageServer() {
  ::kill(process_, SIGKILL);
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void PageServer::NoteRequests() {
  std::array<char, 64> bytes{};
  for (ssize_t n = 0; (n = ::read(requests_.Number(), bytes.data(), bytes.size())) > 0;) {
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
    pollfd entry{requests_.Number(), POLLIN, 0};
    const bool has_news = left_ms > 0 && ::poll(&entry, 1, left_ms) > 0;  // else late or a signal
    if (!has_news || (entry.revents & POLLIN) == 0) return false;
  }
  return true;
}

}  // namespace rift::sessions
