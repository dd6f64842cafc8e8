#include "pen.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace rift::view {
namespace {

constexpr int kShift = 4;  // sixteenths of a pixel
constexpr double kFarthest_px = 30000.0;

cv::Point Fixed(const cv::Point2d& p) {
  const auto fixed = [](double v) {
    return static_cast<int>(
        std::lround(std::clamp(v, -kFarthest_px, kFarthest_px) * (1 << kShift)));
  };
  return {fixed(p.x), fixed(p.y)};
}

std::vector<cv::Point> Fixed(const Points& points) {
  std::vector<cv::Point> fixed;
  for (const cv::Point2d& p : points) fixed.push_back(Fixed(p));
  return fixed;
}

std::vector<cv::Point> HullOf(const Points& points) {
  std::vector<cv::Point> hull;
  cv::convexHull(Fixed(points), hull);
  return hull;
}

cv::Point Rounded(const cv::Point2d& p) { return {cvRound(p.x), cvRound(p.y)}; }

// OpenCV's stroke fonts: the doubled face for larger letters, since a thicker stroke fills them.
struct Font {
  explicit Font(double letter_px)
      : face(letter_px > 13.0 ? cv::FONT_HERSHEY_DUPLEX : cv::FONT_HERSHEY_SIMPLEX),
        scale(letter_px / 22.0) {}  // a capital is 22 px high at scale 1

  double Width_px(const std::string& line) const {
    int baseline = 0;
    return cv::getTextSize(line, face, scale, 1, &baseline).width;
  }

  int face;
  double scale;
};

std::string Plain(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0) == 0x80) continue;  // the rest of a UTF-8 letter
    plain += byte >= 0x20 && byte < 0x7F ? c : '?';
  }
  return plain;
}

}  // namespace

void Pen::Line(const Points& points, const cv::Scalar& colour, double thick) const {
  cv::polylines(picture_, std::vector<std::vector<cv::Point>>{Fixed(points)}, false, colour,
                Stroke(thick), cv::LINE_AA, kShift);
}

void Pen::Hull(const Points& points, const cv::Scalar& fill) const {
  cv::fillConvexPoly(picture_, HullOf(points), fill, cv::LINE_AA, kShift);
}

void Pen::HullOutline(const Points& points, const cv::Scalar& colour, double thick) const {
  cv::polylines(picture_, std::vector<std::vector<cv::Point>>{HullOf(points)}, true, colour,
                Stroke(thick), cv::LINE_AA, kShift);
}

void Pen::Area(const Points& polygon, const cv::Scalar& fill) const {
  cv::fillPoly(picture_, std::vector<std::vector<cv::Point>>{Fixed(polygon)}, fill, cv::LINE_AA,
               kShift);
}

void Pen::Dot(const cv::Point2d& centre, double radius_px, const cv::Scalar& fill) const {
  cv::circle(picture_, Fixed(centre), static_cast<int>(radius_px * ui_ * (1 << kShift)), fill,
             cv::FILLED, cv::LINE_AA, kShift);
}

void Pen::Ring(const cv::Point2d& centre, double radius_px, const cv::Scalar& colour,
               double thick) const {
  cv::circle(picture_, Fixed(centre), static_cast<int>(radius_px * ui_ * (1 << kShift)), colour,
             Stroke(thick), cv::LINE_AA, kShift);
}

void Pen::Arrow(const cv::Point2d& from, const cv::Point2d& to, const cv::Scalar& colour,
                double thick) const {
  cv::arrowedLine(picture_, Fixed(from), Fixed(to), colour, Stroke(thick), cv::LINE_AA, kShift,
                  0.3);
}

void Pen::Text(const cv::Point2d& at, const std::string& text, double letter_px,
               const cv::Scalar& colour, double room_px) const {
  const Font font(letter_px * ui_);
  std::string line = Plain(text);
  if (room_px > 0.0 && font.Width_px(line) > room_px) {
    while (!line.empty() && font.Width_px(line + "...") > room_px) line.pop_back();
    line += "...";
  }
  cv::putText(picture_, line, Rounded(at), font.face, font.scale, colour, 1, cv::LINE_AA);
}

void Pen::HaloText(const cv::Point2d& at, const std::string& text, double letter_px,
                   const cv::Scalar& colour) const {
  const Font font(letter_px * ui_);
  cv::putText(picture_, Plain(text), Rounded(at), font.face, font.scale, colour::kPaper, Stroke(4),
              cv::LINE_AA);
  Text(at, text, letter_px, colour);
}

}  // namespace rift::view
