#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace rift::view {

using Points = std::vector<cv::Point2d>;

/// Blue, green, red.
namespace colour {
inline const cv::Scalar kPaper{250, 250, 250};
inline const cv::Scalar kInk{40, 36, 32};
inline const cv::Scalar kFaint{140, 134, 128};
inline const cv::Scalar kGreen{60, 160, 40};
inline const cv::Scalar kRed{40, 40, 215};
inline const cv::Scalar kYellow{0, 215, 255};
inline const cv::Scalar kBlack{0, 0, 0};
}  // namespace colour

/// Draws on one picture with sub-pixel positions; strokes and letters in px at 720 px height.
class Pen {
 public:
  Pen(cv::Mat& picture, double ui) : picture_(picture), ui_(ui) {}

  void Line(const Points& points, const cv::Scalar& colour, double thick) const;
  /// The convex hull of the points.
  void Hull(const Points& points, const cv::Scalar& fill) const;
  void HullOutline(const Points& points, const cv::Scalar& colour, double thick) const;
  void Area(const Points& polygon, const cv::Scalar& fill) const;
  void Dot(const cv::Point2d& centre, double radius_px, const cv::Scalar& fill) const;
  void Ring(const cv::Point2d& centre, double radius_px, const cv::Scalar& colour,
            double thick) const;
  void Arrow(const cv::Point2d& from, const cv::Point2d& to, const cv::Scalar& colour,
             double thick) const;
  /// Lower left corner of the first letter; shortened to fit `room_px` when that is above zero.
  /// Letters that the stroke font lacks become '?'.
  void Text(const cv::Point2d& at, const std::string& text, double letter_px,
            const cv::Scalar& colour, double room_px = 0.0) const;
  /// The same on a light edge, readable on any ground.
  void HaloText(const cv::Point2d& at, const std::string& text, double letter_px,
                const cv::Scalar& colour) const;

 private:
  int Stroke(double thick) const { return std::max(1, static_cast<int>(std::lround(thick * ui_))); }

  cv::Mat& picture_;
  double ui_;
};

}  // namespace rift::view
