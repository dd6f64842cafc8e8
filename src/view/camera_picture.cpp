#include "camera_picture.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "rift/vision/camera/picture_reader.hpp"

namespace rift::view {
namespace {

constexpr int kWidest_px = 1280;

const cv::Scalar kWhite{255, 255, 255}, kPanel{32, 28, 26};

}  // namespace

cv::Mat ShownPicture(const vision::Frame* frame, int width_px, int height_px) {
  cv::Mat picture = frame == nullptr ? cv::Mat() : vision::BgrOf(*frame);
  if (picture.empty()) {
    picture = cv::Mat(std::max(height_px, 240), std::max(width_px, 320), CV_8UC3, kPanel);
  }
  const double scale = std::min(1.0, 1.0 * kWidest_px / picture.cols);
  if (scale == 1.0) return picture;
  cv::Mat small;
  cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
  return small;
}

void DrawLines(cv::Mat& picture, const std::vector<std::string>& lines, bool at_top) {
  constexpr int kLine_px = 20, kPad_px = 8;
  const int height = std::min(picture.rows, static_cast<int>(lines.size()) * kLine_px + kPad_px);
  int width = 0;
  for (const std::string& line : lines) {
    int base = 0;
    width =
        std::max(width, cv::getTextSize(line, cv::FONT_HERSHEY_SIMPLEX, 0.5, 1, &base).width + 16);
  }
  width = std::min(width, picture.cols);
  const int y = at_top ? 0 : picture.rows - height;
  cv::Mat strip = picture(cv::Rect(0, y, width, height));
  cv::addWeighted(strip, 0.3, cv::Mat(strip.size(), strip.type(), kPanel), 0.7, 0.0, strip);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    cv::putText(picture, lines[i], {8, y + static_cast<int>(i + 1) * kLine_px},
                cv::FONT_HERSHEY_SIMPLEX, 0.5, kWhite, 1, cv::LINE_AA);
  }
}

}  // namespace rift::view
