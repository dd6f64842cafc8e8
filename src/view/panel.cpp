#include "panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pen.hpp"
#include "rift/geometry/angle.hpp"

namespace rift::view {
namespace {

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

std::string TargetName(const Stage& stage, const Scene& scene) {
  return scene.target < 0 ? "-" : stage.waypoints[scene.target].name;
}

}  // namespace

void DrawPanel(cv::Mat& picture, const Stage& stage, const Layout& layout, const Scene& scene,
               const std::vector<std::string>& footer) {
  using geometry::DegFromRad;
  cv::rectangle(picture, layout.panel, kPanel, cv::FILLED);
  Column column(picture, layout);
  column.Heading(stage.title, colour::kInk);
  column.Skip(8);
  column.Row("time", Value("{:.2f} s", scene.t_s));
  column.Row("x", Value("{:+.3f} m", scene.world_from_robot.x_m));
  column.Row("y", Value("{:+.3f} m", scene.world_from_robot.y_m));
  column.Row("z", Value("{:+.3f} m", scene.z_m));
  column.Row("yaw", Value("{:+.1f} deg", DegFromRad(scene.world_from_robot.yaw_rad)));
  column.Row("pitch", Value("{:+.1f} deg", DegFromRad(scene.pitch_rad)));
  column.Row("roll", Value("{:+.1f} deg", DegFromRad(scene.roll_rad)));
  column.Row("speed", Value("{:.3f} m/s", scene.speed_mps));
  column.Skip(8);
  column.Row("power left", Value("{:+.3f}", scene.power.left));
  column.Bar(scene.power.left);
  column.Row("right", Value("{:+.3f}", scene.power.right));
  column.Bar(scene.power.right);
  column.Skip(8);
  column.Row("drives to", TargetName(stage, scene));
  column.Skip(8);
  if (scene.outcome.empty()) {
    column.Row("outcome", "driving");
  } else {
    column.Heading(scene.outcome, scene.outcome == "reached" ? colour::kGreen : colour::kRed);
  }
  column.Footer(footer);
}

}  // namespace rift::view
