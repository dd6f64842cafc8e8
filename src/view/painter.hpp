#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "rift/view/film.hpp"

namespace rift::view {

/// Where things are on a picture: top view above side view at one scale, so that they line up in x,
/// and a column of text on the right.
class Layout {
 public:
  Layout(const StaticScene& fixed, cv::Size size);

  cv::Point2d TopPixel(const Eigen::Vector2d& p_in_world_m) const;
  cv::Point2d SidePixel(double x_m, double z_m) const;
  /// Letters and strokes grow with the picture; 1 at a height of 720 px.
  double Ui() const { return ui_; }
  int Px(double at_720) const { return static_cast<int>(std::lround(at_720 * ui_)); }

  cv::Size size;
  cv::Rect top;
  cv::Rect side;
  cv::Rect panel;
  double px_per_m = 1.0;

 private:
  double ui_;
  Eigen::Vector2d corner_m_;  ///< lower left of the top view
};

/// Turns scenes of one run into pictures: 8 bits each of blue, green, red. Same scene, same pixels.
class Painter {
 public:
  /// Keeps a reference to `fixed`.
  Painter(const StaticScene& fixed, cv::Size size);

  const Layout& layout() const { return layout_; }
  /// `footer`: lines at the foot of the text column.
  cv::Mat Paint(const Scene& scene, const std::vector<std::string>& footer = {}) const;

 private:
  const StaticScene& fixed_;
  Layout layout_;
  cv::Mat backdrop_;
};

}  // namespace rift::view
