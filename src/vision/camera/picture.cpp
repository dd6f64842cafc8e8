#include "rift/vision/camera/picture.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace rift::vision {
namespace {

// Not copied, hence not to be written to.
cv::Mat Raw(const Frame& frame, int type) {
  return {cv::Size(frame.width_px, frame.height_px), type,
          const_cast<std::uint8_t*>(frame.bytes.data())};
}

cv::Mat Decoded(const Frame& frame, int how) {
  if (frame.bytes.empty()) return {};
  return cv::imdecode(cv::Mat(1, static_cast<int>(frame.bytes.size()), CV_8U,
                              const_cast<std::uint8_t*>(frame.bytes.data())),
                      how);
}

}  // namespace

cv::Mat BgrOf(const Frame& frame) {
  cv::Mat picture;
  switch (frame.format) {
    case PixelFormat::kJpeg:
      return Decoded(frame, cv::IMREAD_COLOR);
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

cv::Mat GlanceAt(const Frame& frame) {
  cv::Mat grey;
  switch (frame.format) {
    case PixelFormat::kJpeg:
      return Decoded(frame, cv::IMREAD_REDUCED_GRAYSCALE_8);
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

}  // namespace rift::vision
