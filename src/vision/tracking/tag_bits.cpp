#include "tag_bits.hpp"

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "rift/vision/camera/lens.hpp"

namespace rift::vision {
namespace {

constexpr int kSide = 8;

/// Homography that takes the square [0, 8] x [0, 8] (x right, y up) to the four rays.
Eigen::Matrix3d RaysFromCells(const std::array<Eigen::Vector2d, 4>& rays) {
  const std::array<Eigen::Vector2d, 4> corners{{{0, 0}, {kSide, 0}, {kSide, kSide}, {0, kSide}}};
  Eigen::Matrix<double, 8, 8> a = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 1> b;
  for (int i = 0; i < 4; ++i) {
    const Eigen::RowVector3d p = corners[i].homogeneous().transpose();
    a.block<1, 3>(2 * i, 0) = p;
    a.block<1, 3>(2 * i + 1, 3) = p;
    a.block<1, 2>(2 * i, 6) = -rays[i].x() * p.head<2>();
    a.block<1, 2>(2 * i + 1, 6) = -rays[i].y() * p.head<2>();
    b.segment<2>(2 * i) = rays[i];
  }
  const Eigen::Matrix<double, 8, 1> h = a.partialPivLu().solve(b);
  Eigen::Matrix3d homography;
  homography << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), 1.0;
  return homography;
}

/// Middles of the cells, rows from the top of the tag.
std::vector<Eigen::Vector2d> CellPixels(const CameraModel& camera, const FittedSquare& square) {
  const Eigen::Matrix3d rays_from_cells = RaysFromCells(square.rays);
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      points.push_back(rays_from_cells * Eigen::Vector3d(column + 0.5, kSide - row - 0.5, 1.0));
    }
  }
  return PixelsFromPoints(camera, points);
}

bool IsBit(int row, int column) {
  return row > 0 && column > 0 && row < kSide - 1 && column < kSide - 1;
}

}  // namespace

ReadBits CompareBits(const CameraModel& camera, const GreyPatch& patch, const FittedSquare& square,
                     const TagCells& expected) {
  const std::vector<Eigen::Vector2d> pixels = CellPixels(camera, square);
  const double threshold = 0.5 * (square.black_grey + square.white_grey);
  ReadBits read;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const Eigen::Vector2d& pixel = pixels[row * kSide + column];
      const double excess = patch.At(pixel.x(), pixel.y()) - threshold;
      const bool right = expected[row + 1][column + 1] ? excess > 0.0 : excess < 0.0;
      if (!right) ++read.wrong;
      if (IsBit(row, column)) read.margin += std::abs(excess) / 36.0;
    }
  }
  return read;
}

}  // namespace rift::vision
