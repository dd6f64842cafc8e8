#include "rift/vision/tracking/world_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <stdexcept>
#include <utility>

#include "opencv_pose.hpp"

namespace rift::vision {
namespace {

std::vector<WorldPoint> Without(const std::vector<WorldPoint>& points, std::size_t left_out) {
  std::vector<WorldPoint> others = points;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
  return others;
}

/// Where three points put a fourth: the camera's places by P3P above the floor.
double NearestOfThree_m(const CameraModel& camera, const std::vector<WorldPoint>& three,
                        const WorldPoint& fourth) {
  std::vector<cv::Point3d> places;
  std::vector<cv::Point2d> rays;
  for (const WorldPoint& point : three) {
    const Eigen::Vector2d ray = RaysFromPixels(camera, {point.pixel}).front();
    places.emplace_back(point.p_in_world.x(), point.p_in_world.y(), point.p_in_world.z());
    rays.emplace_back(ray.x(), ray.y());
  }
  std::vector<cv::Mat> turns, shifts;
  cv::solveP3P(places, rays, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turns, shifts,
               cv::SOLVEPNP_P3P);
  double nearest_m = HUGE_VAL;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    CameraModel posed = camera;
    posed.world.emplace();
    posed.world->world_from_camera = IsometryOf(turns[i], shifts[i]).inverse();
    if (posed.world->world_from_camera.translation().z() <= 0.0) continue;
    const auto p_m = MapFromPixel(posed, fourth.pixel, fourth.p_in_world.z());
    if (p_m) nearest_m = std::min(nearest_m, (*p_m - fourth.p_in_world.head<2>()).norm());
  }
  return nearest_m;
}

double Off_m(const CameraModel& camera, const std::vector<WorldPoint>& points, std::size_t i) {
  const std::vector<WorldPoint> others = Without(points, i);
  if (others.size() < 4) return NearestOfThree_m(camera, others, points[i]);
  try {
    CameraModel posed = camera;
    posed.world = WorldFromPoints(camera, others, "");
    const auto p_m = MapFromPixel(posed, points[i].pixel, points[i].p_in_world.z());
    return p_m ? (*p_m - points[i].p_in_world.head<2>()).norm() : HUGE_VAL;
  } catch (const std::invalid_argument&) {  // the others alone make no frame
    return HUGE_VAL;
  }
}

double Residual_m(const CameraModel& camera, const std::vector<WorldPoint>& points) {
  try {
    return WorldFromPoints(camera, points, "").residual_m;
  } catch (const std::invalid_argument&) {  // too few, or none that a camera above could see
    return HUGE_VAL;
  }
}

std::string Name(const WorldPoint& point) { return point.name.empty() ? "a point" : point.name; }

/// What makes the points fit, for people: two that were swapped, or the one to leave out.
std::string Culprit(const CameraModel& camera, const std::vector<WorldPoint>& points,
                    double limit_m) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = i + 1; k < points.size(); ++k) {
      std::vector<WorldPoint> swapped = points;
      std::swap(swapped[i].p_in_world, swapped[k].p_in_world);
      if (Residual_m(camera, swapped) > limit_m) continue;
      return fmt::format("{} and {} are swapped: with their places exchanged all fit",
                         Name(points[i]), Name(points[k]));
    }
  }
  std::size_t worst = 0;
  double least_m = HUGE_VAL;
  for (std::size_t i = 0; points.size() > 4 && i < points.size(); ++i) {
    const double left_m = Residual_m(camera, Without(points, i));
    if (left_m < least_m) worst = i;
    least_m = std::min(least_m, left_m);
  }
  if (least_m <= limit_m) {
    return fmt::format("{} is wrong: the others put it {:.1f} mm away; measure it again",
                       Name(points[worst]), 1e3 * Off_m(camera, points, worst));
  }
  return points.size() > 5
             ? "more than one is wrong, or the scale differs in x and y: measure them again"
             : "which one is wrong takes more tags to tell: measure all again, or lay five or more";
}

}  // namespace

std::vector<double> LeaveOneOut_m(const CameraModel& camera,
                                  const std::vector<WorldPoint>& points) {
  std::vector<double> off_m;
  for (std::size_t i = 0; i < points.size(); ++i) off_m.push_back(Off_m(camera, points, i));
  return off_m;
}

