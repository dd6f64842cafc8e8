#pragma once

// The camera above the floor rendered by rays, sharing nothing with rift's synthetic camera but the
// struct of the camera: every pixel is the mean of kFine x kFine rays, each bent by a lens inverted
// here, and the tag is libapriltag's own picture of it.

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagStandard41h12.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/camera/frame.hpp"
#include "rift/vision/tracking/tag_family.hpp"

namespace rift::test {

/// A tag on a dark disc, at a height above the floor.
struct RayTag {
  double x_m = 0.0, y_m = 0.0, yaw_rad = 0.0;
  double height_m = 0.03, size_m = 0.0475, disc_radius_m = 0.0484;
  double lean_rad = 0.0;  ///< about the tag's own x axis
  int id = 0;
  vision::TagFamily family = vision::TagFamily::k36h11;
};

/// libapriltag's own picture of a tag, a pixel a cell, and how it lays the family out.
struct LibraryTag {
  const apriltag_family_t* family;
  const image_u8_t* picture;

  bool IsWhite(int column, int row) const {
    return picture->buf[row * picture->stride + column] > 127;
  }
};

inline LibraryTag LibraryTagOf(vision::TagFamily family, int id) {
  static const std::array<apriltag_family_t*, 4> families{
      tag36h11_create(), tag25h9_create(), tag16h5_create(), tagStandard41h12_create()};
  static std::map<std::pair<vision::TagFamily, int>, image_u8_t*> pictures;  // kept to the end
  apriltag_family_t* of = families.at(static_cast<std::size_t>(family));
  image_u8_t*& picture = pictures[{family, id}];
  if (picture == nullptr) picture = apriltag_to_image(of, static_cast<std::uint32_t>(id));
  return {of, picture};
}

class RayRenderer {
 public:
  /// Light at a pixel: multiplied with what is there, then added to it. None: 1 and 0.
  struct Light {
    double factor = 1.0, glare_grey = 0.0;
  };
  using LightAt = std::function<Light(double u_px, double v_px)>;
  /// A dark thing before the camera, true where it hides what is behind.
  using HiddenAt = std::function<bool(double u_px, double v_px)>;

  explicit RayRenderer(const vision::CameraModel& camera, double noise_grey = 3.0,
                       double blur_px = 0.7)
      : camera_(camera), noise_grey_(noise_grey), blur_px_(blur_px), random_(11) {
    cv::RNG texture(5);
    floor_ = cv::Mat1f(camera.height_px, camera.width_px);
    texture.fill(floor_, cv::RNG::NORMAL, 165.0, 6.0);
    cv::GaussianBlur(floor_, floor_, {}, 2.0);
    noise_ = cv::Mat1f(1, 1 << 20);
    texture.fill(noise_, cv::RNG::NORMAL, 0.0, noise_grey);
  }

  vision::Frame Render(const std::vector<RayTag>& tags, const LightAt& light = {},
                       const HiddenAt& hidden = {}) {
    cv::Mat1f picture = floor_.clone();
    for (const RayTag& tag : tags) Paint(tag, picture);
    for (const RayTag& tag : tags) {
      if (light || hidden) Illuminate(BoxOf(tag), light, hidden, picture);
    }
    AddNoise(picture);
    cv::Mat1b grey;
    picture.convertTo(grey, CV_8U);
    vision::Frame frame;
    frame.width_px = camera_.width_px;
    frame.height_px = camera_.height_px;
    frame.bytes.assign(grey.datastart, grey.dataend);
    return frame;
  }

 private:
  static constexpr int kFine = 7;

