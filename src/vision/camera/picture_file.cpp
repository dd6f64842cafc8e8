#include "rift/vision/camera/picture_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "picture_size.hpp"

namespace rift::vision {
namespace {

PictureFile Refused(std::string why) { return {.bytes = {}, .problem = std::move(why)}; }

}  // namespace

PictureFile ReadPictureFile(const std::string& path, double most_bytes, double most_mpixel) {
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) return Refused("it is no file");
  const auto length = std::filesystem::file_size(path, unreadable);
  if (unreadable) return Refused(unreadable.message());
  if (static_cast<double>(length) > most_bytes) {
    return Refused(fmt::format("{} bytes, and at most {:.0f} are read", length, most_bytes));
  }
  PictureFile picture;
  picture.bytes.resize(length);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(picture.bytes.data()), static_cast<std::streamsize>(length));
  picture.bytes.resize(static_cast<std::size_t>(file.gcount()));
  const auto size = StatedSize(picture.bytes);
  if (!size) {
    return Refused("the picture cannot be decoded: it is no JPEG, PNG, BMP, TIFF, PGM or PPM");
  }
  if (size->width_px * size->height_px > 1e6 * most_mpixel) {
    return Refused(
        fmt::format("{:.0f} x {:.0f} pixels, and at most {:g} million are read: make it "
                    "smaller",
                    size->width_px, size->height_px, most_mpixel));
  }
  return picture;
}

cv::Mat DecodePicture(const std::vector<std::uint8_t>& bytes, bool colour) {
  return cv::imdecode(
      bytes, (colour ? cv::IMREAD_COLOR : cv::IMREAD_GRAYSCALE) | cv::IMREAD_IGNORE_ORIENTATION);
}

}  // namespace rift::vision
