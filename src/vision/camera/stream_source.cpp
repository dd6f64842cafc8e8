#include <curl/curl.h>
#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>

#include "rift/vision/camera/jpeg.hpp"
#include "rift/vision/camera/steady_now.hpp"
#include "sources.hpp"

namespace rift::vision {
namespace {

constexpr long kConnect_ms = 900;  // a camera that is off is named within a second
constexpr int kWait_ms = 100;
constexpr long kReceiveBuffer = 512 * 1024;
constexpr double kSilent_s = 5.0;  // then the connection is taken to be dead, and made again

struct EasyCleanup {
  void operator()(CURL* easy) const { curl_easy_cleanup(easy); }
};
struct MultiCleanup {
  void operator()(CURLM* multi) const { curl_multi_cleanup(multi); }
};

/// What a person can do about an answer of a web server.
std::string StatusText(long status) {
  switch (status) {
    case 401:
      return "it wants a user and password: http://USER:PASSWORD@host/path (http 401)";
    case 403:
      return "it refuses this user (http 403)";
    case 404:
      return "it has nothing at this path: look up the stream's address in its manual (http 404)";
    case 503:
      return "it is busy, often with too many viewers (http 503)";
    default:
      break;
  }
  if (status >= 500) return fmt::format("it has an error of its own (http {})", status);
  return fmt::format("it refuses the request (http {})", status);
}

/// Asking again is of no use.
bool IsRefusal(long status) {
  return status >= 400 && status < 500 && status != 408 && status != 429;
}

/// One connection to a server.
class Connection {
 public:
  explicit Connection(const std::string& url) : multi_(curl_multi_init()), easy_(curl_easy_init()) {
    CURL* easy = easy_.get();
    curl_easy_setopt(easy, CURLOPT_URL, url.c_str());
    curl_easy_setopt(easy, CURLOPT_FOLLOWLOCATION, 1L);
    curl_easy_setopt(easy, CURLOPT_FAILONERROR, 1L);
    curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(easy, CURLOPT_HTTPAUTH, CURLAUTH_ANY);
    curl_easy_setopt(easy, CURLOPT_CONNECTTIMEOUT_MS, kConnect_ms);
    curl_easy_setopt(easy, CURLOPT_BUFFERSIZE, kReceiveBuffer);
    curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, &Connection::Receive);
    curl_easy_setopt(easy, CURLOPT_WRITEDATA, this);
    curl_multi_add_handle(multi_.get(), easy);
  }
  ~Connection() { curl_multi_remove_handle(multi_.get(), easy_.get()); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Takes what has come; false when the connection is over.
  bool Advance() {
    int running = 0;
    curl_multi_perform(multi_.get(), &running);
    return running > 0;
  }
  void Wait() { curl_multi_poll(multi_.get(), nullptr, 0, kWait_ms, nullptr); }

  std::string& Received() { return received_; }
  std::string ContentType() const {
    const char* type = nullptr;
    curl_easy_getinfo(easy_.get(), CURLINFO_CONTENT_TYPE, &type);
    return type == nullptr ? "" : type;
  }
  long Status() const {
    long status = 0;
    curl_easy_getinfo(easy_.get(), CURLINFO_RESPONSE_CODE, &status);
    return status;
  }
  /// Why it is over.
  std::string Reason() {
    if (Status() >= 400) return StatusText(Status());
    int left = 0;
    const CURLMsg* message = curl_multi_info_read(multi_.get(), &left);
    const CURLcode code = message != nullptr ? message->data.result : CURLE_OK;
    if (code == CURLE_OK) return "the server ended the stream";
    // A first line that is not http's is taken for that of http 0.9.
    if (code == CURLE_UNSUPPORTED_PROTOCOL) return "what answers there does not speak http";
    return curl_easy_strerror(code);
  }

 private:
  static std::size_t Receive(char* bytes, std::size_t size, std::size_t count, void* self) {
    static_cast<Connection*>(self)->received_.append(bytes, size * count);
    return size * count;
  }

  std::string received_;
  std::unique_ptr<CURLM, MultiCleanup> multi_;
  std::unique_ptr<CURL, EasyCleanup> easy_;
};

/// Throws std::invalid_argument for what no server can be asked at.
void RequireAddress(const std::string& url) {
  CURLU* parts = curl_url();
  const CURLUcode code = curl_url_set(parts, CURLUPART_URL, url.c_str(), 0);
  curl_url_cleanup(parts);
  if (code == CURLUE_OK) return;
  throw std::invalid_argument(
      fmt::format("{}: it is no address of a camera, http://HOST:PORT/PATH with a port up to 65535",
                  WithoutPassword(url)));
}

/// An MJPEG stream over http with its JPEGs as they were sent. OpenCV's readers decode each and
/// pile up 1.75 s of latency behind a slow reader.
class StreamSource : public CameraSource {
 public:
  StreamSource(std::string url, const CaptureOptions& options)
      : url_(std::move(url)), options_(options), again_(options.reconnect_s) {
    RequireAddress(url_);
    Connect();
  }

