#include "calibration_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "camera_picture.hpp"

namespace rift::view {
namespace {

constexpr int kShift = 4;
constexpr int kUnknownWidth_px = 640, kUnknownHeight_px = 480;  // before the first picture

const cv::Scalar kGreen{40, 220, 40}, kYellow{0, 225, 255}, kBlue{235, 140, 60};
const cv::Scalar kWhite{255, 255, 255}, kBlack{0, 0, 0}, kPanel{32, 28, 26};

/// Draws pixels of the camera into a picture that may be smaller.
class PixelPen {
 public:
  PixelPen(cv::Mat& picture, double scale) : picture_(picture), scale_(scale) {}

  cv::Point At(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d shown = ((pixel.array() + 0.5) * scale_ - 0.5).matrix();
    return {cvRound(shown.x() * (1 << kShift)), cvRound(shown.y() * (1 << kShift))};
  }
  void Dot(const Eigen::Vector2d& pixel, int radius_px, const cv::Scalar& colour) const {
    cv::circle(picture_, At(pixel), radius_px << kShift, colour, cv::FILLED, cv::LINE_AA, kShift);
  }
  template <class Pixels>
  void Line(const Pixels& pixels, const cv::Scalar& colour, int thick, bool closed) const {
    std::vector<cv::Point> points;
    for (const Eigen::Vector2d& pixel : pixels) points.push_back(At(pixel));
    cv::polylines(picture_, std::vector<std::vector<cv::Point>>{points}, closed, colour, thick,
                  cv::LINE_AA, kShift);
  }

 private:
  cv::Mat& picture_;
  double scale_;
};

void DrawFound(const PixelPen& pen, const vision::BoardView& view, const vision::Board& board) {
  for (int row = 0; row < board.rows; ++row) {
    const auto first = view.corners.begin() + static_cast<std::ptrdiff_t>(row) * board.columns;
    pen.Line(std::vector<Eigen::Vector2d>(first, first + board.columns), kGreen, 1, false);
  }
  for (const Eigen::Vector2d& corner : view.corners) pen.Dot(corner, 3, kGreen);
}

constexpr int kBars_px = 190;  // wide

/// What is covered, and from where on it is enough.
void DrawBars(cv::Mat& picture, const vision::LiveScene& scene) {
  constexpr int kRow_px = 20, kName_px = 52, kBar_px = 120, kPad_px = 8;
  const std::array<std::pair<const char*, double>, 4> bars{{{"x", scene.coverage.x},
                                                            {"y", scene.coverage.y},
                                                            {"size", scene.coverage.size},
                                                            {"tilt", scene.coverage.skew}}};
  const int height = kRow_px * static_cast<int>(bars.size()) + kPad_px;
  const int left = std::max(0, picture.cols - kBars_px);
  cv::Mat panel = picture(cv::Rect(left, 0, picture.cols - left, std::min(height, picture.rows)));
  cv::addWeighted(panel, 0.3, cv::Mat(panel.size(), panel.type(), kPanel), 0.7, 0.0, panel);
  int y = kPad_px / 2;
  for (const auto& [name, share] : bars) {
    cv::putText(picture, name, {left + 8, y + 15}, cv::FONT_HERSHEY_SIMPLEX, 0.5, kWhite, 1,
                cv::LINE_AA);
    const int from = left + kName_px, length = cvRound(kBar_px * std::clamp(share, 0.0, 1.0));
    const bool is_enough = share >= scene.good_coverage;
    cv::rectangle(picture, cv::Rect(from, y + 5, kBar_px, 11), kBlack, cv::FILLED);
    if (length > 0) {
      cv::rectangle(picture, cv::Rect(from, y + 5, length, 11), is_enough ? kGreen : kYellow,
                    cv::FILLED);
    }
    const int mark = from + cvRound(kBar_px * scene.good_coverage);
    cv::line(picture, {mark, y + 3}, {mark, y + 17}, kWhite, 1);
    y += kRow_px;
  }
}

std::vector<std::string> Words(const vision::LiveScene& scene) {
  std::vector<std::string> lines;
  const auto taken = static_cast<int>(scene.taken->size());
  lines.push_back(fmt::format("views: {} of at least {}", taken, scene.good_views));
  if (!scene.next.text.empty()) {
    lines.push_back("next: " + scene.next.text);
  } else {
    lines.push_back(taken < scene.good_views
                        ? "everything is covered: hold the board anywhere unlike before"
                        : "everything is covered");
  }
  if (!scene.advice.empty()) lines.push_back(scene.advice);
  if (!scene.status.reason.empty()) lines.push_back(scene.status.reason);
  return lines;
}

}  // namespace

cv::Mat DrawCalibrating(const vision::LiveScene& scene) {
  const int width_px = scene.frame == nullptr ? kUnknownWidth_px : scene.frame->width_px;
  const int height_px = scene.frame == nullptr ? kUnknownHeight_px : scene.frame->height_px;
  cv::Mat picture = ShownPicture(scene.frame, width_px, height_px);
  const PixelPen pen(picture, 1.0 * picture.cols / width_px);
  for (const vision::BoardView& view : *scene.taken) {
    for (const Eigen::Vector2d& corner : view.corners) pen.Dot(corner, 1, kBlue);
  }
  if (!scene.next.text.empty() && scene.frame != nullptr) {
    const auto wanted = OutlineAt(scene.next.place, scene.board, width_px, height_px);
    pen.Line(wanted, kBlack, 5, true);
    pen.Line(wanted, kYellow, 3, true);
  }
  if (scene.searched != nullptr && !scene.searched->corners.empty()) {
    DrawFound(pen, *scene.searched, scene.board);
  }
  DrawLines(picture, Words(scene), true, kBars_px);
  DrawBars(picture, scene);
  DrawLines(picture,
            {fmt::format("space: take this   a: by itself {}   u: undo   q: calibrate",
                         scene.takes_by_itself ? "(on)" : "(off)")},
            false);
  return picture;
}

}  // namespace rift::view
