#include "search/functions.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

namespace rift::test {
namespace {

using Vector = Eigen::Matrix<double, kDimensions, 1>;
using Matrix = Eigen::Matrix<double, kDimensions, kDimensions>;

constexpr double kHalfWidth = 5.0;
constexpr int kPeaks = 101;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double Between(double low, double high) {
    return low + (high - low) * 0x1p-64 * static_cast<double>(engine_());
  }
  Vector Place(double half_width) {
    return Vector::NullaryExpr([&] { return Between(-half_width, half_width); });
  }
  Matrix Rotation() {
    std::normal_distribution<double> normal;
    const Matrix any = Matrix::NullaryExpr([&] { return normal(engine_); });
    return Eigen::HouseholderQR<Matrix>(any).householderQ();
  }

 private:
  std::mt19937_64 engine_;
};

Vector AsVector(const search::Point& point) { return Vector(point.data()); }

/// One over the share that z' H z <= level takes of the space, given det H.
double EvaluationsInto(double level, double determinant) {
  const double half = 0.5 * kDimensions;
  const double ball = std::pow(std::numbers::pi, half) / std::tgamma(half + 1.0);
  const double volume = ball * std::pow(level, half) / std::sqrt(determinant);
  return std::pow(2.0 * kHalfWidth, kDimensions) / volume;
}

Task On(std::string name, std::function<double(const search::Point&)> loss,
        std::function<double(double)> random_evaluations) {
  Task task{std::move(name), {}, std::move(loss), std::move(random_evaluations)};
  for (int i = 0; i < kDimensions; ++i) {
    task.axes.push_back(
        {"x" + std::to_string(i), search::AxisKind::kContinuous, -kHalfWidth, kHalfWidth});
  }
  return task;
}

Task Rastrigin(Dice dice) {
  const Vector best = dice.Place(4.0);
  const auto loss = [best](const search::Point& point) {
    const Eigen::Array<double, kDimensions, 1> z = AsVector(point) - best;
    return (z.square() + 10.0 * (1.0 - (2.0 * std::numbers::pi * z).cos())).sum();
  };
  return On("rastrigin", loss, [](double target) {
    const double curvature = 1.0 + 20.0 * std::numbers::pi * std::numbers::pi;
    return EvaluationsInto(target, std::pow(curvature, kDimensions));
  });
}

Task Rosenbrock(Dice dice) {
  const Vector best = dice.Place(4.0);
  const auto loss = [best](const search::Point& point) {
    const Vector z = (AsVector(point) - best).array() + 1.0;
    double sum = 0.0;
    for (int i = 0; i + 1 < kDimensions; ++i) {
      sum += 100.0 * std::pow(z[i] * z[i] - z[i + 1], 2) + std::pow(z[i] - 1.0, 2);
    }
    return sum;
  };
  return On("rosenbrock", loss, [](double target) {
    Matrix form = Matrix::Zero();  // of 100 (2 d_i - d_i+1)^2 + d_i^2, d = z - 1
    for (int i = 0; i + 1 < kDimensions; ++i) {
      const Vector slope = 2.0 * Vector::Unit(i) - Vector::Unit(i + 1);
      form += 100.0 * slope * slope.transpose();
      form(i, i) += 1.0;
    }
    return EvaluationsInto(target, form.determinant());
  });
}

Task Ellipsoid(Dice dice) {
  const Vector best = dice.Place(4.0);
  const Matrix rotation = dice.Rotation();
  const auto loss = [best, rotation](const search::Point& point) {
    const Vector z = rotation * (AsVector(point) - best);
    double sum = 0.0;
    for (int i = 0; i < kDimensions; ++i) {
      sum += std::pow(1e6, i / (kDimensions - 1.0)) * z[i] * z[i];
    }
    return sum;
  };
  return On("ellipsoid", loss,
            [](double target) { return EvaluationsInto(target, std::pow(1e3, kDimensions)); });
}

struct Peak {
  Vector place;
  double height;
  Matrix shape;
};

/// Heights 10 and 1.1 to 9.1; each peak an ellipsoid turned alike, of its own widths up to a ratio
/// of 1000^(1/2) between them.
std::vector<Peak> Peaks(Dice& dice) {
  const Matrix rotation = dice.Rotation();
  std::vector<Peak> peaks;
  for (int i = 0; i < kPeaks; ++i) {
    const double height = i == 0 ? 10.0 : 1.1 + 8.0 * (i - 1) / (kPeaks - 2.0);
    const double condition = i == 0 ? 1000.0 : std::pow(1000.0, dice.Between(0.0, 2.0));
    Vector stretch;
    for (int k = 0; k < kDimensions; ++k) {
      const int at = (k + i) % kDimensions;
      stretch[at] = std::pow(condition, 0.5 * k / (kDimensions - 1.0)) / std::pow(condition, 0.25);
    }
    peaks.push_back({dice.Place(i == 0 ? 4.0 : 4.9), height,
                     rotation.transpose() * stretch.asDiagonal() * rotation});
  }
  return peaks;
}

Task ManyPeaks(Dice dice) {
  const auto peaks = std::make_shared<const std::vector<Peak>>(Peaks(dice));
  const auto loss = [peaks](const search::Point& point) {
    const Vector x = AsVector(point);
    double highest = 0.0;
    for (const Peak& peak : *peaks) {
      const Vector off = x - peak.place;
      const double fall = off.dot(peak.shape * off) / (2.0 * kDimensions);
      highest = std::max(highest, peak.height * std::exp(-fall));
    }
    return std::pow(10.0 - highest, 2);
  };
  // The highest falls by its form, of determinant 1, and the loss is the square of the fall.
  return On("peaks", loss, [](double target) { return EvaluationsInto(std::sqrt(target), 1.0); });
}

constexpr int kRanges = 4, kCategories = 5;
constexpr double kFailingShare = 7.4e-4;

/// A box in one category, of the failing share of the whole space.
struct Box {
  int category = 0;
  std::array<double, kRanges> middle{};
  double half = 0.5 * std::pow(kFailingShare * kCategories, 1.0 / kRanges);