  bool Read(Frame& frame) override {
    if (!connection_ && !Reconnect()) return false;
    if (TakePart(frame)) return true;
    const bool goes_on = connection_->Advance();
    if (TakePart(frame)) return true;
    const double now_s = SteadyNow_s();
    if (!goes_on) {
      Break(connection_->Reason());
    } else if (now_s - heard_s_ > kSilent_s) {
      const std::uint64_t bad = parts_ ? skipped_ + parts_->Skipped() : skipped_;
      Break(fmt::format("nothing came for {:.0f} s{}", kSilent_s,
                        bad == 0 ? ""
                                 : fmt::format(", after {} parts that are no picture or larger "
                                               "than track.capture.most_mbyte, {:g}",
                                               bad, options_.most_mbyte)));
    } else {
      connection_->Wait();
    }
    return false;
  }

  SourceNotes Notes() const override {
    return {.skipped = skipped_ + before_ + (parts_ ? parts_->Skipped() : 0),
            .reconnects = again_.Count(),
            .interruption = again_.Interruption()};
  }

 private:
  void Connect() {
    connection_ = std::make_unique<Connection>(url_);
    heard_s_ = SteadyNow_s();
  }

  bool Reconnect() {
    if (!again_.IsDue(SteadyNow_s())) {
      std::this_thread::sleep_for(std::chrono::milliseconds(kWait_ms));
      return false;
    }
    again_.Tries();
    Connect();
    return true;
  }

  void Break(const std::string& reason) {
    const std::string text = fmt::format("{}: {}", WithoutPassword(url_), reason);
    if (IsRefusal(connection_->Status())) throw CameraError(CameraState::kRefused, text);
    connection_.reset();
    if (parts_) before_ += parts_->Skipped();
    parts_.reset();
    again_.Broke(text, SteadyNow_s());
  }

  MultipartReader& Parts() {
    if (parts_) return *parts_;
    return parts_.emplace(connection_->ContentType(),
                          static_cast<std::size_t>(options_.most_mbyte * 1e6));
  }

  bool TakePart(Frame& frame) {
    std::string& received = connection_->Received();
    if (received.empty() && !parts_) return false;
    try {
      if (!received.empty()) heard_s_ = SteadyNow_s();
      Parts().Feed(received);
      received.clear();
      while (auto part = parts_->Take()) {
        if (Fill(frame, std::move(*part))) return true;
        if (++skipped_ > kMostSkipped && !has_any_) {
          throw std::runtime_error("the stream's parts are no JPEGs");
        }
      }
      return false;
    } catch (const std::exception& error) {
      throw CameraError(CameraState::kWrongFormat,
                        fmt::format("{}: {}", WithoutPassword(url_), error.what()));
    }
  }

  /// False for a part that is no JPEG.
  bool Fill(Frame& frame, std::vector<std::uint8_t> part) {
    const auto size = SizeOfJpeg(part);
    if (!size) return false;
    frame.arrived_s = frame.captured_s = SteadyNow_s();
    frame.format = PixelFormat::kJpeg;
    frame.width_px = size->width_px;
    frame.height_px = size->height_px;
    frame.bytes = std::move(part);
    has_any_ = true;
    again_.Works(frame.arrived_s);
    return true;
  }

  static constexpr std::uint64_t kMostSkipped = 10;  // before the first picture

  std::string url_;
  CaptureOptions options_;
  Reconnection again_;
  std::unique_ptr<Connection> connection_;
  std::optional<MultipartReader> parts_;
  double heard_s_ = 0.0;
  std::uint64_t skipped_ = 0, before_ = 0;
  bool has_any_ = false;
};

}  // namespace

std::unique_ptr<CameraSource> OpenStream(const std::string& url, const CaptureOptions& options) {
  return std::make_unique<StreamSource>(url, options);
}

}  // namespace rift::vision
