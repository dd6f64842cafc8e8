#include "quadratic_fit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <nlopt.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

namespace rift::search {
namespace {

/// So many times as many points as coefficients are fitted, the nearest.
constexpr double kPointsPerCoefficient = 1.5;
/// A model came true when the loss fell by this share of what it promised.
constexpr double kCameTrue = 0.1;
/// After one that did not, so many times as many evaluations are waited for.
constexpr double kUntilNext = 1.25;
/// Losses beyond tell a model nothing.
constexpr double kLargest = 1e100;
/// More places than coefficients, so that losses with noise are not followed to each.
constexpr int kSpare = 2;
constexpr double kLastStep = 1e-9;
constexpr int kMostSteps = 500;

/// f(x) = constant + gradient' x + x' half_hessian x.
struct Quadratic {
  double constant;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd half_hessian;  ///< symmetric

  double operator()(const Eigen::VectorXd& x) const {
    return constant + gradient.dot(x) + x.dot(half_hessian * x);
  }
};

std::optional<Quadratic> Fit(const Eigen::MatrixXd& places, const Eigen::VectorXd& losses) {
  const Eigen::Index axes = places.rows(), n = places.cols();
  Eigen::MatrixXd terms(n, CoefficientsOf(static_cast<int>(axes)));
  terms.col(0).setOnes();
  terms.middleCols(1, axes) = places.transpose();
  Eigen::Index at = 1 + axes;
  for (Eigen::Index i = 0; i < axes; ++i) {
    for (Eigen::Index j = i; j < axes; ++j) {
      terms.col(at++) = places.row(i).cwiseProduct(places.row(j)).transpose();
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposed(terms);
  if (decomposed.rank() < terms.cols()) return std::nullopt;
  const Eigen::VectorXd found = decomposed.solve(losses);
  Quadratic model{found[0], found.segment(1, axes), Eigen::MatrixXd(axes, axes)};
  at = 1 + axes;
  for (Eigen::Index i = 0; i < axes; ++i) {
    for (Eigen::Index j = i; j < axes; ++j) {
      const double value = found[at++];
      model.half_hessian(i, j) = model.half_hessian(j, i) = i == j ? value : 0.5 * value;
    }
  }
  return model;
}

double Value(const std::vector<double>& x, std::vector<double>& slope, void* data) {
  const auto& model = *static_cast<const Quadratic*>(data);
  const Eigen::Map<const Eigen::VectorXd> at(x.data(), static_cast<Eigen::Index>(x.size()));
  if (!slope.empty()) {
    Eigen::Map<Eigen::VectorXd>(slope.data(), at.size()) =
        model.gradient + 2.0 * model.half_hessian * at;
  }
  return model(at);
}

std::vector<double> AsList(const Eigen::VectorXd& x) { return {x.begin(), x.end()}; }

}  // namespace

std::optional<QuadraticMinimum> MinimumOfQuadratic(const Eigen::MatrixXd& places,
                                                   const Eigen::VectorXd& losses,
                                                   const Eigen::VectorXd& start) {
  if (places.cols() < CoefficientsOf(static_cast<int>(places.rows())) + kSpare) return {};
  // Around the start, whose neighbourhood matters most, and in units of the losses' own spread.
  const double spread = losses.maxCoeff() - losses.minCoeff();
  if (!(spread > 0.0)) return {};
  const Eigen::MatrixXd around = places.colwise() - start;
  std::optional<Quadratic> model = Fit(around, (losses.array() - losses.minCoeff()) / spread);
  if (!model) return {};
  nlopt::opt search(nlopt::LD_SLSQP, static_cast<unsigned>(start.size()));
  search.set_lower_bounds(AsList(around.rowwise().minCoeff().cwiseMin(0.0)));
  search.set_upper_bounds(AsList(around.rowwise().maxCoeff().cwiseMax(0.0)));
  search.set_xtol_abs(kLastStep);
  search.set_maxeval(kMostSteps);
  search.set_min_objective(Value, &*model);
  std::vector<double> x(static_cast<std::size_t>(start.size()), 0.0);
  double least = 0.0;
  try {
    search.optimize(x, least);
  } catch (const nlopt::roundoff_limited&) {  // where it is cannot be told better
  } catch (const std::runtime_error&) {
    return {};
  }
  const Eigen::Map<const Eigen::VectorXd> found(x.data(), start.size());
  return QuadraticMinimum{start + found, losses.minCoeff() + spread * (*model)(found)};
}

std::optional<Eigen::VectorXd> QuadraticFit::Propose() {
  const Archive& archive = known_.archive;
  const std::vector<int>& continuous = known_.space.ContinuousAxes();
  if (continuous.empty() || !(std::abs(archive.BestLoss()) < kLargest)) return {};
  const Eigen::VectorXd best = known_.space.ToUnit(archive[archive.Best(1).front()].point);
  const Eigen::VectorXd middle = best(continuous);
  struct Near {
    double distance, loss;
    Eigen::VectorXd place;
  };
  std::vector<Near> all;
  for (std::size_t i = 0; i < archive.Size(); ++i) {
    const Eigen::VectorXd unit = known_.space.ToUnit(archive[i].point);
    const bool is_told = std::abs(archive[i].loss) < kLargest;
    if (!is_told || !known_.space.HaveSameLevels(unit, best)) continue;
    const Eigen::VectorXd place = unit(continuous);
    all.push_back({(place - middle).squaredNorm(), archive[i].loss, place});
  }
  const int axes = static_cast<int>(continuous.size());
  const auto most = static_cast<std::size_t>(kPointsPerCoefficient * CoefficientsOf(axes));
  std::stable_sort(all.begin(), all.end(),
                   [](const Near& a, const Near& b) { return a.distance < b.distance; });
  if (all.size() > most) all.resize(most);
  Eigen::MatrixXd places(axes, static_cast<Eigen::Index>(all.size()));
  Eigen::VectorXd losses(places.cols());
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    places.col(i) = all[static_cast<std::size_t>(i)].place;
    losses[i] = all[static_cast<std::size_t>(i)].loss;
  }
  const std::optional<QuadraticMinimum> least = MinimumOfQuadratic(places, losses, middle);
  if (!least || !(least->loss < archive.BestLoss())) return {};
  promised_ = least->loss;
  Eigen::VectorXd unit = best;
  unit(continuous) = least->place.cwiseMax(0.0).cwiseMin(1.0);
  return unit;
}

bool QuadraticFit::IsDue() {
  if (known_.archive.Size() < due_from_) return false;
  best_before_ = known_.archive.BestLoss();
  proposed_ = Propose();
  if (!proposed_) Wait();
  return proposed_.has_value();
}

std::vector<Point> QuadraticFit::Ask(int) {
  if (!proposed_ && !IsDue()) return {};
  return {known_.space.FromUnit(*std::exchange(proposed_, std::nullopt))};
}

void QuadraticFit::Tell(std::span<const Evaluation> batch) {
  const double fell = best_before_ - batch.front().loss;
  if (!(fell >= kCameTrue * (best_before_ - promised_))) Wait();
}

void QuadraticFit::Wait() {
  due_from_ = static_cast<std::size_t>(kUntilNext * static_cast<double>(known_.archive.Size()));
}

}  // namespace rift::search
