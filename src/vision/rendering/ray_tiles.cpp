#include "ray_tiles.hpp"

#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {

RayTiles::RayTiles(const CameraModel& camera)
    : camera_(camera),
      tiles_across_(camera.width_px / kSide + 1),
      tiles_(static_cast<std::size_t>(tiles_across_) * (camera.height_px / kSide + 1)) {}

const Eigen::Vector2d& RayTiles::At(int i, int j) {
  const int tile_x = i / kSide;
  const int tile_y = j / kSide;
  std::vector<Eigen::Vector2d>& tile =
      tiles_[static_cast<std::size_t>(tile_y) * tiles_across_ + tile_x];
  if (tile.empty()) Fill(tile, tile_x, tile_y);
  return tile[static_cast<std::size_t>(j - tile_y * kSide) * kSide + (i - tile_x * kSide)];
}

void RayTiles::Fill(std::vector<Eigen::Vector2d>& tile, int tile_x, int tile_y) const {
  std::vector<Eigen::Vector2d> pixels;
  pixels.reserve(kSide * kSide);
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      pixels.emplace_back(tile_x * kSide + i - 0.5, tile_y * kSide + j - 0.5);
    }
  }
  tile = RaysFromPixels(camera_, pixels);
}

}  // namespace rift::vision
