#include "painter.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "backdrop.hpp"
#include "path_offset.hpp"
#include "pen.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/view/film.hpp"

namespace rift::view {
namespace {

constexpr double kPanel_px = 290.0;
constexpr double kGap_px = 16.0;
constexpr double kCaption_px = 24.0;
constexpr double kBelowFloor_m = 0.02;

/// Points in the world frame whose hulls are the outlines of the robot in any view.
struct RobotShape {
  std::vector<Eigen::Vector3d> chassis;
  std::vector<Eigen::Vector3d> left_wheel;
  std::vector<Eigen::Vector3d> right_wheel;
  Eigen::Vector3d centre;
  Eigen::Vector3d nose;  ///< tip of the heading arrow
};

constexpr int kCorners = 48;
constexpr double kArrowReach = 1.5;  // of the radius

Eigen::Isometry3d WorldFromRobot(const Scene& scene) {
  Eigen::Isometry3d world_from_robot = Eigen::Isometry3d::Identity();
  world_from_robot.translation() =
      Eigen::Vector3d(scene.world_from_robot.x_m, scene.world_from_robot.y_m, scene.z_m);
  world_from_robot.linear() =
      (Eigen::AngleAxisd(scene.world_from_robot.yaw_rad, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(scene.pitch_rad, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(scene.roll_rad, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return world_from_robot;
}

// The rims of a cylinder of this radius about `axis`, from `low` to `high` along it.
std::vector<Eigen::Vector3d> Cylinder(const Eigen::Isometry3d& world_from_robot,
                                      const Eigen::Vector3d& axis, double radius_m, double low_m,
                                      double high_m) {
  const Eigen::Vector3d u = Eigen::Vector3d::UnitX(), v = axis.cross(u);
  std::vector<Eigen::Vector3d> rims;
  for (int i = 0; i < kCorners; ++i) {
    const double angle_rad = 2.0 * geometry::kPi * i / kCorners;
    const Eigen::Vector3d out = radius_m * (std::cos(angle_rad) * u + std::sin(angle_rad) * v);
    rims.push_back(world_from_robot * (out + low_m * axis));
    rims.push_back(world_from_robot * (out + high_m * axis));
  }
  return rims;
}

RobotShape ShapeOf(const BodyShape& body, const Scene& scene) {
  const Eigen::Isometry3d world_from_robot = WorldFromRobot(scene);
  const auto wheel = [&](double side) {
    const double middle_m = side * body.track_m / 2.0, half_m = body.wheel_width_m / 2.0;
    return Cylinder(world_from_robot, Eigen::Vector3d::UnitY(), body.wheel_radius_m,
                    middle_m - half_m, middle_m + half_m);
  };
  const double bottom_m = body.chassis_bottom_m, top_m = bottom_m + body.chassis_height_m;
  RobotShape shape;
  shape.chassis =
      Cylinder(world_from_robot, Eigen::Vector3d::UnitZ(), body.chassis_radius_m, bottom_m, top_m);
  shape.left_wheel = wheel(1.0);
  shape.right_wheel = wheel(-1.0);
  shape.centre = world_from_robot.translation();
  shape.nose = world_from_robot * Eigen::Vector3d(kArrowReach * body.chassis_radius_m, 0.0, 0.0);
  return shape;
}

const cv::Scalar kPanel{238, 235, 232};
constexpr double kNameLetter_px = 10.0;
constexpr double kValueLetter_px = 12.0;

// Writes one row below the other.
class Column {
 public:
  Column(cv::Mat& picture, const Layout& layout)
      : picture_(picture),
        layout_(layout),
        pen_(picture, layout.Ui()),
        left_(layout.panel.x + layout.Px(18)),
        middle_(left_ + layout.Px(92)),
        right_(layout.panel.br().x - layout.Px(16)) {}

  void Skip(double px) { y_ += layout_.Px(px); }

  void Heading(const std::string& text, const cv::Scalar& ink) {
    Skip(30);
    pen_.Text({left_, y_}, text, 14.5, ink, right_ - left_);
  }

  void Row(const char* name, const std::string& value) {
    Skip(25);
    pen_.Text({left_, y_}, name, kNameLetter_px, colour::kFaint);
    pen_.Text({middle_, y_}, value, kValueLetter_px, colour::kInk, right_ - middle_);
  }

  // Zero in the middle, full power at both ends.
  void Bar(double share) {
    Skip(9);
    const double low = y_, high = y_ + layout_.Px(6), zero = (middle_ + right_) / 2.0;
    pen_.Hull({{middle_, low}, {right_, low}, {right_, high}, {middle_, high}},
              cv::Scalar(214, 210, 206));
    if (std::isfinite(share)) {
      const double tip = zero + std::clamp(share, -1.0, 1.0) * (right_ - zero);
      pen_.Hull({{zero, low}, {tip, low}, {tip, high}, {zero, high}}, colour::kGreen);
    }
    pen_.Line({{zero, low - 2}, {zero, high + 2}}, colour::kInk, 1);
    Skip(4);
  }

  void Footer(const std::vector<std::string>& lines) {
    double y = layout_.size.height - layout_.Px(18.0 * static_cast<double>(lines.size()));
    for (const std::string& line : lines) {
      pen_.Text({left_, y}, line, kNameLetter_px, colour::kFaint, right_ - left_);
      y += layout_.Px(18);
    }
  }

 private:
  cv::Mat& picture_;
  const Layout& layout_;
  Pen pen_;
  double left_, middle_, right_;
  double y_ = 12.0;
};

std::string Value(const char* format, double value) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : std::string("-");
}

std::string TargetName(const StaticScene& fixed, const Scene& scene) {
  return scene.target < 0 ? "-" : fixed.waypoints[scene.target].name;
}

/// The column of text: title, time, pose, speed, powers, waypoint, outcome, and `footer` below.
void DrawPanel(cv::Mat& picture, const StaticScene& fixed, const Layout& layout, const Scene& scene,
               const std::vector<std::string>& footer) {
  using geometry::DegFromRad;
  cv::rectangle(picture, layout.panel, kPanel, cv::FILLED);
  Column column(picture, layout);
  column.Heading(fixed.title, colour::kInk);
  column.Skip(8);
  column.Row("time", Value("{:.2f} s", scene.t_s));
  column.Row("x", Value("{:+.3f} m", scene.world_from_robot.x_m));
  column.Row("y", Value("{:+.3f} m", scene.world_from_robot.y_m));
  column.Row("z", Value("{:+.3f} m", scene.z_m));
  column.Row("yaw", Value("{:+.1f} deg", DegFromRad(scene.world_from_robot.yaw_rad)));
  column.Row("pitch", Value("{:+.1f} deg", DegFromRad(scene.pitch_rad)));
  column.Row("roll", Value("{:+.1f} deg", DegFromRad(scene.roll_rad)));
  column.Row("speed", Value("{:.3f} m/s", scene.speed_mps));
  column.Row("off the path",
             OffsetText(PathOffset_m(scene.world_from_robot.Position(), fixed.reference_m)));
  column.Skip(8);
  column.Row("power left", Value("{:+.3f}", scene.power.left));
  column.Bar(scene.power.left);
  column.Row("right", Value("{:+.3f}", scene.power.right));
  column.Bar(scene.power.right);
  column.Skip(8);
  column.Row("drives to", TargetName(fixed, scene));
  column.Skip(8);
  if (scene.outcome.empty()) {
    column.Row("outcome", "driving");
  } else {
    column.Heading(scene.outcome, scene.outcome == "reached" ? colour::kGreen : colour::kRed);
  }
  column.Footer(footer);
}

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

void DrawTrail(const Pen& pen, const StaticScene& fixed, const Layout& layout, size_t points) {
  for (size_t i = 0; i < std::min(points, fixed.trail_m.size()); ++i) {
    pen.Dot(layout.TopPixel(fixed.trail_m[i]), 2.5, colour::kRed);
  }
}

}  // namespace

Layout::Layout(const StaticScene& fixed, cv::Size picture_size)
    : size(picture_size),
      ui_(std::min(picture_size.height / 720.0, picture_size.width / 1280.0)),
      corner_m_(fixed.ground.x_min_m, fixed.ground.y_min_m) {
  const double width_m = (fixed.ground.columns - 1) * fixed.ground.cell_m;
  const double depth_m = (fixed.ground.rows - 1) * fixed.ground.cell_m;
  const double height_m = fixed.top_m + kBelowFloor_m;
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

Painter::Painter(const StaticScene& fixed, cv::Size size)
    : fixed_(fixed), layout_(fixed, size), backdrop_(Backdrop(fixed, layout_)) {}

cv::Mat Painter::Paint(const Scene& scene, const std::vector<std::string>& footer) const {
  cv::Mat picture = backdrop_.clone();
  const RobotShape shape = ShapeOf(fixed_.body, scene);
  const double half_m = (fixed_.body.track_m + fixed_.body.wheel_width_m) / 2.0;
  const double y_m = scene.world_from_robot.y_m;
  DrawProfile(picture, fixed_, layout_, y_m - half_m, y_m + half_m);
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
  DrawTrail(pen, fixed_, layout_, scene.trail_points);
  if (scene.target >= 0) {
    const cv::Point2d target = layout_.TopPixel(fixed_.waypoints[scene.target].p_in_world_m);
    pen.Dot(target, 5.5, colour::kYellow);
    pen.Ring(target, 11, colour::kInk, 1.5);
  }
  DrawPanel(picture, fixed_, layout_, scene, footer);
  return picture;
}

}  // namespace rift::view
