#pragma once

#include <atomic>
#include <boost/asio.hpp>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace rift::vision::synthetic {

/// A web server that answers each connection in turn with the bytes it was given and closes it; the
/// last answer is kept open. It answers as many connections as Allow() says: by itself, all.
class ScriptedServer {
 public:
  explicit ScriptedServer(std::vector<std::string> answers)
      : ScriptedServer(answers, answers.size()) {}
  ScriptedServer(std::vector<std::string> answers, std::size_t allowed)
      : answers_(std::move(answers)), allowed_(allowed), thread_([this] { Serve(); }) {}
  ~ScriptedServer() {
    stop_ = true;
    boost::system::error_code ignored;
    boost::asio::ip::tcp::socket waker(context_);
    waker.connect(acceptor_.local_endpoint(), ignored);
    waker.close(ignored);
    thread_.join();
  }
  ScriptedServer(const ScriptedServer&) = delete;
  ScriptedServer& operator=(const ScriptedServer&) = delete;

  /// One more connection may be answered.
  void Allow() { ++allowed_; }

  std::string Url() const {
    return "http://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port()) + "/video";
  }

 private:
  void Serve() {
    for (std::size_t i = 0; i < answers_.size() && !stop_; ++i) {
      boost::system::error_code error;
      boost::asio::ip::tcp::socket client(context_);
      acceptor_.accept(client, error);
      std::string request;
      boost::asio::read_until(client, boost::asio::dynamic_buffer(request), "\r\n\r\n", error);
      while (i >= allowed_ && !stop_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      boost::asio::write(client, boost::asio::buffer(answers_[i]), error);
      while (i + 1 == answers_.size() && !stop_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
      client.close(error);
    }
  }

  boost::asio::io_context context_;
  boost::asio::ip::tcp::acceptor acceptor_{context_, {boost::asio::ip::address_v4::loopback(), 0}};
  std::vector<std::string> answers_;
  std::atomic<bool> stop_ = false;
  std::atomic<std::size_t> allowed_;
  std::thread thread_;
};

}  // namespace rift::vision::synthetic
