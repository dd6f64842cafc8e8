#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "rift/vision/calibration/calibration.hpp"
#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision::synthetic {

/// The paper's resolution with a lens of middling distortion.
inline CameraModel WideCamera() {
  CameraModel camera;
  camera.name = "synthetic";
  camera.width_px = 1920;
  camera.height_px = 1080;
  camera.k << 1100.0, 0.0, 940.0, 0.0, 1105.0, 560.0, 0.0, 0.0, 1.0;
  camera.distortion = {-0.12, 0.05, 0.001, -0.0005, 0.0};
  return camera;
}

struct ViewNoise {
  double corner_px = 0.1;
  double bend_m = 0.0;  ///< the board's middle stands out by this
};

/// A board held in front of the camera, wholly inside the picture.
inline BoardView View(const CameraModel& camera, const Board& board, std::mt19937_64& random,
                      const ViewNoise& noise, const std::string& name) {
  std::normal_distribution<double> scatter(0.0, noise.corner_px);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (;;) {
    const double distance_m = uniform(0.22, 0.9);
    const Eigen::Vector3d middle(uniform(-0.85, 0.85) * distance_m, uniform(-0.5, 0.5) * distance_m,
                                 distance_m);
    const Eigen::Quaterniond turn =
        Eigen::AngleAxisd(uniform(-0.3, 0.3), Eigen::Vector3d::UnitZ()) *
        Eigen::AngleAxisd(uniform(-0.8, 0.8), Eigen::Vector3d::UnitY()) *
        Eigen::AngleAxisd(uniform(-0.8, 0.8), Eigen::Vector3d::UnitX());
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < board.Corners(); ++i) {
      const double u = 2.0 * (i % board.columns) / (board.columns - 1) - 1.0;
      const double v = 2.0 * (i / board.columns) / (board.rows - 1) - 1.0;
      const Eigen::Vector3d p(0.5 * u * board.square_m * (board.columns - 1),
                              0.5 * v * board.square_m * (board.rows - 1),
                              -noise.bend_m * (1.0 - u * u));
      points.push_back(middle + turn * p);
    }
    BoardView view{name, camera.width_px, camera.height_px, BoardMethod::kSector};
    bool inside = true;
    for (const Eigen::Vector3d& p : points) inside = inside && p.z() > 0.05;
    if (!inside) continue;
    for (const Eigen::Vector2d& pixel : PixelsFromPoints(camera, points)) {
      inside = inside && pixel.x() > 0 && pixel.y() > 0 && pixel.x() < camera.width_px &&
               pixel.y() < camera.height_px;
      view.corners.push_back(pixel + Eigen::Vector2d(scatter(random), scatter(random)));
    }
    if (inside) return view;
  }
}

inline std::vector<BoardView> Views(const CameraModel& camera, const Board& board, int count,
                                    std::uint64_t seed, const ViewNoise& noise = {}) {
  std::mt19937_64 random(seed);
  std::vector<BoardView> views;
  for (int i = 0; i < count; ++i) {
    views.push_back(View(camera, board, random, noise, "view" + std::to_string(i)));
  }
  return views;
}

}  // namespace rift::vision::synthetic
