#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <opencv2/core.hpp>

#include "flat_pattern.hpp"
#include "ray_tiles.hpp"
#include "rift/vision/camera/frame.hpp"

namespace rift::vision {

/// Where a pattern is while the given row of the picture is exposed.
using PoseOfRow = std::function<Eigen::Isometry3d(double row)>;

/// The pixels that may show the pattern, clipped to the picture; empty when it is behind the
/// camera.
Region Footprint(const CameraModel& camera, const FlatPattern& pattern,
                 const Eigen::Isometry3d& camera_from_pattern);

/// Paints patterns over a canvas of floats that shows `canvas_region` of the picture. A pixel is
/// the mean over its square: exact where one cell covers it, of `fine` x `fine` points where an
/// edge runs through.
class FlatPainter {
 public:
  static constexpr int kFine = 8;

  explicit FlatPainter(const CameraModel& camera) : rays_(camera) {}
  void Paint(const FlatPattern& pattern, const PoseOfRow& camera_from_pattern, const Region& where,
             const Region& canvas_region, cv::Mat1f& canvas, int fine = kFine);

 private:
  struct Corner {
    Eigen::Vector2d point;  ///< on the pattern's plane
    int cell;
  };
  void MeetPlane(const FlatPattern& pattern, const Eigen::Isometry3d& camera_from_pattern, int row,
                 const Region& where, std::vector<Corner>& corners);

  RayTiles rays_;
  std::vector<Corner> above_;
  std::vector<Corner> below_;
};

}  // namespace rift::vision
