#include "track_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "camera_picture.hpp"
#include "path_offset.hpp"
#include "rift/vision/camera/camera_model.hpp"

namespace rift::view {
namespace {

constexpr int kShift = 4;
constexpr double kArrow_m = 0.06;
constexpr double kLegStep_m = 0.02;  // a lens bends straight legs
constexpr double kNearest_m = 0.05;
constexpr double kChassisRadius_m = 0.0485;  // of a 3pi+

const cv::Scalar kGreen{40, 220, 40}, kRed{40, 40, 235}, kBlack{0, 0, 0}, kYellow{0, 225, 255};
const cv::Scalar kBlue{235, 110, 30}, kWhite{255, 255, 255};

/// Draws points of the map into a picture that may be smaller than the camera's.
class MapPen {
 public:
  MapPen(cv::Mat& picture, const TrackScene& scene, double shown_per_px)
      : picture_(picture),
        scene_(scene),
        camera_from_map_(vision::MapFromCamera(*scene.camera).inverse()),
        scale_(shown_per_px) {}

  cv::Point FromPixel(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d shown = ((pixel.array() + 0.5) * scale_ - 0.5).matrix();
    const auto fixed = [](double v) { return cvRound(std::clamp(v, -1e4, 1e4) * (1 << kShift)); };
    return {fixed(shown.x()), fixed(shown.y())};
  }

  /// What lies behind the camera is left out.
  std::vector<cv::Point> FromMap(const std::vector<Eigen::Vector2d>& points_m) const {
    std::vector<Eigen::Vector3d> in_plane;
    for (const Eigen::Vector2d& p : points_m) in_plane.emplace_back(p.x(), p.y(), scene_.plane_z_m);
    return FromSpace(in_plane);
  }
  std::vector<cv::Point> FromSpace(const std::vector<Eigen::Vector3d>& points_in_map) const {
    std::vector<Eigen::Vector3d> ahead;
    for (const Eigen::Vector3d& p : points_in_map) {
      const Eigen::Vector3d p_in_camera = camera_from_map_ * p;
      if (p_in_camera.z() > kNearest_m) ahead.push_back(p_in_camera);
    }
    std::vector<cv::Point> points;
    if (ahead.empty()) return points;
    for (const Eigen::Vector2d& pixel : vision::PixelsFromPoints(*scene_.camera, ahead)) {
      points.push_back(FromPixel(pixel));
    }
    return points;
  }

  void Line(const std::vector<cv::Point>& points, const cv::Scalar& colour, int thick,
            bool closed = false) const {
    if (points.size() < 2) return;
    cv::polylines(picture_, std::vector<std::vector<cv::Point>>{points}, closed, colour, thick,
                  cv::LINE_AA, kShift);
  }
  void Dot(const cv::Point& at, double radius_px, const cv::Scalar& colour) const {
    cv::circle(picture_, at, cvRound(radius_px * (1 << kShift)), colour, cv::FILLED, cv::LINE_AA,
               kShift);
  }
  void Arrow(const cv::Point& from, const cv::Point& to, const cv::Scalar& colour) const {
    cv::arrowedLine(picture_, from, to, colour, 3, cv::LINE_AA, kShift, 0.3);
  }
  void Label(const cv::Point& at, const std::string& text, const cv::Scalar& colour) const {
    const cv::Point place(at.x / (1 << kShift), at.y / (1 << kShift));
    cv::putText(picture_, text, place, cv::FONT_HERSHEY_SIMPLEX, 0.5, kBlack, 3, cv::LINE_AA);
    cv::putText(picture_, text, place, cv::FONT_HERSHEY_SIMPLEX, 0.5, colour, 1, cv::LINE_AA);
  }

