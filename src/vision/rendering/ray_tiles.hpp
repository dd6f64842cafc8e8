#pragma once

#include <Eigen/Core>
#include <vector>

#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {

/// The ray through every corner between pixels, worked out tile by tile when first asked for: the
/// corner (i, j) is the upper left of pixel (i, j), so i runs to the width and j to the height.
class RayTiles {
 public:
  explicit RayTiles(const CameraModel& camera);
  const Eigen::Vector2d& At(int i, int j);

 private:
  static constexpr int kSide = 32;

  void Fill(std::vector<Eigen::Vector2d>& tile, int tile_x, int tile_y) const;

  CameraModel camera_;
  int tiles_across_;
  std::vector<std::vector<Eigen::Vector2d>> tiles_;
};

}  // namespace rift::vision
