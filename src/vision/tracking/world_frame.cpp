#include "rift/vision/tracking/world_frame.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <stdexcept>

#include "opencv_pose.hpp"
#include "planar_pose.hpp"
#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/tracking/world_check.hpp"

namespace rift::vision {
namespace {

constexpr std::size_t kLeastPoints = 4;
constexpr double kFlat_m = 1e-6;
constexpr double kThinnest = 0.05;  // width to length of the cloud of points

std::vector<cv::Point3d> PlacesOf(const std::vector<WorldPoint>& points) {
  std::vector<cv::Point3d> places;
  for (const WorldPoint& point : points) {
    places.emplace_back(point.p_in_world.x(), point.p_in_world.y(), point.p_in_world.z());
  }
  return places;
}

std::vector<cv::Point2d> PointsOf(const std::vector<Eigen::Vector2d>& rays) {
  std::vector<cv::Point2d> points;
  for (const Eigen::Vector2d& ray : rays) points.emplace_back(ray.x(), ray.y());
  return points;
}

bool AreOnLine(const std::vector<WorldPoint>& points) {
  Eigen::Matrix2Xd places(2, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) places.col(i) = points[i].p_in_world.head<2>();
  const Eigen::Matrix2Xd centred = places.colwise() - places.rowwise().mean();
  const Eigen::Vector2d spread = Eigen::Matrix2d(centred * centred.transpose())
                                     .selfadjointView<Eigen::Lower>()
                                     .eigenvalues()
                                     .cwiseMax(0.0)
                                     .cwiseSqrt();
  return spread(0) < kThinnest * spread(1) || spread(1) <= 0.0;
}

/// camera_from_world, by OpenCV's solver for points that lie on no plane.
std::vector<Eigen::Isometry3d> SpatialPoses(const std::vector<cv::Point3d>& places,
                                            const std::vector<cv::Point2d>& rays) {
  std::vector<cv::Mat> turns, shifts;
  cv::solvePnPGeneric(places, rays, cv::Matx33d::eye(), cv::noArray(), turns, shifts, false,
                      cv::SOLVEPNP_SQPNP);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < turns.size(); ++i) poses.push_back(IsometryOf(turns[i], shifts[i]));
  return poses;
}

std::vector<Eigen::Isometry3d> Starts(const std::vector<WorldPoint>& points,
                                      const std::vector<Eigen::Vector2d>& rays) {
  const double z_m = points.front().p_in_world.z();
  const bool flat = std::all_of(points.begin(), points.end(), [z_m](const WorldPoint& point) {
    return std::abs(point.p_in_world.z() - z_m) < kFlat_m;
  });
  if (!flat) return SpatialPoses(PlacesOf(points), PointsOf(rays));
  std::vector<Eigen::Vector2d> in_plane_m;
  for (const WorldPoint& point : points) in_plane_m.push_back(point.p_in_world.head<2>());
  std::vector<Eigen::Isometry3d> poses = PlanarPoses(in_plane_m, rays);
  for (Eigen::Isometry3d& pose : poses) pose = pose * Eigen::Translation3d(0.0, 0.0, -z_m);
  return poses;
}

/// The poses with the least squared distances on the plane before the camera, camera_from_world.
std::vector<Eigen::Isometry3d> Solve(const std::vector<WorldPoint>& points,
                                     const std::vector<Eigen::Vector2d>& rays) {
  std::vector<Eigen::Isometry3d> refined;
  for (const Eigen::Isometry3d& start : Starts(points, rays)) {
    cv::Mat rotation, turn, shift;
    cv::eigen2cv(Eigen::Matrix3d(start.linear()), rotation);
    cv::eigen2cv(Eigen::Vector3d(start.translation()), shift);
    cv::Rodrigues(rotation, turn);
    cv::solvePnPRefineLM(PlacesOf(points), PointsOf(rays), cv::Matx33d::eye(), cv::noArray(), turn,
                         shift);
    refined.push_back(IsometryOf(turn, shift));
  }
  return refined;
}

Eigen::Vector2d OnPlane(const Eigen::Isometry3d& world_from_camera, const Eigen::Vector2d& ray,
                        double z_m) {
  const Eigen::Vector3d eye = world_from_camera.translation();
  const Eigen::Vector3d direction = world_from_camera.linear() * ray.homogeneous();
  return (eye + direction * ((z_m - eye.z()) / direction.z())).head<2>();
}

double Residual_m(const Eigen::Isometry3d& world_from_camera, const std::vector<WorldPoint>& points,
                  const std::vector<Eigen::Vector2d>& rays) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d& p = points[i].p_in_world;
    sum += (OnPlane(world_from_camera, rays[i], p.z()) - p.head<2>()).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

const TagDetection* Find(const std::vector<TagDetection>& seen, int id) {
  const auto found =
      std::find_if(seen.begin(), seen.end(), [id](const TagDetection& t) { return t.id == id; });
  return found == seen.end() ? nullptr : &*found;
}

/// Of several tags with the mark's id the one that is nearest to where the mark was seen: another
/// one may lie about.
const TagDetection* FindNearest(const CameraModel& camera, const std::vector<TagDetection>& seen,
                                const ReferenceMark& mark) {
  const TagDetection* nearest = nullptr;
  double least_px = HUGE_VAL;
  for (const TagDetection& tag : seen) {
    if (tag.id != mark.tag_id) continue;
    const double off_px = (MiddlePixel(camera, tag.corners) - mark.seen_px).norm();
    if (off_px >= least_px) continue;
    nearest = &tag;
    least_px = off_px;
  }
  return nearest;
}

}  // namespace

