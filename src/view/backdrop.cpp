#include "backdrop.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "pen.hpp"

namespace rift::view {
namespace {

const cv::Vec3d kLow{236, 240, 240};
const cv::Vec3d kHigh{172, 206, 226};
const cv::Vec3d kNoGround{120, 116, 112};
const cv::Scalar kEarth{188, 208, 220};
const cv::Scalar kPatchInk{170, 120, 60};

struct HeightRange {
  double low_m = HUGE_VAL;
  double high_m = -HUGE_VAL;
};

HeightRange RangeOf(const Ground& ground) {
  HeightRange range;
  for (const float height_m : ground.height_m) {
    if (!std::isfinite(height_m)) continue;
    range.low_m = std::min(range.low_m, double{height_m});
    range.high_m = std::max(range.high_m, double{height_m});
  }
  return range;
}

// Light from the upper left, as maps are shaded; 1 on level ground.
double Shade(const Ground& ground, int column, int row) {
  const auto height_m = [&](int c, int r) {
    const float h =
        ground.At(std::clamp(c, 0, ground.columns - 1), std::clamp(r, 0, ground.rows - 1));
    return std::isfinite(h) ? double{h} : double{ground.At(column, row)};
  };
  const double span_m = 2.0 * ground.cell_m;
  const Eigen::Vector3d normal =
      Eigen::Vector3d((height_m(column - 1, row) - height_m(column + 1, row)) / span_m,
                      (height_m(column, row - 1) - height_m(column, row + 1)) / span_m, 1.0)
          .normalized();
  const Eigen::Vector3d light = Eigen::Vector3d(-1.0, 1.0, 2.0).normalized();
  return normal.dot(light) / light.z();
}

cv::Vec3b GroundColour(const Ground& ground, const HeightRange& range, int column, int row) {
  const double height_m = ground.At(column, row);
  if (!std::isfinite(height_m)) return kNoGround;
  const double rise_m = range.high_m - range.low_m;
  const double share = rise_m > 0.0 ? (height_m - range.low_m) / rise_m : 0.0;
  const double shade = std::clamp(Shade(ground, column, row), 0.55, 1.12);
  return (kLow + share * (kHigh - kLow)) * shade;
}

cv::Mat ShadedGround(const Ground& ground, cv::Size size) {
  const HeightRange range = RangeOf(ground);
  cv::Mat cells(ground.rows, ground.columns, CV_8UC3), shaded;
  for (int row = 0; row < ground.rows; ++row) {
    for (int column = 0; column < ground.columns; ++column) {
      cells.at<cv::Vec3b>(ground.rows - 1 - row, column) = GroundColour(ground, range, column, row);
    }
  }
  cv::resize(cells, shaded, size, 0.0, 0.0, cv::INTER_LINEAR);
  return shaded;
}

void DrawPatch(cv::Mat& picture, const Layout& layout, const geometry::FloorArea& patch) {
  const cv::Point2d low = layout.TopPixel({patch.x_min_m, patch.y_min_m});
  const cv::Point2d high = layout.TopPixel({patch.x_max_m, patch.y_max_m});
  const cv::Rect2d whole(cv::Point2d(low.x, high.y), cv::Point2d(high.x, low.y));
  const cv::Rect shown = cv::Rect(whole & cv::Rect2d(layout.top)) & layout.top;
  if (shown.empty()) return;
  cv::Mat part = picture(shown);
  cv::addWeighted(part, 0.75, cv::Mat(part.size(), part.type(), cv::Scalar(240, 190, 130)), 0.25,
                  0.0, part);
  cv::rectangle(picture, shown, kPatchInk, 1);
  const Pen pen(picture, layout.Ui());
  pen.Text(cv::Point2d(shown.x + 4, shown.y + layout.Px(14)), patch.label, 9, kPatchInk,
           std::max(1, shown.width - 6));
}

void DrawWaypoints(const Pen& pen, const Layout& layout, const StaticScene& fixed) {
  for (const geometry::NamedPoint& place : fixed.waypoints) {
    const cv::Point2d at = layout.TopPixel(place.p_in_world_m);
    pen.Dot(at, 7, colour::kInk);
    pen.Dot(at, 5.5, colour::kYellow);
    pen.HaloText(at + cv::Point2d(-layout.Px(8), layout.Px(26)), place.name, 11, colour::kInk);
  }
}

// The longest round length below a quarter of the view.
double ScaleLength_m(double view_m) {
  const double decade = std::pow(10.0, std::floor(std::log10(view_m / 4.0)));
  for (const double step : {5.0, 2.0}) {
    if (step * decade <= view_m / 4.0) return step * decade;
  }
  return decade;
}

void DrawScale(const Pen& pen, const Layout& layout) {
  const double length_m = ScaleLength_m(layout.top.width / layout.px_per_m);
  const double right = layout.top.br().x - layout.Px(12), low = layout.top.y + layout.Px(14);
  const double left = right - length_m * layout.px_per_m, tick = layout.Px(5);
  pen.Line({{left, low - tick}, {left, low}, {right, low}, {right, low - tick}}, colour::kInk, 1);
  pen.Text({left, low + layout.Px(15)}, fmt::format("{:g} m", length_m), 9, colour::kInk);
}

void DrawCaptions(const Pen& pen, const Layout& layout) {
  const double above = layout.Px(7);
  pen.Text({layout.top.x * 1.0, layout.top.y - above}, "top view (x right, y up)", 10,
           colour::kFaint);
  pen.Text({layout.side.x * 1.0, layout.side.y - above}, "side view (x right, z up)", 10,
           colour::kFaint);
}

}  // namespace

cv::Mat Backdrop(const StaticScene& fixed, const Layout& layout) {
  cv::Mat picture(layout.size, CV_8UC3, colour::kPaper);
  ShadedGround(fixed.ground, layout.top.size()).copyTo(picture(layout.top));
  for (const geometry::FloorArea& patch : fixed.patches) DrawPatch(picture, layout, patch);
  const Pen pen(picture, layout.Ui());
  Points reference;
  for (const Eigen::Vector2d& p_m : fixed.reference_m) reference.push_back(layout.TopPixel(p_m));
  if (reference.size() > 1) pen.Line(reference, colour::kBlack, 1.5);
  DrawWaypoints(pen, layout, fixed);
  DrawScale(pen, layout);
  DrawCaptions(pen, layout);
  cv::rectangle(picture, layout.top, colour::kFaint, 1);
  return picture;
}

void DrawProfile(cv::Mat& picture, const StaticScene& fixed, const Layout& layout, double y_low_m,
                 double y_high_m) {
  const Ground& ground = fixed.ground;
  const auto row_at = [&](double y_m) {
    const double row = std::round((y_m - ground.y_min_m) / ground.cell_m);
    return static_cast<int>(std::clamp(row, 0.0, ground.rows - 1.0));
  };
  const double bottom_px = layout.side.br().y;
  Points polygon{{static_cast<double>(layout.side.x), bottom_px}};
  Points edge;
  for (int column = 0; column < ground.columns; ++column) {
    float height_m = -std::numeric_limits<float>::infinity();
    for (int row = row_at(y_low_m); row <= row_at(y_high_m); ++row) {
      height_m = std::max(height_m, ground.At(column, row));
    }
    const cv::Point2d at = layout.SidePixel(ground.x_min_m + column * ground.cell_m, height_m);
    edge.push_back({at.x, std::min(at.y, bottom_px)});
  }
  polygon.insert(polygon.end(), edge.begin(), edge.end());
  polygon.push_back({edge.back().x, bottom_px});
  const Pen pen(picture, layout.Ui());
  pen.Area(polygon, kEarth);
  pen.Line(edge, colour::kInk, 1.5);
}

}  // namespace rift::view