  Eigen::Isometry3d WorldFromTag(const RayTag& tag) const {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(tag.x_m, tag.y_m, tag.height_m);
    pose.linear() = (Eigen::AngleAxisd(tag.yaw_rad, Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(tag.lean_rad, Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    return pose;
  }

  /// k1 k2 p1 p2 k3, from a ray to the bent ray.
  Eigen::Vector2d Bend(const Eigen::Vector2d& ray) const {
    const auto& d = camera_.distortion;
    const double r2 = ray.squaredNorm(), x = ray.x(), y = ray.y();
    const double radial = 1.0 + r2 * (d[0] + r2 * (d[1] + r2 * (d.size() > 4 ? d[4] : 0.0)));
    return {x * radial + 2.0 * d[2] * x * y + d[3] * (r2 + 2.0 * x * x),
            y * radial + d[2] * (r2 + 2.0 * y * y) + 2.0 * d[3] * x * y};
  }
  Eigen::Vector2d Straight(double u_px, double v_px) const {
    const Eigen::Vector2d bent((u_px - camera_.k(0, 2)) / camera_.k(0, 0),
                               (v_px - camera_.k(1, 2)) / camera_.k(1, 1));
    Eigen::Vector2d ray = bent;
    for (int i = 0; i < 12; ++i) {
      const Eigen::Vector2d off = Bend(ray) - bent;
      ray -= off;
      if (off.squaredNorm() < 1e-20) break;  // 1e-7 px
    }
    return ray;
  }
  /// By how much a ray changes from a pixel's middle to its right edge, and to its lower one.
  Eigen::Matrix2d HalfPixelAt(const Eigen::Vector2d& ray) const {
    constexpr double kStep = 1e-5;
    Eigen::Matrix2d bent_by_ray;
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(i);
      bent_by_ray.col(i) = (Bend(ray + step) - Bend(ray - step)) / (2.0 * kStep);
    }
    const Eigen::Vector2d half(0.5 / camera_.k(0, 0), 0.5 / camera_.k(1, 1));
    return bent_by_ray.inverse() * half.asDiagonal();
  }

  cv::Rect BoxOf(const RayTag& tag) const {
    const Eigen::Isometry3d camera_from_world = camera_.world->world_from_camera.inverse();
    double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
    const auto* family = LibraryTagOf(tag.family, tag.id).family;
    const double reach_m = std::max(
        tag.disc_radius_m, tag.size_m * 0.72 * family->total_width / family->width_at_border);
    for (int i = 0; i < 16; ++i) {
      const double angle = i * M_PI / 8;
      const Eigen::Vector3d p =
          camera_from_world * Eigen::Vector3d(tag.x_m + reach_m * 1.05 * std::cos(angle),
                                              tag.y_m + reach_m * 1.05 * std::sin(angle),
                                              tag.height_m);
      const Eigen::Vector2d bent = Bend(p.hnormalized());
      const double u = bent.x() * camera_.k(0, 0) + camera_.k(0, 2);
      const double v = bent.y() * camera_.k(1, 1) + camera_.k(1, 2);
      left = std::min(left, u), right = std::max(right, u);
      top = std::min(top, v), bottom = std::max(bottom, v);
    }
    const cv::Rect box(static_cast<int>(left) - 6, static_cast<int>(top) - 6,
                       static_cast<int>(right - left) + 13, static_cast<int>(bottom - top) + 13);
    return box & cv::Rect(0, 0, camera_.width_px, camera_.height_px);
  }

  /// What a ray meets in the tag's plane, and how far from the place the same is met at least.
  struct Met {
    double grey, same_within_m;  ///< grey is negative where nothing is
  };
  static Met MetAt(const RayTag& tag, const LibraryTag& printed, const Eigen::Vector2d& p_in_tag) {
    const double cell_m = tag.size_m / printed.family->width_at_border;
    const int cells = printed.family->total_width;
    const Eigen::Vector2d at = Eigen::Vector2d(p_in_tag.x(), -p_in_tag.y()) / cell_m +
                               Eigen::Vector2d::Constant(0.5 * cells);
    const Eigen::Vector2d cell = at.array().floor();
    if (cell.minCoeff() >= 0.0 && cell.maxCoeff() < cells) {
      const Eigen::Array2d in_cell = (at - cell).array();
      return {
          printed.IsWhite(static_cast<int>(cell.x()), static_cast<int>(cell.y())) ? 215.0 : 28.0,
          cell_m * std::min(in_cell.minCoeff(), (1.0 - in_cell).minCoeff())};
    }
    const double to_print_m = p_in_tag.cwiseAbs().maxCoeff() - 0.5 * cells * cell_m;
    const double to_edge_m = p_in_tag.norm() - tag.disc_radius_m;
    return {to_edge_m < 0.0 ? 45.0 : -1.0, std::min(std::abs(to_edge_m), to_print_m)};
  }

  void Paint(const RayTag& tag, cv::Mat1f& picture) const {
    const cv::Rect box = BoxOf(tag);
    if (box.empty()) return;
    const Eigen::Isometry3d tag_from_camera =
        WorldFromTag(tag).inverse() * camera_.world->world_from_camera;
    cv::Mat1f patch = picture(box).clone();
    const Eigen::Vector3d eye = tag_from_camera.translation();
    const LibraryTag printed = LibraryTagOf(tag.family, tag.id);
    const auto meet = [&](const Eigen::Vector3d& ray) -> Eigen::Vector2d {
      return eye.head<2>() - ray.head<2>() * (eye.z() / ray.z());
    };
    for (int y = 0; y < box.height; ++y) {
      for (int x = 0; x < box.width; ++x) {
        // Within a pixel the lens is linear to 1e-4 px.
        const Eigen::Vector2d middle = Straight(box.x + x, box.y + y);
        const Eigen::Matrix2d half_pixel = HalfPixelAt(middle);
        const Eigen::Vector3d ray = tag_from_camera.linear() * middle.homogeneous();
        const Eigen::Matrix<double, 3, 2> along =
            tag_from_camera.linear().leftCols<2>() * half_pixel;
        const Eigen::Vector2d place = meet(ray);
        double reach_m = 0.0;  // from the middle to the farthest corner
        for (const double u : {-1.0, 1.0}) {
          for (const double v : {-1.0, 1.0}) {
            const Eigen::Vector2d corner = meet(ray + along * Eigen::Vector2d(u, v));
            reach_m = std::max(reach_m, (corner - place).norm());
          }
        }
        const Met all = MetAt(tag, printed, place);
        if (reach_m < all.same_within_m) {
          if (all.grey >= 0.0) patch(y, x) = static_cast<float>(all.grey);
          continue;
        }
        double sum = 0.0;
        for (int k = 0; k < kFine * kFine; ++k) {
          const double u = 2.0 * (k % kFine + 0.5) / kFine - 1.0;
          const double v = 2.0 * (static_cast<int>(k / kFine) + 0.5) / kFine - 1.0;
          const double grey = MetAt(tag, printed, meet(ray + along * Eigen::Vector2d(u, v))).grey;
          sum += grey < 0.0 ? picture(box.y + y, box.x + x) : grey;
        }
        patch(y, x) = static_cast<float>(sum / (kFine * kFine));
      }
    }
    cv::GaussianBlur(patch, patch, {}, blur_px_);
    const cv::Rect inner(3, 3, box.width - 6, box.height - 6);
    if (inner.width > 0 && inner.height > 0) patch(inner).copyTo(picture(box)(inner));
  }

  static void Illuminate(const cv::Rect& box, const LightAt& light, const HiddenAt& hidden,
                         cv::Mat1f& picture) {
    for (int y = box.y; y < box.br().y; ++y) {
      for (int x = box.x; x < box.br().x; ++x) {
        float& grey = picture(y, x);
        if (light) {
          const Light at = light(x, y);
          grey = static_cast<float>(std::min(255.0, grey * at.factor + at.glare_grey));
        }
        if (hidden && hidden(x, y)) grey = 70.0F;
      }
    }
  }

  void AddNoise(cv::Mat1f& picture) {
    if (noise_grey_ <= 0.0) return;
    for (int y = 0; y < picture.rows; ++y) {
      const int at =
          static_cast<int>(random_() % static_cast<unsigned>(noise_.cols - picture.cols));
      cv::Mat row = picture.row(y);
      cv::add(row, noise_(cv::Rect(at, 0, picture.cols, 1)), row);
    }
  }

  vision::CameraModel camera_;
  double noise_grey_, blur_px_;
  std::mt19937_64 random_;
  cv::Mat1f floor_, noise_;
};

/// A camera of half of 1080p that hangs `height_m` above the floor and is tilted from looking
/// straight down; the middle of its picture is the origin of the world. What it sees from half as
/// high with half the focal length is as large in pixels as to a 1080p camera, and is searched in a
/// quarter of the time.
inline vision::CameraModel HungCamera(double height_m, double tilt_deg, double focal_px) {
  vision::CameraModel camera;
  camera.name = "hung";
  camera.width_px = 960;
  camera.height_px = 540;
  camera.k << focal_px, 0.0, 475.4, 0.0, focal_px * 1.002, 272.6, 0.0, 0.0, 1.0;
  camera.distortion = {-0.12, 0.05, 0.0006, -0.0004, 0.0};
  const double tilt_rad = tilt_deg * M_PI / 180.0;
  vision::WorldFrame world;
  world.world_from_camera.linear() =
      Eigen::Matrix3d(Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal()) *
      Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
  world.world_from_camera.translation() =
      Eigen::Vector3d(0.0, -height_m * std::tan(tilt_rad), height_m);
  world.origin = "as built";
  camera.world = world;
  return camera;
}

}  // namespace rift::test
