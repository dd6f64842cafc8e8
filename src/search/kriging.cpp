#include "kriging.hpp"

#include <algorithm>
#include <cmath>

namespace rift::search {
namespace {

constexpr double kFirstLength = 0.5;
constexpr double kFirstNoise = 1e-2;
constexpr double kLeastNoise = 1e-6;
constexpr double kMostNoise = 10.0;

Eigen::ArrayXXd Matern52(const Eigen::MatrixXd& squared) {
  const Eigen::ArrayXXd r = (5.0 * squared.array()).max(0.0).sqrt();
  return (1.0 + r + r.square() / 3.0) * (-r).exp();
}

}  // namespace

Kriging::Kriging(const Space& space) : space_(space), columns_(0) {
  for (int axis = 0; axis < space.Size(); ++axis) {
    (space.IsCategorical(axis) ? categorical_ : numeric_).push_back(axis);
    columns_ += space.IsCategorical(axis) ? static_cast<int>(space.Levels(axis)) : 1;
  }
  scales_.log_length = Eigen::VectorXd::Constant(space.Size(), std::log(kFirstLength));
  scales_.log_noise = std::log(kFirstNoise);
}

Eigen::MatrixXd Kriging::Stretched(const Eigen::MatrixXd& points, const Scales& scales) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(points.rows(), columns_);
  int column = 0;
  for (const int axis : numeric_) {
    out.col(column++) = points.col(axis) * std::exp(-scales.log_length[axis]);
  }
  for (const int axis : categorical_) {
    // Two levels are then one length scale's inverse apart, as 0 and 1 on a numeric axis.
    const double height = std::exp(-scales.log_length[axis]) / std::sqrt(2.0);
    const double levels = space_.Levels(axis);
    for (Eigen::Index row = 0; row < points.rows(); ++row) {
      const double level = std::min(std::floor(points(row, axis) * levels), levels - 1.0);
      out(row, column + static_cast<int>(level)) = height;
    }
    column += static_cast<int>(levels);
  }
  return out;
}

Eigen::MatrixXd Kriging::KernelBetween(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd squared = -2.0 * a * b.transpose();
  squared.colwise() += a.rowwise().squaredNorm();
  squared.rowwise() += b.rowwise().squaredNorm().transpose();
  return Matern52(squared);
}

Kriging::Model Kriging::ModelWith(const Scales& scales) const {
  const Eigen::MatrixXd stretched = Stretched(points_, scales);
  Eigen::MatrixXd kernel = KernelBetween(stretched, stretched);
  kernel.diagonal().array() += std::exp(scales.log_noise);
  Model model;
  model.cholesky.compute(kernel);
  model.solved = model.cholesky.solve(values_);
  const double n = static_cast<double>(values_.size());
  model.variance = std::max(values_.dot(model.solved) / n, 1e-12);
  const double log_determinant = 2.0 * model.cholesky.matrixLLT().diagonal().array().log().sum();
  model.likelihood = -0.5 * (n * std::log(model.variance) + log_determinant) + Prior(scales);
  if (!std::isfinite(model.likelihood)) model.likelihood = -std::numeric_limits<double>::max();
  return model;
}

double Kriging::Prior(const Scales& scales) {
  const Eigen::ArrayXd off = scales.log_length.array() - std::log(kFirstLength);
  const double noise = scales.log_noise - std::log(kFirstNoise);
  return -0.5 * off.square().sum() - 0.5 * noise * noise / 9.0;
}

Kriging::Scales Kriging::Varied(const Scales& scales, double spread,
                                statistics::Random& random) const {
  Scales varied = scales;
  for (double& length : varied.log_length) {
    length = std::clamp(length + spread * random.Normal(), std::log(0.02), std::log(20.0));
  }
  varied.log_noise = std::clamp(varied.log_noise + 2.0 * spread * random.Normal(),
                                std::log(kLeastNoise), std::log(kMostNoise));
  return varied;
}

void Kriging::Fit(const Eigen::MatrixXd& points, const Eigen::VectorXd& values, int fit_steps,
                  statistics::Random& random) {
  points_ = points;
  values_ = values;
  model_ = ModelWith(scales_);
  double spread = 0.7;
  for (int i = 0; i < fit_steps; ++i) {  // a (1+1) evolution strategy with a one-fifth rule
    const Scales varied = Varied(scales_, spread, random);
    Model model = ModelWith(varied);
    const bool is_better = model.likelihood > model_.likelihood;
    spread *= is_better ? 1.5 : 0.9;
    if (!is_better) continue;
    scales_ = varied;
    model_ = std::move(model);
  }
  stretched_ = Stretched(points_, scales_);
}

Kriging::Prediction Kriging::Predict(const Eigen::MatrixXd& points) const {
  const Eigen::MatrixXd kernel = KernelBetween(stretched_, Stretched(points, scales_));
  Prediction prediction;
  prediction.mean = kernel.transpose() * model_.solved;
  const Eigen::MatrixXd half = model_.cholesky.matrixL().solve(kernel);
  const Eigen::ArrayXd explained = half.colwise().squaredNorm().transpose();
  prediction.variance = model_.variance * (1.0 - explained).max(1e-12);
  return prediction;
}

Eigen::VectorXd Kriging::Correlation(const Eigen::MatrixXd& points,
                                     const Eigen::VectorXd& point) const {
  return KernelBetween(Stretched(points, scales_), Stretched(point.transpose(), scales_)).col(0);
}

}  // namespace rift::search