 private:
  cv::Mat& picture_;
  const TrackScene& scene_;
  Eigen::Isometry3d camera_from_map_;
  double scale_;
};

std::vector<Eigen::Vector2d> InSmallSteps(const std::vector<Eigen::Vector2d>& path_m) {
  std::vector<Eigen::Vector2d> steps;
  for (std::size_t i = 0; i + 1 < path_m.size(); ++i) {
    const Eigen::Vector2d leg = path_m[i + 1] - path_m[i];
    const int count = std::clamp(static_cast<int>(leg.norm() / kLegStep_m), 1, 1000);
    for (int k = 0; k < count; ++k) steps.push_back(path_m[i] + leg * (1.0 * k / count));
  }
  if (!path_m.empty()) steps.push_back(path_m.back());
  return steps;
}

void DrawMap(const MapPen& pen, const TrackScene& scene) {
  pen.Line(pen.FromMap(InSmallSteps(scene.path_m)), kBlack, 2);
  if (!scene.robots.empty()) {
    for (const LateralLine& line : scene.robots.front().beside.lines) {
      pen.Line(pen.FromMap({line.from_m, line.to_m}), kBlue, 2);
    }
  }
  for (const SceneRobot& robot : scene.robots) pen.Line(pen.FromMap(robot.trail_m), kRed, 2);
  for (const geometry::NamedPoint& place : scene.waypoints) {
    const std::vector<cv::Point> at = pen.FromMap({place.p_in_world_m});
    if (at.empty()) continue;
    pen.Dot(at.front(), 7.5, kBlack);
    pen.Dot(at.front(), 6.0, kYellow);
    pen.Label(at.front() + cv::Point(10 << kShift, -(8 << kShift)), place.name, kYellow);
  }
}

/// The outline of a robot that stands where it has to, nose and all.
void DrawPlace(const MapPen& pen, const geometry::Pose2& map_from_robot) {
  constexpr int kCorners = 36;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < kCorners; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kCorners;
    outline.push_back(map_from_robot * Eigen::Vector2d(kChassisRadius_m * std::cos(angle_rad),
                                                       kChassisRadius_m * std::sin(angle_rad)));
  }
  pen.Line(pen.FromMap(outline), kBlack, 4, true);
  pen.Line(pen.FromMap(outline), kWhite, 2, true);
  const Eigen::Vector2d nose = map_from_robot * Eigen::Vector2d(kArrow_m, 0.0);
  const std::vector<cv::Point> arrow = pen.FromMap({map_from_robot.Position(), nose});
  if (arrow.size() == 2) pen.Arrow(arrow[0], arrow[1], kWhite);
}

void DrawTag(const MapPen& pen, const vision::Sighting& sighting) {
  std::vector<cv::Point> outline;
  for (const Eigen::Vector2d& corner : sighting.corners) outline.push_back(pen.FromPixel(corner));
  pen.Line(outline, kGreen, 2, true);
  const Eigen::Vector3d middle = sighting.map_from_tag.translation();
  const Eigen::Vector3d nose =
      middle + kArrow_m * sighting.map_from_tag.linear().col(0).normalized();
  const std::vector<cv::Point> arrow = pen.FromSpace({middle, nose});
  if (arrow.size() == 2) pen.Arrow(arrow[0], arrow[1], kRed);
}

/// Which robot it is, where there are several.
void DrawId(const MapPen& pen, const vision::Sighting& sighting) {
  Eigen::Vector2d right = sighting.corners.front();
  for (const Eigen::Vector2d& corner : sighting.corners) {
    if (corner.x() > right.x()) right = corner;
  }
  pen.Label(pen.FromPixel(right) + cv::Point(6 << kShift, 0), std::to_string(sighting.tag_id),
            kGreen);
}

/// Where the first robot is beside the path, and was at most.
std::string OffsetLine(const TrackScene& scene) {
  const SceneRobot& robot = scene.robots.front();
  if (scene.path_m.size() < 2) return {};
  const double offset_m = robot.sighting
                              ? PathOffset_m(robot.sighting->Planar().Position(), scene.path_m)
                              : std::nan("");
  const double now_m = std::isnan(offset_m) ? 0.0 : std::abs(offset_m);
  return fmt::format("off the path {}   largest {:.1f} mm", OffsetText(offset_m),
                     1e3 * std::max(robot.beside.largest_m, now_m));
}

std::vector<std::string> PoseLines(const SceneRobot& robot, const std::string& name) {
  if (!robot.sighting) return {name.empty() ? "no tag" : name + "not seen"};
  std::vector<std::string> lines;
  const vision::Sighting& sighting = *robot.sighting;
  const geometry::Pose2 pose = sighting.Planar();
  lines.push_back(fmt::format("{}x {:+.4f} m   y {:+.4f} m   yaw {:+6.1f} deg", name, pose.x_m,
                              pose.y_m, pose.yaw_rad * 180.0 / std::numbers::pi));
  // One robot's, in full.
  if (name.empty()) {
    lines.push_back(fmt::format("z {:+.4f} m   {}", sighting.map_from_tag.translation().z(),
                                sighting.in_world ? "world frame" : "camera frame, y up"));
  }
  if (sighting.tags_of_this_id > 1) {
    lines.push_back(fmt::format("{}{} tags of this id!", name, sighting.tags_of_this_id));
  }
  return lines;
}

}  // namespace

std::vector<std::string> WordsOf(const TrackScene& scene) {
  std::vector<std::string> lines;
  if (scene.robots.empty()) lines.emplace_back("no tag");
  for (const SceneRobot& robot : scene.robots) {
    const std::string name = scene.robots.size() < 2 ? "" : fmt::format("tag {}: ", robot.tag_id);
    for (std::string& line : PoseLines(robot, name)) lines.push_back(std::move(line));
  }
  if (!scene.robots.empty()) {
    const std::string offset = OffsetLine(scene);
    if (!offset.empty()) lines.push_back(offset);
  }
  const auto state = static_cast<std::size_t>(scene.status.state);
  const std::string latency = std::isnan(scene.latency_s)
                                  ? "recording"
                                  : fmt::format("latency {:.0f} ms", 1e3 * scene.latency_s);
  lines.push_back(fmt::format("{}   {:.1f} Hz   {}   dropped {}",
                              EnumNames(scene.status.state)[state], scene.status.rate_hz, latency,
                              scene.status.dropped));
  if (!scene.status.reason.empty()) lines.push_back(scene.status.reason);
  return lines;
}

TrackPicture DrawTrack(const TrackScene& scene) {
  TrackPicture shown;
  shown.bgr = ShownPicture(scene.frame, scene.camera->width_px, scene.camera->height_px);
  const int width_px = scene.frame == nullptr ? scene.camera->width_px : scene.frame->width_px;
  shown.px_per_shown = std::max(1.0, 1.0 * width_px / shown.bgr.cols);
  const MapPen pen(shown.bgr, scene, 1.0 / shown.px_per_shown);
  DrawMap(pen, scene);
  if (scene.stand_at) DrawPlace(pen, *scene.stand_at);
  for (const SceneRobot& robot : scene.robots) {
    if (!robot.sighting) continue;
    DrawTag(pen, *robot.sighting);
    if (scene.robots.size() > 1) DrawId(pen, *robot.sighting);
  }
  DrawLines(shown.bgr, WordsOf(scene), true);
  std::vector<std::string> foot = scene.prompts;
  if (!scene.keys.empty()) foot.push_back(scene.keys);
  if (!foot.empty()) DrawLines(shown.bgr, foot, false);
  return shown;
}

}  // namespace rift::view