  bool Holds(const search::Point& point) const {
    if (static_cast<int>(point[kRanges]) != category) return false;
    for (int i = 0; i < kRanges; ++i) {
      if (std::abs(point[i] - middle[i]) > half) return false;
    }
    return true;
  }
};

Task Mixed(std::string name, std::function<double(const search::Point&)> loss) {
  Task task{std::move(name), {}, std::move(loss)};
  for (int i = 0; i < kRanges; ++i) {
    task.axes.push_back({"x" + std::to_string(i), search::AxisKind::kContinuous, 0.0, 1.0});
  }
  task.axes.push_back({"c", search::AxisKind::kCategorical, 0, kCategories - 1});
  return task;
}

double SquaredDistance(const search::Point& point, const std::array<double, kRanges>& to) {
  double sum = 0.0;
  for (int i = 0; i < kRanges; ++i) sum += (point[i] - to[i]) * (point[i] - to[i]);
  return sum;
}

Task Deceiving(Dice dice) {
  Box box{.category = static_cast<int>(dice.Between(0.0, kCategories))};
  std::array<double, kRanges> lure{};
  for (double& x : box.middle) x = dice.Between(box.half, 1.0 - box.half);
  for (double& x : lure) x = dice.Between(0.1, 0.9);
  return Mixed("deceiving", [box, lure](const search::Point& point) {
    if (box.Holds(point)) return -1.0;
    if (static_cast<int>(point[kRanges]) == box.category) return 2.0;
    return 0.1 + SquaredDistance(point, lure);
  });
}

/// The box lies where the loss is flat: beyond 0.5 from the middle of the bowl on its first axis.
Task FlatFurtherOut(Dice dice) {
  Box box{.category = static_cast<int>(dice.Between(0.0, kCategories))};
  const double side = dice.Between(0.0, 1.0);
  std::array<double, kRanges> lure{};
  for (double& x : box.middle) x = dice.Between(box.half, 1.0 - box.half);
  for (double& x : lure) x = dice.Between(0.3, 0.7);
  lure[0] = side < 0.5 ? 0.2 : 0.8;
  box.middle[0] = side < 0.5 ? dice.Between(0.75, 1.0 - box.half) : dice.Between(box.half, 0.25);
  return Mixed("flat", [box, lure](const search::Point& point) {
    if (box.Holds(point)) return -1.0;
    return 0.1 + std::min(0.1, SquaredDistance(point, lure));
  });
}

}  // namespace

std::vector<Task> DeceivingSpaces(std::uint64_t seed) {
  return {Deceiving(Dice(7000 + 2 * seed)), FlatFurtherOut(Dice(7001 + 2 * seed))};
}

std::vector<Task> Functions(std::uint64_t seed) {
  return {Rastrigin(Dice(4 * seed)), Rosenbrock(Dice(4 * seed + 1)), Ellipsoid(Dice(4 * seed + 2)),
          ManyPeaks(Dice(4 * seed + 3))};
}

}  // namespace rift::test
