#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "archive.hpp"
#include "rift/search/options.hpp"
#include "rift/statistics/random.hpp"
#include "samplers.hpp"
#include "space.hpp"

namespace rift::search {

/// A Gaussian process with a Matern 5/2 kernel, a length scale for each axis and noise; levels of a
/// category are equally far from each other (Hamming). Own code on Eigen: OpenTURNS would be 100 MB
/// for it and knows no categories, dlib's LIPO has neither noise nor a cost below 10 ms a point.
class Kriging {
 public:
  explicit Kriging(const Space& space);

  /// Rows are points in unit coordinates; values of about unit variance and zero mean. First looks
  /// for better scales in `fit_steps` trials.
  void Fit(const Eigen::MatrixXd& points, const Eigen::VectorXd& values, int fit_steps,
           statistics::Random& random);

  struct Prediction {
    Eigen::VectorXd mean;
    Eigen::VectorXd variance;  ///< of the function without noise
  };
  /// Rows are points.
  Prediction Predict(const Eigen::MatrixXd& points) const;
  /// Correlation of each row of `points` with one point, before any data.
  Eigen::VectorXd Correlation(const Eigen::MatrixXd& points, const Eigen::VectorXd& point) const;
  /// Length scale of an axis in unit coordinates.
  double Scale(int axis) const { return std::exp(scales_.log_length[axis]); }

 private:
  struct Scales {
    Eigen::VectorXd log_length;
    double log_noise = 0.0;  ///< variance of the noise as a share of the signal's
  };
  struct Model {
    double likelihood = 0.0;  ///< logarithm, without constants
    double variance = 1.0;
    Eigen::LLT<Eigen::MatrixXd> cholesky;
    Eigen::VectorXd solved;
  };

  Eigen::MatrixXd Stretched(const Eigen::MatrixXd& points, const Scales& scales) const;
  Eigen::MatrixXd KernelBetween(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const;
  Model ModelWith(const Scales& scales) const;
  Scales Varied(const Scales& scales, double spread, statistics::Random& random) const;
  /// Log prior: no axis is taken for irrelevant or wild before the data say so.
  static double Prior(const Scales& scales);

  const Space& space_;
  Scales scales_;
  std::vector<int> numeric_, categorical_;
  int columns_;  ///< of stretched points: one a numeric axis, one a level of each category
  Eigen::MatrixXd points_, stretched_;
  Eigen::VectorXd values_;
  Model model_;
};

/// Kriging of the losses' ranks (so that one wild loss, or none at all, bends nothing), asked for
/// the points of lowest confidence bound among many candidates: some new anywhere, most around the
/// best ones. The points of a batch differ in how bold they are and keep apart by correlation.
class Surrogate : public Strategy {
 public:
  Surrogate(const Known& known, std::uint64_t seed);

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation>) override {}

 private:
  void FitModel();
  std::vector<std::size_t> ModelPoints();
  Eigen::MatrixXd Candidates();
  Eigen::VectorXd Near(const Eigen::VectorXd& centre);

  const Known& known_;
  statistics::Random random_;
  SobolSequence sequence_;
  Kriging model_;
  std::size_t fitted_at_ = 0;  ///< evaluations when the scales were last looked for
};

}  // namespace rift::search
