#include "rift/vision/camera/picture_reader.hpp"

#include <cstring>
#include <opencv2/imgproc.hpp>

namespace rift::vision {
namespace {

// Not copied, hence not to be written to.
cv::Mat Raw(const Frame& frame, int type) {
  return {cv::Size(frame.width_px, frame.height_px), type,
          const_cast<std::uint8_t*>(frame.bytes.data())};
}

int BytesPerPixel(PixelFormat format) {
  if (format == PixelFormat::kBgr) return 3;
  return format == PixelFormat::kYuyv ? 2 : 1;
}

/// The region of an uncompressed frame, seen as a matrix without copying.
cv::Mat RawView(const Frame& frame, const Region& region, int type) {
  const cv::Mat all(frame.height_px, frame.width_px, type,
                    const_cast<std::uint8_t*>(frame.bytes.data()));
  return all(cv::Rect(region.x_px, region.y_px, region.width_px, region.height_px));
}

GreyPatch ReadRaw(const Frame& frame, const Region& region) {
  GreyPatch patch{region, std::vector<std::uint8_t>(static_cast<std::size_t>(region.width_px) *
                                                    region.height_px)};
  cv::Mat grey(region.height_px, region.width_px, CV_8UC1, patch.pixels.data());
  if (frame.format == PixelFormat::kBgr) {
    cv::cvtColor(RawView(frame, region, CV_8UC3), grey, cv::COLOR_BGR2GRAY);
  } else if (frame.format == PixelFormat::kYuyv) {
    cv::extractChannel(RawView(frame, region, CV_8UC2), grey, 0);
  } else {
    RawView(frame, region, CV_8UC1).copyTo(grey);
  }
  return patch;
}

}  // namespace

cv::Mat BgrOf(const Frame& frame) {
  cv::Mat picture;
  switch (frame.format) {
    case PixelFormat::kJpeg:
      return DecodeJpeg(frame.bytes, true, 8);
    case PixelFormat::kGrey:
      cv::cvtColor(Raw(frame, CV_8UC1), picture, cv::COLOR_GRAY2BGR);
      break;
    case PixelFormat::kBgr:
      return Raw(frame, CV_8UC3).clone();
    case PixelFormat::kYuyv:
      cv::cvtColor(Raw(frame, CV_8UC2), picture, cv::COLOR_YUV2BGR_YUYV);
      break;
  }
  return picture;
}

cv::Mat SmallGreyOf(const Frame& frame) {
  cv::Mat grey;
  switch (frame.format) {
    case PixelFormat::kJpeg:
      return DecodeJpeg(frame.bytes, false, 1);
    case PixelFormat::kGrey:
      return Raw(frame, CV_8UC1);
    case PixelFormat::kBgr:
      cv::cvtColor(Raw(frame, CV_8UC3), grey, cv::COLOR_BGR2GRAY);
      break;
    case PixelFormat::kYuyv:
      cv::extractChannel(Raw(frame, CV_8UC2), grey, 0);
      break;
  }
  return grey;
}

std::optional<GreyPatch> PictureReader::Read(const Frame& frame) {
  return Read(frame, {0, 0, frame.width_px, frame.height_px});
}

std::optional<GreyPatch> PictureReader::Read(const Frame& frame, const Region& region) {
  const Region inside = Clipped(region, frame.width_px, frame.height_px);
  if (inside.empty()) return std::nullopt;
  if (frame.format == PixelFormat::kJpeg) {
    return jpeg_.Read(frame.bytes, frame.width_px, frame.height_px, inside);
  }
  const std::size_t needed =
      static_cast<std::size_t>(frame.width_px) * frame.height_px * BytesPerPixel(frame.format);
  if (frame.bytes.size() < needed) return std::nullopt;
  return ReadRaw(frame, inside);
}

}  // namespace rift::vision