void RequireFramePoints(const std::vector<WorldPoint>& points) {
  if (points.size() < kLeastPoints) {
    throw std::invalid_argument(fmt::format(
        "a world frame needs {} points that are seen, there are {}", kLeastPoints, points.size()));
  }
  if (AreOnLine(points)) {
    throw std::invalid_argument(
        "a world frame needs points in both directions of the floor, these lie on a line");
  }
}

WorldFrame WorldFromPoints(const CameraModel& camera, const std::vector<WorldPoint>& points,
                           const std::string& origin) {
  RequireFramePoints(points);
  std::vector<Eigen::Vector2d> pixels;
  for (const WorldPoint& point : points) pixels.push_back(point.pixel);
  const std::vector<Eigen::Vector2d> rays = RaysFromPixels(camera, pixels);
  WorldFrame world{.residual_m = HUGE_VAL, .origin = origin};
  for (const Eigen::Isometry3d& camera_from_world : Solve(points, rays)) {
    const Eigen::Isometry3d world_from_camera = camera_from_world.inverse();
    const double residual_m = Residual_m(world_from_camera, points, rays);
    if (world_from_camera.translation().z() <= 0.0 || !(residual_m < world.residual_m)) continue;
    world.world_from_camera = world_from_camera;
    world.residual_m = residual_m;
  }
  if (std::isfinite(world.residual_m)) return world;
  throw std::invalid_argument(
      "these points could only be seen so from below the floor: give them with x right and y up, "
      "as on a map (counter-clockwise positive), each at its own point");
}

WorldFrame WorldFromTags(const CameraModel& camera, const std::vector<ReferenceMark>& tags,
                         const std::vector<TagDetection>& seen, double limit_m) {
  std::vector<WorldPoint> points;
  std::vector<ReferenceMark> marks;
  std::string missing;
  for (ReferenceMark mark : tags) {
    const TagDetection* tag = Find(seen, mark.tag_id);
    if (tag == nullptr) {
      missing += fmt::format("{}{}", missing.empty() ? "" : ", ", mark.tag_id);
      continue;
    }
    mark.seen_px = MiddlePixel(camera, tag->corners);
    points.push_back({mark.p_in_world, mark.seen_px, fmt::format("tag {}", mark.tag_id)});
    marks.push_back(mark);
  }
  if (points.size() < kLeastPoints) {
    throw std::invalid_argument(
        tags.size() < kLeastPoints
            ? fmt::format(
                  "a world frame needs {} reference tags or more, and the file names {}: lay "
                  "and name more",
                  kLeastPoints, tags.size())
            : fmt::format("a world frame needs {} reference tags, {} of {} are seen (not {})",
                          kLeastPoints, points.size(), tags.size(), missing));
  }
  CheckPoints(camera, points, limit_m);
  WorldFrame world =
      WorldFromPoints(camera, points, fmt::format("{} reference tags", points.size()));
  world.marks = marks;
  return world;
}

WorldFrame WorldFromFirstPose(const std::vector<Eigen::Isometry3d>& camera_from_tag,
                              double tag_height_m) {
  if (camera_from_tag.empty()) throw std::invalid_argument("no sighting to set a world frame from");
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
  for (const Eigen::Isometry3d& pose : camera_from_tag) {
    middle += pose.translation() / static_cast<double>(camera_from_tag.size());
    turns += pose.linear();
  }
  // The rotation nearest to the mean of matrices (chordal mean).
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(turns, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d mean = Eigen::Isometry3d::Identity();
  mean.linear() = svd.matrixU() * svd.matrixV().transpose();
  mean.translation() = middle;
  double scatter = 0.0;
  for (const Eigen::Isometry3d& pose : camera_from_tag) {
    scatter += (pose.translation() - middle).squaredNorm();
  }
  WorldFrame world;
  world.world_from_camera = Eigen::Translation3d(0.0, 0.0, tag_height_m) * mean.inverse();
  world.residual_m = std::sqrt(scatter / static_cast<double>(camera_from_tag.size()));
  world.origin = kFirstPoseOrigin;
  return world;
}

std::optional<double> MovedBy_m(const CameraModel& camera, const std::vector<TagDetection>& seen) {
  if (!camera.world) return {};
  double sum = 0.0;
  int count = 0;
  for (const ReferenceMark& mark : camera.world->marks) {
    const TagDetection* tag = FindNearest(camera, seen, mark);
    if (tag == nullptr) continue;
    const double z_m = mark.p_in_world.z();
    const auto then = MapFromPixel(camera, mark.seen_px, z_m);
    const auto now = MapFromPixel(camera, MiddlePixel(camera, tag->corners), z_m);
    if (!then || !now) continue;
    sum += (*now - *then).squaredNorm();
    ++count;
  }
  if (count == 0) return {};
  return std::sqrt(sum / count);
}

std::optional<Eigen::Vector2d> MapFromPixel(const CameraModel& camera, const Eigen::Vector2d& pixel,
                                            double z_m) {
  const Eigen::Isometry3d map_from_camera = MapFromCamera(camera);
  const Eigen::Vector2d ray = RaysFromPixels(camera, {pixel}).front();
  const double fall = (map_from_camera.linear() * ray.homogeneous()).z();
  const double way = (z_m - map_from_camera.translation().z()) / fall;
  if (!(way > 0.0) || !std::isfinite(way)) return {};
  return OnPlane(map_from_camera, ray, z_m);
}

Eigen::Vector2d MiddlePixel(const CameraModel& camera, const TagCorners& corners) {
  const std::vector<Eigen::Vector2d> rays =
      RaysFromPixels(camera, {corners.begin(), corners.end()});
  const auto line = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.homogeneous().cross(b.homogeneous()).eval();
  };
  const Eigen::Vector3d crossing = line(rays[0], rays[2]).cross(line(rays[1], rays[3]));
  return PixelsFromPoints(camera, {crossing / crossing.z()}).front();
}

}  // namespace rift::vision
