#include "mjpeg_server.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

namespace rift::twin {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using Picture = std::shared_ptr<const std::vector<std::uint8_t>>;

constexpr const char* kPath = "/stream.mjpg";
constexpr std::chrono::milliseconds kRetry{100};
constexpr size_t kLongestRequest = 16 * 1024;
constexpr const char* kStreamHead =
    "HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=frame\r\n"
    "Cache-Control: no-store\r\nConnection: close\r\n\r\n";

/// One client. All its handlers run on the server's thread.
class Client : public std::enable_shared_from_this<Client> {
 public:
  Client(tcp::socket socket, std::atomic<int>& watching)
      : socket_(std::move(socket)), watching_(watching) {}
  ~Client() {
    if (is_watching_) --watching_;
  }

  void Start() {
    error_code ignored;
    socket_.set_option(tcp::no_delay(true), ignored);
    asio::async_read_until(socket_, asio::dynamic_buffer(request_, kLongestRequest), "\r\n\r\n",
                           [self = shared_from_this()](error_code error, size_t) {
                             if (!error) self->Answer();
                           });
  }

  void Show(const Picture& picture) {
    if (!is_watching_) return;
    next_ = picture;
    SendNext();
  }

 private:
  void Answer() {
    const bool is_stream = request_.starts_with(std::string("GET ") + kPath + " ");
    head_ = is_stream ? kStreamHead
                      : fmt::format(
                            "HTTP/1.1 404 Not Found\r\nContent-Type: text/plain\r\n"
                            "Connection: close\r\n\r\nthe stream is {}\n",
                            kPath);
    asio::async_write(socket_, asio::buffer(head_),
                      [self = shared_from_this(), is_stream](error_code error, size_t) {
                        if (!error && is_stream) self->Watch();
                      });
  }

  void Watch() {
    is_watching_ = true;
    ++watching_;
    WaitForEnd();
    SendNext();
  }

  /// A client says nothing more, so what arrives is its end.
  void WaitForEnd() {
    socket_.async_read_some(asio::buffer(ignored_),
                            [self = shared_from_this()](error_code error, size_t) {
                              if (!error) return self->WaitForEnd();
                              error_code none;
                              self->socket_.close(none);
                            });
  }

  void SendNext() {
    if (is_sending_ || !next_ || !is_watching_) return;
    sending_ = std::exchange(next_, nullptr);
    is_sending_ = true;
    head_ = fmt::format("--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {}\r\n\r\n",
                        sending_->size());
    const std::array<asio::const_buffer, 3> parts{asio::buffer(head_), asio::buffer(*sending_),
                                                  asio::buffer("\r\n", 2)};
    asio::async_write(socket_, parts, [self = shared_from_this()](error_code error, size_t) {
      self->is_sending_ = false;
      if (!error) self->SendNext();
    });
  }

  tcp::socket socket_;
  std::atomic<int>& watching_;
  std::string request_;
  std::string head_;
  std::array<char, 256> ignored_{};
  Picture next_;
  Picture sending_;
  bool is_watching_ = false;
  bool is_sending_ = false;
};

tcp::acceptor Listen(asio::io_context& context, int port) {
  const tcp::endpoint here(asio::ip::address_v4::loopback(), static_cast<unsigned short>(port));
  try {
    return tcp::acceptor(context, here);
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(fmt::format(
        "cannot serve pictures on 127.0.0.1:{}: {}; set twin.http_port to another, or to "
        "0 for a free one",
        port, error.code().message()));
  }
}

}  // namespace

class MjpegServer::Core {
 public:
  explicit Core(int port) : acceptor_(Listen(context_, port)) {
    Accept();
    thread_ = std::thread([this] { context_.run(); });
  }
  ~Core() {
    context_.stop();
    thread_.join();
  }

  int Port() const { return acceptor_.local_endpoint().port(); }
  int Clients() const { return watching_; }
  void Publish(Picture picture) {
    asio::post(context_, [this, picture = std::move(picture)] {
      std::erase_if(clients_, [](const auto& client) { return client.expired(); });
      for (const auto& client : clients_) {
        if (const auto here = client.lock()) here->Show(picture);
      }
    });
  }

 private:
  void Accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (!error) {
        const auto client = std::make_shared<Client>(std::move(socket), watching_);
        clients_.push_back(client);
        client->Start();
        Accept();
        return;
      }
      // Out of descriptors: the client still waits, so that the next try would fail at once too.
      retry_.expires_after(kRetry);
      retry_.async_wait([this](error_code) { Accept(); });
    });
  }

  std::atomic<int> watching_ = 0;  // first: the destructor of a client lowers it
  std::vector<std::weak_ptr<Client>> clients_;
  asio::io_context context_;
  tcp::acceptor acceptor_;
  asio::steady_timer retry_{context_};
  std::thread thread_;
};

MjpegServer::MjpegServer(int port) : core_(std::make_unique<Core>(port)) {}
MjpegServer::~MjpegServer() = default;
std::string MjpegServer::Url() const {
  return fmt::format("http://127.0.0.1:{}{}", core_->Port(), kPath);
}
void MjpegServer::Publish(std::vector<std::uint8_t> jpeg) {
  core_->Publish(std::make_shared<const std::vector<std::uint8_t>>(std::move(jpeg)));
}
int MjpegServer::Clients() const { return core_->Clients(); }

}  // namespace rift::twin
