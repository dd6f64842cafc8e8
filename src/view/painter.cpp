#include "painter.hpp"

#include <algorithm>
#include <functional>

#include "backdrop.hpp"
#include "panel.hpp"
#include "pen.hpp"
#include "robot_shape.hpp"

namespace rift::view {
namespace {

const cv::Scalar kChassis{205, 226, 205};
const cv::Scalar kWheel{70, 66, 62};

// From the world to a picture, one of its views.
using Projection = std::function<cv::Point2d(const Eigen::Vector3d&)>;

Points Project(const std::vector<Eigen::Vector3d>& points, const Projection& to_picture) {
  Points projected;
  for (const Eigen::Vector3d& p : points) projected.push_back(to_picture(p));
  return projected;
}

void DrawRobot(const Pen& pen, const RobotShape& shape, const Projection& to_picture,
               double outline) {
  const Points chassis = Project(shape.chassis, to_picture);
  pen.Hull(chassis, kChassis);
  pen.Hull(Project(shape.left_wheel, to_picture), kWheel);
  pen.Hull(Project(shape.right_wheel, to_picture), kWheel);
  pen.HullOutline(chassis, colour::kGreen, outline);
  pen.Arrow(to_picture(shape.centre), to_picture(shape.nose), colour::kRed, outline);
}

void DrawTrail(const Pen& pen, const Stage& stage, const Layout& layout, size_t points) {
  for (size_t i = 0; i < std::min(points, stage.trail_m.size()); ++i) {
    pen.Dot(layout.TopPixel(stage.trail_m[i]), 2.5, colour::kRed);
  }
}

}  // namespace

Painter::Painter(const Stage& stage, cv::Size size)
    : stage_(stage), layout_(stage, size), backdrop_(Backdrop(stage, layout_)) {}

cv::Mat Painter::Paint(const Scene& scene, const std::vector<std::string>& footer) const {
  cv::Mat picture = backdrop_.clone();
  const RobotShape shape = ShapeOf(stage_.body, scene);
  const double half_m = (stage_.body.track_m + stage_.body.wheel_width_m) / 2.0;
  const double y_m = scene.world_from_robot.y_m;
  DrawProfile(picture, stage_, layout_, y_m - half_m, y_m + half_m);
  cv::Mat top = picture(layout_.top), side = picture(layout_.side);  // nothing leaves its view
  const cv::Point2d top_corner = layout_.top.tl(), side_corner = layout_.side.tl();
  const Pen top_pen(top, layout_.Ui()), side_pen(side, layout_.Ui());
  DrawRobot(
      top_pen, shape,
      [&](const Eigen::Vector3d& p) { return layout_.TopPixel(p.head<2>()) - top_corner; }, 2.5);
  DrawRobot(
      side_pen, shape,
      [&](const Eigen::Vector3d& p) { return layout_.SidePixel(p.x(), p.z()) - side_corner; }, 1.6);
  const Pen pen(picture, layout_.Ui());
  DrawTrail(pen, stage_, layout_, scene.trail_points);
  if (scene.target >= 0) {
    const cv::Point2d target = layout_.TopPixel(stage_.waypoints[scene.target].p_in_world_m);
    pen.Dot(target, 5.5, colour::kYellow);
    pen.Ring(target, 11, colour::kInk, 1.5);
  }
  DrawPanel(picture, stage_, layout_, scene, footer);
  return picture;
}

}  // namespace rift::view
