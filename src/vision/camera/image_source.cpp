#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "exif_time.hpp"
#include "image_times.hpp"
#include "rift/vision/camera/jpeg.hpp"
#include "rift/vision/camera/steady_now.hpp"
#include "sources.hpp"

namespace rift::vision {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> Matches(const std::string& pattern) {
  std::vector<std::string> files;
  glob_t found{};
  if (glob(pattern.c_str(), GLOB_TILDE, nullptr, &found) == 0) {
    files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  globfree(&found);
  return files;
}

/// Throws nothing, as an iterator over a stream does of what cannot be read; none then.
std::string TextOf(std::ifstream& file) {
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

std::vector<std::uint8_t> BytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text = TextOf(file);
  return {text.begin(), text.end()};
}

std::string TextOf(const std::string& path) {
  errno = 0;
  std::ifstream file(path);
  file.peek();  // a folder can be opened
  if (!file.is_open() || file.bad()) {
    throw std::invalid_argument(fmt::format("cannot read {}: {}", path, strerror(errno)));
  }
  return TextOf(file);
}

/// Width and height as a PNG states them (ISO 15948 11.2.2), without decoding; 0 for another
/// format.
double PngPixels(const std::vector<std::uint8_t>& bytes) {
  constexpr std::array<std::uint8_t, 4> kSignature{0x89, 'P', 'N', 'G'};
  if (bytes.size() < 24 || !std::equal(kSignature.begin(), kSignature.end(), bytes.begin())) {
    return 0.0;
  }
  const auto number = [&](std::size_t at) {
    return 16777216.0 * bytes[at] + 65536.0 * bytes[at + 1] + 256.0 * bytes[at + 2] + bytes[at + 3];
  };
  return number(16) * number(20);
}

std::vector<double> TimesOf(const std::vector<std::string>& files, const CaptureOptions& options) {
  if (options.times.empty()) return TimesByNames(files, options.fps);
  if (options.times == kTimesFromExif) return TimesFromExif(files);
  return TimesFromText(TextOf(options.times), options.times, files);
}

class ImageSource : public CameraSource {
 public:
  ImageSource(std::vector<std::string> files, const CaptureOptions& options)
      : files_(std::move(files)), options_(options), opened_s_(SteadyNow_s()) {
    times_s_ = TimesOf(files_, options);
  }

  bool IsRecording() const override { return true; }
  SourceNotes Notes() const override { return {.skipped = skipped_}; }

  bool Read(Frame& frame) override {
    if (next_ == files_.size()) {
      if (skipped_ == next_) {
        throw CameraError(CameraState::kWrongFormat,
                          fmt::format("{}: none of {} pictures can be decoded", files_[0], next_));
      }
      throw CameraError(
          CameraState::kEnded,
          fmt::format("all {} pictures were read, {} of them passed over", next_, skipped_));
    }
    const std::size_t index = next_++;
    frame.captured_s = opened_s_ + times_s_[index];
    if (Fill(files_[index], frame)) return true;
    ++skipped_;
    return false;
  }

 private:
  /// False for a file over the budget or that is no picture.
  bool Fill(const std::string& path, Frame& frame) const {
    std::error_code unreadable;
    if (static_cast<double>(fs::file_size(path, unreadable)) > 1e6 * options_.most_mbyte) {
      return false;
    }
    frame.bytes = BytesOf(path);
    frame.arrived_s = SteadyNow_s();
    if (const auto size = SizeOfJpeg(frame.bytes)) {
      frame.format = PixelFormat::kJpeg;
      frame.width_px = size->width_px;
      frame.height_px = size->height_px;
      return true;
    }
    if (frame.bytes.empty() || PngPixels(frame.bytes) > 1e6 * options_.most_mpixel) return false;
    // Not turned as its EXIF data say: a JPEG is not either, and the lens is that of the sensor.
    const cv::Mat picture =
        cv::imdecode(frame.bytes, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    if (picture.empty()) return false;
    frame.format = PixelFormat::kGrey;
    frame.width_px = picture.cols;
    frame.height_px = picture.rows;
    frame.bytes.assign(picture.datastart, picture.dataend);
    return true;
  }

  std::vector<std::string> files_;
  CaptureOptions options_;
  std::vector<double> times_s_;
  double opened_s_;
  std::size_t next_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace

std::vector<std::string> ImageFiles(const std::string& pattern) {
  std::vector<std::string> files;
  if (fs::is_directory(pattern)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(pattern)) {
      // Hidden files are none of the pictures, as in a pattern: other systems leave some by the
      // pictures' names.
      const bool is_hidden = entry.path().filename().string().starts_with('.');
      if (!is_hidden && entry.is_regular_file() && NamesPicture(entry.path().string())) {
        files.push_back(entry.path().string());
      }
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
  std::sort(files.begin(), files.end(), IsBefore);
  return files;
}

std::optional<std::string> GuessedTimes(const std::string& camera, const CaptureOptions& options) {
  if (KindOf(camera) != SourceKind::kImages || !options.times.empty()) return std::nullopt;
  const std::vector<std::string> files = ImageFiles(camera);
  if (files.size() < 2 || AreCounted(files)) return std::nullopt;
  return fmt::format(
      "no number in the names of {} rises from each picture to the next, so that they are taken to "
      "follow each other in the order of their names at {:g} a second, and none to be missing: "
      "--times tells when they were taken",
      camera, options.fps);
}

std::unique_ptr<CameraSource> OpenImages(const std::string& pattern,
                                         const CaptureOptions& options) {
  return std::make_unique<ImageSource>(ImageFiles(pattern), options);
}

}  // namespace rift::vision
