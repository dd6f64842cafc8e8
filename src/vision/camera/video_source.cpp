#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <opencv2/videoio.hpp>
#include <thread>
#include <vector>

#include "rift/vision/camera/steady_now.hpp"
#include "sources.hpp"

namespace rift::vision {
namespace {

constexpr double kUnknownRate_hz = 30.0;
constexpr int kWait_ms = 100;
constexpr const char* kNotOpened =
    "FFmpeg cannot open it: is the camera on, and are address, user and password right? "
    "(OPENCV_FFMPEG_LOGLEVEL=16 shows what FFmpeg says)";

void Take(const cv::Mat& picture, Frame& frame) {
  frame.width_px = picture.cols;
  frame.height_px = picture.rows;
  frame.format = picture.channels() == 1 ? PixelFormat::kGrey : PixelFormat::kBgr;
  frame.bytes.assign(picture.datastart, picture.dataend);
}

/// FFmpeg's own lines on stderr are left out, unless a person asks for them; read by OpenCV at the
/// first open.
void QuietFfmpeg() { setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0); }

/// A file that FFmpeg decodes.
class VideoSource : public CameraSource {
 public:
  explicit VideoSource(const std::string& name) : name_(name), opened_s_(SteadyNow_s()) {
    if (!std::filesystem::exists(name)) {
      const bool may_be_address = name.find(':') != std::string::npos;
      throw std::invalid_argument(fmt::format(
          "{}: there is no such file{}", name,
          may_be_address ? "; the address of a camera begins with http:// or rtsp://" : ""));
    }
    QuietFfmpeg();
    if (!capture_.open(name, cv::CAP_FFMPEG)) {
      throw std::invalid_argument(fmt::format("{}: FFmpeg cannot open it: is it a video?", name));
    }
    // Not turned as a phone was held: a photograph of the board is not either, and the lens is that
    // of the sensor.
    capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0.0);
    const double rate_hz = capture_.get(cv::CAP_PROP_FPS);
    period_s_ = 1.0 / (rate_hz > 0.0 && std::isfinite(rate_hz) ? rate_hz : kUnknownRate_hz);
  }

  bool IsRecording() const override { return true; }

  bool Read(Frame& frame) override {
    cv::Mat picture;
    if (!capture_.read(picture) || picture.empty()) {
      throw CameraError(CameraState::kEnded, fmt::format("{}: the last picture was read", name_));
    }
    frame.arrived_s = SteadyNow_s();
    frame.captured_s = opened_s_ + FileTime_s();
    Take(picture, frame);
    return true;
  }

 private:
  // From the first picture's: JPEGs one after the other, as of a saved stream, begin at -7.7e12 s
  // by FFmpeg. Phones record at varying rates, so the file's own time counts where it moves on.
  double FileTime_s() {
    const double at_s = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000.0;
    if (read_ == 0) first_s_ = at_s;
    const double file_s = at_s - first_s_;
    const bool moves_on = read_++ == 0 || file_s > last_s_;
    last_s_ = moves_on ? file_s : last_s_ + period_s_;
    return last_s_;
  }

  std::string name_;
  double opened_s_;
  double period_s_ = 0.0;
  double first_s_ = 0.0;  // of the file's own times
  double last_s_ = 0.0;   // since then
  int read_ = 0;
  cv::VideoCapture capture_;
};

/// A network camera through FFmpeg. The capture thread drains it, so that FFmpeg's queue stays
/// empty; FFmpeg itself is told not to hold pictures back.
class NetworkSource : public CameraSource {
 public:
  NetworkSource(std::string url, const CaptureOptions& options)
      : url_(std::move(url)), options_(options), again_(options.reconnect_s) {
    // Read by OpenCV at each open; what a person has set stays. Over UDP single lost packets smear
    // the picture for seconds.
    setenv("OPENCV_FFMPEG_CAPTURE_OPTIONS", "rtsp_transport;tcp|fflags;nobuffer", 0);
    QuietFfmpeg();
    if (!Open()) Break(kNotOpened);
  }

  bool Read(Frame& frame) override {
    if (!capture_.isOpened() && !Reconnect()) return false;
    cv::Mat picture;
    const double asked_s = SteadyNow_s();
    if (!capture_.read(picture) || picture.empty()) {
      // FFmpeg does not tell which: it waits for so long for a stream that stalls.
      const double waited_s = SteadyNow_s() - asked_s;
      capture_.release();
      Break(waited_s < 0.9 * options_.open_timeout_s
                ? "the stream ended"
                : fmt::format("nothing came for {:.0f} s", waited_s));
      return false;
    }
    frame.arrived_s = frame.captured_s = SteadyNow_s();
    again_.Works(frame.arrived_s);
    Take(picture, frame);
    return true;
  }

  SourceNotes Notes() const override {
    return {.reconnects = again_.Count(), .interruption = again_.Interruption()};
  }

 private:
  bool Open() {
    const int wait_ms = static_cast<int>(1e3 * options_.open_timeout_s);
    return capture_.open(
        url_, cv::CAP_FFMPEG,
        {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, wait_ms, cv::CAP_PROP_READ_TIMEOUT_MSEC, wait_ms});
  }
  bool Reconnect() {
    if (!again_.IsDue(SteadyNow_s())) {
      std::this_thread::sleep_for(std::chrono::milliseconds(kWait_ms));
      return false;
    }
    again_.Tries();
    if (Open()) return true;
    Break(kNotOpened);
    return false;
  }
  void Break(const std::string& reason) {
    again_.Broke(fmt::format("{}: {}", WithoutPassword(url_), reason), SteadyNow_s());
  }

  std::string url_;
  CaptureOptions options_;
  Reconnection again_;
  cv::VideoCapture capture_;
};

}  // namespace

std::unique_ptr<CameraSource> OpenVideo(const std::string& path) {
  return std::make_unique<VideoSource>(path);
}

std::unique_ptr<CameraSource> OpenNetwork(const std::string& url, const CaptureOptions& options) {
  return std::make_unique<NetworkSource>(url, options);
}

}  // namespace rift::vision
