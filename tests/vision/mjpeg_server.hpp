#pragma once

#include <sys/socket.h>

#include <atomic>
#include <boost/asio.hpp>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace rift::vision::synthetic {

/// How a server sends, or fails to.
struct ServerOptions {
  double fps = 30.0;
  bool content_length = true;
  std::string content_type = "multipart/x-mixed-replace; boundary=frame";
  int pictures = 1'000'000;  ///< then it closes the connection ...
  bool then_silent = false;  ///< ... or stays there without a word
  bool paced = false;        ///< sends, instead of fps a second, as many as Release allows
};

/// An http camera for one client on a free port of this machine. Every JPEG carries the time at
/// which it was sent in a comment segment.
class MjpegServer {
 public:
  using Camera = std::function<std::vector<std::uint8_t>()>;

  MjpegServer(std::vector<std::uint8_t> jpeg, ServerOptions options)
      : MjpegServer([jpeg = std::move(jpeg)] { return jpeg; }, std::move(options)) {}
  /// `camera` is asked for each picture, by a thread of the server; an empty one is the end.
  MjpegServer(Camera camera, ServerOptions options)
      : camera_(std::move(camera)), options_(std::move(options)), thread_([this] { Serve(); }) {}
  ~MjpegServer() {
    stop_ = true;
    boost::system::error_code ignored;
    boost::asio::ip::tcp::socket waker(context_);  // accept() waits for somebody
    waker.connect(acceptor_.local_endpoint(), ignored);
    waker.close(ignored);  // it will never ask for anything
    {
      const std::lock_guard lock(mutex_);
      if (client_) ::shutdown(client_->native_handle(), SHUT_RDWR);
    }
    thread_.join();
  }
  MjpegServer(const MjpegServer&) = delete;
  MjpegServer& operator=(const MjpegServer&) = delete;

  std::string Url() const {
    return "http://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port()) + "/video";
  }

  /// Allows a paced server to send so many more.
  void Release(int pictures) { released_ += pictures; }

  /// When each picture was sent so far.
  std::vector<double> SentTimes_s() {
    const std::lock_guard lock(mutex_);
    return sent_s_;
  }

  static double Now_s() {
    using std::chrono::duration;
    return duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }
  /// When a picture of this server was sent.
  static double SentAt_s(const std::vector<std::uint8_t>& jpeg) {
    double sent_s = 0.0;
    std::memcpy(&sent_s, jpeg.data() + 6, sizeof sent_s);
    return sent_s;
  }

 private:
  std::vector<std::uint8_t> Stamped() const {
    std::vector<std::uint8_t> jpeg = camera_();
    if (jpeg.empty()) return jpeg;
    std::vector<std::uint8_t> comment{0xFF, 0xFE, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0};
    const double now_s = Now_s();
    std::memcpy(comment.data() + 4, &now_s, sizeof now_s);
    jpeg.insert(jpeg.begin() + 2, comment.begin(), comment.end());
    return jpeg;
  }

  void Send(const std::string& head, const std::vector<std::uint8_t>& body) {
    boost::asio::write(*client_, boost::asio::buffer(head));
    boost::asio::write(*client_, boost::asio::buffer(body));
  }

  /// Waits for the leave to send picture i; false when the server is to stop.
  bool IsReleased(int i) const {
    while (i >= released_ && !stop_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return i < released_;
  }

  void Serve() {
    try {
      boost::asio::ip::tcp::socket client = acceptor_.accept();
      {
        const std::lock_guard lock(mutex_);
        client_.emplace(std::move(client));
      }
      if (stop_) return;
      std::string request;
      boost::asio::read_until(*client_, boost::asio::dynamic_buffer(request), "\r\n\r\n");
      Send("HTTP/1.0 200 OK\r\nContent-Type: " + options_.content_type + "\r\n\r\n", {});
      for (int i = 0; i < options_.pictures && !stop_; ++i) {
        if (options_.paced && !IsReleased(i)) break;
        const std::vector<std::uint8_t> jpeg = Stamped();
        if (jpeg.empty()) break;
        {
          const std::lock_guard lock(mutex_);
          sent_s_.push_back(SentAt_s(jpeg));
        }
        std::string head = "\r\n--frame\r\nContent-Type: image/jpeg\r\n";
        if (options_.content_length) {
          head += "Content-Length: " + std::to_string(jpeg.size()) + "\r\n";
        }
        Send(head + "\r\n", jpeg);
        if (options_.paced) continue;
        std::this_thread::sleep_for(std::chrono::duration<double>(1.0 / options_.fps));
      }
      while (options_.then_silent && !stop_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
      const std::lock_guard lock(mutex_);
      client_.reset();
    } catch (
        const boost::system::system_error&) {  // the client went away: what else is there to do
    }
  }

  boost::asio::io_context context_;
  boost::asio::ip::tcp::acceptor acceptor_{context_, {boost::asio::ip::address_v4::loopback(), 0}};
  Camera camera_;
  ServerOptions options_;
  std::mutex mutex_;
  std::optional<boost::asio::ip::tcp::socket> client_;  ///< comes and goes under the mutex
  std::vector<double> sent_s_;
  std::atomic<bool> stop_ = false;
  std::atomic<int> released_ = 0;
  std::thread thread_;
};

}  // namespace rift::vision::synthetic
