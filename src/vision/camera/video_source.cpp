#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <opencv2/videoio.hpp>

#include "sources.hpp"

namespace rift::vision {
namespace {

constexpr double kUnknownRate_hz = 30.0;

/// What FFmpeg decodes: a file, or a network stream that is no MJPEG over http.
class VideoSource : public CameraSource {
 public:
  VideoSource(const std::string& name, bool is_recording)
      : name_(name), is_recording_(is_recording), opened_s_(SteadyNow_s()) {
    if (is_recording && !std::filesystem::exists(name)) {
      throw std::invalid_argument(fmt::format("{}: there is no such file", name));
    }
    if (!capture_.open(name, cv::CAP_FFMPEG)) {
      const std::string why = fmt::format("{}: FFmpeg cannot open it", name);
      if (is_recording) throw std::invalid_argument(why + ": is it a video?");
      throw CameraError(CameraState::kUnplugged, why);
    }
    const double rate_hz = capture_.get(cv::CAP_PROP_FPS);
    period_s_ = 1.0 / (rate_hz > 0.0 && std::isfinite(rate_hz) ? rate_hz : kUnknownRate_hz);
  }

  bool IsRecording() const override { return is_recording_; }

  bool Read(Frame& frame) override {
    cv::Mat picture;
    if (!capture_.read(picture) || picture.empty()) {
      throw CameraError(is_recording_ ? CameraState::kEnded : CameraState::kUnplugged,
                        fmt::format("{}: the last picture was read", name_));
    }
    frame.arrived_s = SteadyNow_s();
    frame.captured_s = is_recording_ ? opened_s_ + FileTime_s() : frame.arrived_s;
    frame.width_px = picture.cols;
    frame.height_px = picture.rows;
    frame.format = picture.channels() == 1 ? PixelFormat::kGrey : PixelFormat::kBgr;
    frame.bytes.assign(picture.datastart, picture.dataend);
    return true;
  }

 private:
  // Phones record at varying rates, so the file's own time counts where it moves on.
  double FileTime_s() {
    const double file_s = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000.0;
    const bool moves_on = read_++ == 0 || file_s > last_s_;
    last_s_ = moves_on ? file_s : last_s_ + period_s_;
    return last_s_;
  }

  std::string name_;
  bool is_recording_;
  double opened_s_;
  double period_s_ = 0.0;
  double last_s_ = 0.0;
  int read_ = 0;
  cv::VideoCapture capture_;
};

}  // namespace

std::unique_ptr<CameraSource> OpenVideo(const std::string& name, bool is_recording) {
  return std::make_unique<VideoSource>(name, is_recording);
}

}  // namespace rift::vision
