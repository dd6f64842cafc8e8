#include <curl/curl.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>

#include "rift/vision/camera/jpeg.hpp"
#include "sources.hpp"

namespace rift::vision {
namespace {

constexpr std::size_t kLargestPart = 64U << 20U;
constexpr std::string_view kBlankLine = "\r\n\r\n";

std::string Lower(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::optional<std::size_t> ContentLength(std::string_view headers) {
  constexpr std::string_view kName = "content-length:";
  const std::size_t name = Lower(headers).find(kName);
  if (name == std::string::npos) return {};
  const std::size_t digits = headers.find_first_of("0123456789", name + kName.size());
  std::size_t length = 0;
  if (digits == std::string::npos) return {};
  std::from_chars(headers.data() + digits, headers.data() + headers.size(), length);
  return length;
}

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

MultipartReader::MultipartReader(std::string_view content_type) {
  constexpr std::string_view kBoundary = "boundary=";
  const std::string lower = Lower(content_type);
  const std::size_t at = lower.find(kBoundary);
  if (!lower.starts_with("multipart/") || at == std::string::npos) {
    throw std::invalid_argument(
        fmt::format("the server sends '{}', but rift reads MJPEG (multipart/x-mixed-replace)",
                    content_type.empty() ? "no content type" : content_type));
  }
  std::string_view boundary = content_type.substr(at + kBoundary.size());
  boundary = boundary.substr(0, boundary.find(';'));
  while (!boundary.empty() && (boundary.back() == '"' || boundary.back() == ' ')) {
    boundary.remove_suffix(1);
  }
  if (boundary.starts_with('"')) boundary.remove_prefix(1);
  delimiter_ = boundary.starts_with("--") ? std::string(boundary) : "--" + std::string(boundary);
}

void MultipartReader::CheckSize() const {
  if (waiting_.size() <= kLargestPart) return;
  throw std::runtime_error(
      fmt::format("{} bytes without an end of the picture: the stream's "
                  "boundary '{}' does not come",
                  waiting_.size(), delimiter_));
}

bool MultipartReader::SkipToHeaders() {
  const std::size_t at = waiting_.find(delimiter_);
  if (at == std::string::npos) {
    CheckSize();
    return false;
  }
  waiting_.erase(0, at);
  return true;
}

std::optional<std::vector<std::uint8_t>> MultipartReader::Take() {
  if (!SkipToHeaders()) return {};
  const std::size_t blank = waiting_.find(kBlankLine);
  if (blank == std::string::npos) return {};
  const std::size_t begin = blank + kBlankLine.size();
  std::size_t end = 0;
  if (const auto length = ContentLength(std::string_view(waiting_).substr(0, blank))) {
    end = begin + *length;
    if (end > waiting_.size()) return CheckSize(), std::nullopt;
  } else {
    end = waiting_.find("\r\n" + delimiter_, begin);
    if (end == std::string::npos) return CheckSize(), std::nullopt;
  }
  std::vector<std::uint8_t> part(waiting_.begin() + begin, waiting_.begin() + end);
  waiting_.erase(0, end);
  return part;
}

std::unique_ptr<CameraSource> OpenStream(const std::string& url, const CaptureOptions&) {
  return std::make_unique<StreamSource>(url);
}

}  // namespace rift::vision
