#include "layout.hpp"

#include <algorithm>

namespace rift::view {
namespace {

constexpr double kPanel_px = 290.0;
constexpr double kGap_px = 16.0;
constexpr double kCaption_px = 24.0;
constexpr double kBelowFloor_m = 0.02;

}  // namespace

Layout::Layout(const Stage& stage, cv::Size picture_size)
    : size(picture_size),
      ui_(std::min(picture_size.height / 720.0, picture_size.width / 1280.0)),
      corner_m_(stage.ground.x_min_m, stage.ground.y_min_m) {
  const double width_m = (stage.ground.columns - 1) * stage.ground.cell_m;
  const double depth_m = (stage.ground.rows - 1) * stage.ground.cell_m;
  const double height_m = stage.top_m + kBelowFloor_m;
  const int gap = Px(kGap_px), caption = Px(kCaption_px);
  panel = {size.width - Px(kPanel_px), 0, Px(kPanel_px), size.height};
  const int wide = panel.x - 2 * gap, high = size.height - 2 * caption - 2 * gap;
  px_per_m = std::min(wide / width_m, high / (depth_m + height_m));
  const auto px = [this](double length_m) { return std::max(1, int(length_m * px_per_m)); };
  const int left = gap + (wide - px(width_m)) / 2;
  const int spare = std::max(0, high - px(depth_m) - px(height_m));
  top = {left, caption + spare / 3, px(width_m), px(depth_m)};
  side = {left, top.br().y + caption + spare / 3 + gap / 2, px(width_m), px(height_m)};
}

cv::Point2d Layout::TopPixel(const Eigen::Vector2d& p_in_world_m) const {
  const Eigen::Vector2d p_px = (p_in_world_m - corner_m_) * px_per_m;
  return {top.x + p_px.x(), top.br().y - p_px.y()};
}

cv::Point2d Layout::SidePixel(double x_m, double z_m) const {
  return {side.x + (x_m - corner_m_.x()) * px_per_m,
          side.br().y - (z_m + kBelowFloor_m) * px_per_m};
}

}  // namespace rift::view
