#include "path_shape.hpp"

#include <Eigen/Eigenvalues>
#include <cassert>
#include <cstddef>
#include <utility>

#include "rift/gap/comparison.hpp"

namespace rift::gap {
namespace {

/// Where the paths of a group stand in the list of all, the reals first.
struct Range {
  size_t first, size, reals;
};

Eigen::MatrixXd Distances(const std::vector<const Shape*>& shapes) {
  const auto n = static_cast<Eigen::Index>(shapes.size());
  Eigen::MatrixXd distances = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      distances(i, j) = distances(j, i) = Distance_m(*shapes[i], *shapes[j]);
    }
  }
  return distances;
}

/// Sums of distances follow from those among the few reals and their rows.
class Energy {
 public:
  explicit Energy(Eigen::MatrixXd distances)
      : distances_(std::move(distances)), rows_(distances_.rowwise().sum()) {}

  double Of(const std::vector<size_t>& reals) const {
    double among_reals = 0.0, from_reals = 0.0;
    for (const size_t i : reals) {
      from_reals += rows_(static_cast<Eigen::Index>(i));
      for (const size_t j : reals) {
        among_reals += distances_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
    const double across = from_reals - among_reals;
    const double among_sims = rows_.sum() - 2.0 * across - among_reals;
    const double r = static_cast<double>(reals.size());
    const double s = static_cast<double>(rows_.size()) - r;
    return 2.0 * across / (r * s) - among_reals / (r * r) - among_sims / (s * s);
  }

  /// The same paths drawn in another order give the same but for this.
  double Rounding_m() const { return 1e-12 * distances_.maxCoeff(); }

 private:
  Eigen::MatrixXd distances_;
  Eigen::VectorXd rows_;
};

/// As many of each group as are real, any of them (Fisher and Yates).
std::vector<size_t> Draw(const std::vector<Range>& ranges, std::mt19937_64& generator) {
  std::vector<size_t> drawn;
  for (const Range& range : ranges) {
    std::vector<size_t> order(range.size);
    for (size_t i = 0; i < range.size; ++i) order[i] = range.first + i;
    for (size_t i = 0; i < range.reals; ++i) {
      std::swap(order[i], order[i + generator() % (range.size - i)]);
      drawn.push_back(order[i]);
    }
  }
  return drawn;
}

}  // namespace

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

EnergyTest TestEnergy(const std::vector<ShuffleGroup>& groups, int shuffles,
                      std::mt19937_64& generator) {
  std::vector<const Shape*> shapes;
  std::vector<Range> ranges;
  std::vector<size_t> reals;
  for (const ShuffleGroup& group : groups) {
    ranges.push_back({shapes.size(), group.reals.size() + group.sims.size(), group.reals.size()});
    for (const Shape& shape : group.reals) {
      reals.push_back(shapes.size());
      shapes.push_back(&shape);
    }
    for (const Shape& shape : group.sims) shapes.push_back(&shape);
  }
  if (reals.size() < 2 || shapes.size() < reals.size() + 2) return {kNotComputed, kNotComputed};

  const Energy energy(Distances(shapes));
  const double measured_m = energy.Of(reals), least_m = measured_m - energy.Rounding_m();
  int as_large = 1;  // the measured labels are one of the shuffles [Phipson and Smyth 2010]
  for (int i = 0; i < shuffles; ++i) as_large += energy.Of(Draw(ranges, generator)) >= least_m;
  return {measured_m, as_large / (shuffles + 1.0)};
}

}  // namespace rift::gap
