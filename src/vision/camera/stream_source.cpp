#include <curl/curl.h>
#include <fmt/format.h>

#include <optional>

#include "jpeg_size.hpp"
#include "multipart.hpp"
#include "sources.hpp"

namespace rift::vision {
namespace {

constexpr long kConnect_ms = 900;  // a camera that is off is named within a second
constexpr int kWait_ms = 100;
constexpr long kReceiveBuffer = 512 * 1024;

struct EasyCleanup {
  void operator()(CURL* easy) const { curl_easy_cleanup(easy); }
};
struct MultiCleanup {
  void operator()(CURLM* multi) const { curl_multi_cleanup(multi); }
};

/// An MJPEG stream over http with its JPEGs as they were sent. OpenCV's readers decode each and
/// pile up 1.75 s of latency behind a slow reader.
class StreamSource : public CameraSource {
 public:
  explicit StreamSource(std::string url)
      : url_(std::move(url)), multi_(curl_multi_init()), easy_(curl_easy_init()) {
    CURL* easy = easy_.get();
    curl_easy_setopt(easy, CURLOPT_URL, url_.c_str());
    curl_easy_setopt(easy, CURLOPT_FOLLOWLOCATION, 1L);
    curl_easy_setopt(easy, CURLOPT_FAILONERROR, 1L);
    curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(easy, CURLOPT_CONNECTTIMEOUT_MS, kConnect_ms);
    curl_easy_setopt(easy, CURLOPT_BUFFERSIZE, kReceiveBuffer);
    curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, &StreamSource::Receive);
    curl_easy_setopt(easy, CURLOPT_WRITEDATA, this);
    curl_multi_add_handle(multi_.get(), easy);
  }
  ~StreamSource() override { curl_multi_remove_handle(multi_.get(), easy_.get()); }
  StreamSource(const StreamSource&) = delete;
  StreamSource& operator=(const StreamSource&) = delete;

  bool Read(Frame& frame) override {
    if (TakePart(frame)) return true;
    int running = 0;
    curl_multi_perform(multi_.get(), &running);
    if (TakePart(frame)) return true;
    if (running == 0) Fail();
    curl_multi_poll(multi_.get(), nullptr, 0, kWait_ms, nullptr);
    return false;
  }

 private:
  static std::size_t Receive(char* bytes, std::size_t size, std::size_t count, void* self) {
    static_cast<StreamSource*>(self)->received_.append(bytes, size * count);
    return size * count;
  }

  [[noreturn]] void Fail() {
    int left = 0;
    const CURLMsg* message = curl_multi_info_read(multi_.get(), &left);
    const CURLcode code = message != nullptr ? message->data.result : CURLE_OK;
    throw CameraError(
        CameraState::kUnplugged,
        fmt::format("{}: {}", url_,
                    code == CURLE_OK ? "the server ended the stream" : curl_easy_strerror(code)));
  }

  MultipartReader& Parts() {
    if (parts_) return *parts_;
    const char* type = nullptr;
    curl_easy_getinfo(easy_.get(), CURLINFO_CONTENT_TYPE, &type);
    return parts_.emplace(type == nullptr ? "" : type);
  }

  bool TakePart(Frame& frame) {
    if (received_.empty() && !parts_) return false;
    try {
      Parts().Feed(received_);
      received_.clear();
      auto part = parts_->Take();
      return part && Fill(frame, std::move(*part));
    } catch (const CameraError&) {
      throw;
    } catch (const std::exception& error) {
      throw CameraError(CameraState::kWrongFormat, fmt::format("{}: {}", url_, error.what()));
    }
  }

  bool Fill(Frame& frame, std::vector<std::uint8_t> part) const {
    const auto size = SizeOfJpeg(part);
    if (!size) {
      throw CameraError(CameraState::kWrongFormat,
                        fmt::format("{}: the stream's parts are no JPEGs", url_));
    }
    frame.arrived_s = frame.captured_s = SteadyNow_s();
    frame.format = PixelFormat::kJpeg;
    frame.width_px = size->width_px;
    frame.height_px = size->height_px;
    frame.bytes = std::move(part);
    return true;
  }

  std::string url_;
  std::string received_;
  std::optional<MultipartReader> parts_;
  std::unique_ptr<CURLM, MultiCleanup> multi_;
  std::unique_ptr<CURL, EasyCleanup> easy_;
};

}  // namespace

std::unique_ptr<CameraSource> OpenStream(const std::string& url, const CaptureOptions&) {
  return std::make_unique<StreamSource>(url);
}

}  // namespace rift::vision