void CheckPoints(const CameraModel& camera, const std::vector<WorldPoint>& points, double limit_m) {
  RequireFramePoints(points);
  const std::vector<double> off_m = LeaveOneOut_m(camera, points);
  const double worst_m = *std::max_element(off_m.begin(), off_m.end());
  const double residual_m = Residual_m(camera, points);
  if (residual_m <= limit_m && worst_m <= 2.0 * limit_m) return;
  std::string how_far = "from no place above the floor";
  if (std::isfinite(residual_m)) how_far = fmt::format("{:.1f} mm RMS", 1e3 * residual_m);
  if (residual_m <= limit_m) {
    how_far += fmt::format(", and one {:.1f} mm off where the others put it", 1e3 * worst_m);
  }
  throw std::invalid_argument(fmt::format(
      "the places of the points do not fit what the camera sees, {} (limit {:g} mm{}): {}", how_far,
      1e3 * limit_m, residual_m <= limit_m ? ", for one twice that" : "",
      Culprit(camera, points, limit_m)));
}

std::optional<double> ScaleByTag(const CameraModel& camera, const std::vector<TagDetection>& seen,
                                 int id, double size_m, double height_m) {
  const auto tag =
      std::find_if(seen.begin(), seen.end(), [id](const TagDetection& t) { return t.id == id; });
  if (tag == seen.end()) return std::nullopt;
  double sum_m = 0.0;
  for (int i = 0; i < 4; ++i) {
    const auto a = MapFromPixel(camera, tag->corners[i], height_m);
    const auto b = MapFromPixel(camera, tag->corners[(i + 1) % 4], height_m);
    if (!a || !b) return std::nullopt;
    sum_m += (*a - *b).norm();
  }
  return sum_m / 4.0 / size_m;
}

void CheckScale(double scale, double size_m, double tolerance) {
  if (std::abs(scale - 1.0) <= tolerance) return;
  const char* reason =
      "is the tag's size right (--set track.tag.size_m), and are the places metres?";
  if (scale > 80.0 && scale < 125.0) reason = "the places are centimetres: x_m and y_m are metres";
  if (scale > 800.0 && scale < 1250.0)
    reason = "the places are millimetres: x_m and y_m are metres";
  if (scale > 31.0 && scale < 49.0) reason = "the places are inches: x_m and y_m are metres";
  throw std::invalid_argument(
      fmt::format("in this frame the robot's tag is {:.4g} m wide, printed it is {:g} m: {}",
                  scale * size_m, size_m, reason));
}

std::optional<std::string> WhyNotOfThisLens(const CameraModel& camera) {
  constexpr double kRounded_m = 1e-3;  // what a person who copies numbers may leave out
  if (!camera.world || camera.world->marks.empty()) return std::nullopt;
  double sum_m2 = 0.0;
  for (const ReferenceMark& mark : camera.world->marks) {
    const auto p_m = MapFromPixel(camera, mark.seen_px, mark.p_in_world.z());
    sum_m2 += p_m ? (*p_m - mark.p_in_world.head<2>()).squaredNorm() : HUGE_VAL;
  }
  const double off_m = std::sqrt(sum_m2 / static_cast<double>(camera.world->marks.size()));
  if (off_m <= camera.world->residual_m + kRounded_m) return std::nullopt;
  return fmt::format(
      "the world frame is not of this lens: the reference tags that set it lie {:.1f} mm from "
      "where it puts them, and {:.1f} mm when it was set: set it again (rift track --world)",
      1e3 * off_m, 1e3 * camera.world->residual_m);
}

std::optional<std::string> IsWorseThan(const WorldFrame& next, const WorldFrame& present) {
  constexpr double kSame_m = 2e-4;
  const bool from_floor = next.origin != kFirstPoseOrigin;
  const bool was_from_floor = present.origin != kFirstPoseOrigin;
  const bool is_worse = from_floor == was_from_floor
                            ? next.residual_m > 1.5 * present.residual_m + kSame_m
                            : was_from_floor;
  if (!is_worse) return std::nullopt;
  return fmt::format(
      "it holds a frame from {}, {:.2f} mm off; the new one is from {}, {:.2f} mm off",
      present.origin, 1e3 * present.residual_m, next.origin, 1e3 * next.residual_m);
}

}  // namespace rift::vision
