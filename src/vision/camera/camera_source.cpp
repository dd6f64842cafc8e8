#include "rift/vision/camera/camera_source.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "rift/vision/camera/jpeg.hpp"
#include "sources.hpp"

namespace rift::vision {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 8> kEndings{".jpg", ".jpeg", ".png", ".bmp",
                                                   ".tif", ".tiff", ".pgm", ".ppm"};

bool IsPicture(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& letter : ending) letter = static_cast<char>(std::tolower(letter));
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

std::vector<std::string> Matches(const std::string& pattern) {
  std::vector<std::string> files;
  glob_t found{};
  if (glob(pattern.c_str(), GLOB_TILDE, nullptr, &found) == 0) {
    files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  globfree(&found);
  return files;
}

std::vector<std::uint8_t> BytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class ImageSource : public CameraSource {
 public:
  ImageSource(std::vector<std::string> files, double fps)
      : files_(std::move(files)), fps_(fps), opened_s_(SteadyNow_s()) {}

  bool IsRecording() const override { return true; }

  bool Read(Frame& frame) override {
    if (next_ == files_.size()) {
      throw CameraError(CameraState::kEnded, fmt::format("all {} pictures were read", next_));
    }
    const std::string& path = files_[next_];
    frame.bytes = BytesOf(path);
    frame.arrived_s = SteadyNow_s();
    frame.captured_s = opened_s_ + static_cast<double>(next_++) / fps_;
    if (const auto size = SizeOfJpeg(frame.bytes)) {
      frame.format = PixelFormat::kJpeg;
      frame.width_px = size->width_px;
      frame.height_px = size->height_px;
      return true;
    }
    const cv::Mat picture = cv::imread(path, cv::IMREAD_GRAYSCALE);
    if (picture.empty()) {
      throw CameraError(CameraState::kWrongFormat, fmt::format("{}: cannot be decoded", path));
    }
    frame.format = PixelFormat::kGrey;
    frame.width_px = picture.cols;
    frame.height_px = picture.rows;
    frame.bytes.assign(picture.datastart, picture.dataend);
    return true;
  }

 private:
  std::vector<std::string> files_;
  double fps_;
  double opened_s_;
  std::size_t next_ = 0;
};

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

bool IsNumber(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
}

// Said by its ending, so that a missing file is refused as what it was meant to be.
bool NamesPicture(std::string_view name) {
  for (const std::string_view ending : {".jpg", ".jpeg", ".png", ".bmp", ".pgm", ".tif"}) {
    if (name.ends_with(ending)) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> ImageFiles(const std::string& pattern) {
  std::vector<std::string> files;
  if (fs::is_directory(pattern)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(pattern)) {
      if (entry.is_regular_file() && IsPicture(entry.path()))
        files.push_back(entry.path().string());
    }
  } else if (fs::exists(pattern)) {
    files = {pattern};
  } else {
    files = Matches(pattern);
  }
  if (files.empty()) {
    throw std::invalid_argument(fmt::format(
        "'{}' matches no picture: give a folder or a quoted pattern such as 'run/*.jpg'", pattern));
  }
  std::sort(files.begin(), files.end());
  return files;
}

SourceKind KindOf(std::string_view name) {
  if (name.starts_with("/dev/") || IsNumber(name)) return SourceKind::kDevice;
  if (name.starts_with("http://") || name.starts_with("https://")) return SourceKind::kStream;
  if (name.find("://") != std::string_view::npos) return SourceKind::kNetwork;
  const bool is_pattern = name.find_first_of("*?[") != std::string_view::npos;
  if (is_pattern || NamesPicture(name) || std::filesystem::is_directory(name)) {
    return SourceKind::kImages;
  }
  return SourceKind::kVideo;
}

double SteadyNow_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::unique_ptr<CameraSource> OpenCamera(const std::string& name, const CaptureOptions& options) {
  switch (KindOf(name)) {
    case SourceKind::kDevice:
      return OpenDevice(IsNumber(name) ? "/dev/video" + name : name, options);
    case SourceKind::kStream:
      return OpenStream(name, options);
    case SourceKind::kNetwork:
      return std::make_unique<VideoSource>(name, false);
    case SourceKind::kImages:
      return std::make_unique<ImageSource>(ImageFiles(name), options.fps);
    case SourceKind::kVideo:
      break;
  }
  return std::make_unique<VideoSource>(name, true);
}

}  // namespace rift::vision
