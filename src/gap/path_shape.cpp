#include "path_shape.hpp"

#include <Eigen/Eigenvalues>
#include <cassert>

#include "arc_path.hpp"

namespace rift::gap {

Shape ShapeOf(const trajectory::Trajectory& path, int points) {
  return Resample(MakeArcPath(path, {}), points);
}

Shape MeanShape(std::span<const Shape> shapes) {
  assert(!shapes.empty());
  Shape mean(shapes.front().size(), Eigen::Vector2d::Zero());
  for (const Shape& shape : shapes) {
    for (size_t i = 0; i < mean.size(); ++i) mean[i] += shape[i];
  }
  for (Eigen::Vector2d& point : mean) point /= static_cast<double>(shapes.size());
  return mean;
}

double Distance_m(const Shape& a, const Shape& b) {
  assert(a.size() == b.size());
  double sum_m = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum_m += (a[i] - b[i]).norm();
  return sum_m / static_cast<double>(a.size());
}

std::vector<double> LateralResiduals_m(const Shape& shape) {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : shape) centre += p / static_cast<double>(shape.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : shape) scatter += (p - centre) * (p - centre).transpose();
  // Eigenvalues stand in increasing order: the first direction lies across the line.
  const Eigen::Vector2d across =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvectors().col(0);
  std::vector<double> residuals_m;
  for (const Eigen::Vector2d& p : shape) residuals_m.push_back(across.dot(p - centre));
  return residuals_m;
}

}  // namespace rift::gap
