#pragma once

#include <Eigen/Core>
#include <optional>

#include "archive.hpp"

namespace rift::search {

/// Proposes the least of a full quadratic over the continuous axes that is fitted to the points
/// nearest to the best one, of its integers and categories: as long as these come true, and again
/// when a quarter more is known. A loss that is a quadratic form is solved at once; another one
/// costs few evaluations.
class QuadraticFit : public Strategy {
 public:
  explicit QuadraticFit(const Known& known) : known_(known) {}

  /// Whether there is something to propose.
  bool IsDue();
  /// One point, or none.
  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation> batch) override;

 private:
  /// In unit coordinates; nothing where the model promises nothing better.
  std::optional<Eigen::VectorXd> Propose();
  void Wait();

  const Known& known_;
  std::optional<Eigen::VectorXd> proposed_;
  double promised_ = 0.0;     ///< loss of the proposed point by the model
  double best_before_ = 0.0;  ///< loss
  std::size_t due_from_ = 0;  ///< evaluations
};

/// Where a quadratic model says that the least loss is.
struct QuadraticMinimum {
  Eigen::VectorXd place;
  double loss;  ///< of the model
};

/// Fits a full quadratic, (d + 1) (d + 2) / 2 coefficients, to `losses` at the columns of `places`
/// (d x n) by least squares, and looks for its least value from `start` within the box of the
/// places. Nothing when there are fewer than two places more than coefficients, or when they do not
/// determine them.
std::optional<QuadraticMinimum> MinimumOfQuadratic(const Eigen::MatrixXd& places,
                                                   const Eigen::VectorXd& losses,
                                                   const Eigen::VectorXd& start);

/// Coefficients of a full quadratic over so many axes.
constexpr int CoefficientsOf(int axes) { return (axes + 1) * (axes + 2) / 2; }

}  // namespace rift::search
