#include "camera_picture.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "rift/vision/camera/picture_reader.hpp"

namespace rift::view {
namespace {

constexpr int kWidest_px = 1280;

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontScale = 0.5;

const cv::Scalar kWhite{255, 255, 255}, kPanel{32, 28, 26};

int WidthOf_px(const std::string& text) {
  int below_px = 0;
  return cv::getTextSize(text, kFont, kFontScale, 1, &below_px).width;
}

/// Adds the rows of a line that is wrapped between words.
void AddWrapped(const std::string& line, int room_px, std::vector<std::string>& rows) {
  std::istringstream words(line);
  std::string row;
  for (std::string word; std::getline(words, word, ' ');) {
    const std::string longer = row.empty() ? word : row + ' ' + word;
    if (!row.empty() && WidthOf_px(longer) > room_px) {
      rows.push_back(row);
      row = word;
    } else {
      row = longer;
    }
  }
  rows.push_back(row);
}

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

void DrawLines(cv::Mat& picture, const std::vector<std::string>& lines, bool at_top, int right_px) {
  constexpr int kLine_px = 20, kPad_px = 8;
  const int room = std::max(picture.cols - right_px, 0) - 2 * kPad_px;
  std::vector<std::string> rows;
  for (const std::string& line : lines) AddWrapped(line, room, rows);
  const int height = std::min(picture.rows, static_cast<int>(rows.size()) * kLine_px + kPad_px);
  int width = 0;
  for (const std::string& row : rows) width = std::max(width, WidthOf_px(row) + 2 * kPad_px);
  width = std::min(width, picture.cols);
  const int y = at_top ? 0 : picture.rows - height;
  cv::Mat strip = picture(cv::Rect(0, y, width, height));
  cv::addWeighted(strip, 0.3, cv::Mat(strip.size(), strip.type(), kPanel), 0.7, 0.0, strip);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    cv::putText(picture, rows[i], {kPad_px, y + static_cast<int>(i + 1) * kLine_px}, kFont,
                kFontScale, kWhite, 1, cv::LINE_AA);
  }
}

}  // namespace rift::view
