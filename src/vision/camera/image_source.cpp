#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "exif_time.hpp"
#include "image_times.hpp"
#include "rift/files/files.hpp"
#include "rift/vision/camera/jpeg.hpp"
#include "rift/vision/camera/picture_file.hpp"
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

std::vector<double> TimesOf(const std::vector<std::string>& files, const CaptureOptions& options) {
  if (options.times.empty()) return TimesByNames(files, options.fps);
  if (options.times == kTimesFromExif) return TimesFromExif(files);
  return TimesFromText(files::ReadFile(options.times), options.times, files);
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
    PictureFile file = ReadPictureFile(path, 1e6 * options_.most_mbyte, options_.most_mpixel);
    if (!file.problem.empty()) return false;
    frame.bytes = std::move(file.bytes);
    frame.arrived_s = SteadyNow_s();
    if (const auto size = SizeOfJpeg(frame.bytes)) {
      frame.format = PixelFormat::kJpeg;
      frame.width_px = size->width_px;
      frame.height_px = size->height_px;
      return true;
    }
    const cv::Mat picture = DecodePicture(frame.bytes, false);
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
