#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>

#include "jpeg_size.hpp"
#include "rift/vision/camera/image_files.hpp"
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

std::unique_ptr<CameraSource> OpenImages(const std::string& pattern, double fps) {
  return std::make_unique<ImageSource>(ImageFiles(pattern), fps);
}

}  // namespace rift::vision
