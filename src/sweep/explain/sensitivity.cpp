#include "rift/sweep/explain/sensitivity.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "rift/statistics/descriptive.hpp"

namespace rift::sweep {
namespace {

constexpr double kTrialsPerTerm = 3.0;
constexpr double kTrustedQ2 = 0.5;

/// Functions of one axis, orthonormal when its values are even: normalised Legendre polynomials of
/// a range; of a list, those of the level's place on it for numbers, and contrasts for words.
class Axis {
 public:
  explicit Axis(const experiment::Parameter& parameter) : parameter_(parameter) { MakeContrasts(); }

  /// Orders above this do not exist.
  int MostOrder() const {
    return parameter_.IsContinuous() ? 64 : static_cast<int>(parameter_.levels.size()) - 1;
  }
  /// How much of the total degree a function uses up: all contrasts of a list are of the first.
  int DegreeOf(int order) const { return parameter_.IsContinuous() ? order : std::min(order, 1); }

  double Value(int order, const experiment::ParameterValue& value) const {
    if (order == 0) return 1.0;
    return parameter_.IsContinuous() ? Legendre(order, *value.number)
                                     : contrasts_(LevelOf(value), order);
  }

 private:
  double Legendre(int order, double x) const {
    const double t = 2.0 * (x - parameter_.min) / (parameter_.max - parameter_.min) - 1.0;
    return std::sqrt(2.0 * order + 1.0) *
           std::legendre(static_cast<unsigned>(order), std::clamp(t, -1.0, 1.0));
  }

  Eigen::Index LevelOf(const experiment::ParameterValue& value) const {
    const auto found = std::find(parameter_.levels.begin(), parameter_.levels.end(), value);
    return found == parameter_.levels.end() ? 0 : found - parameter_.levels.begin();
  }

  /// An orthogonal matrix whose first column is constant, scaled to mean squares of one.
  void MakeContrasts() {
    const auto n = static_cast<Eigen::Index>(parameter_.levels.size());
    if (n == 0) return;
    Eigen::MatrixXd columns = Eigen::MatrixXd::Identity(n, n);
    columns.col(0).setOnes();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
    contrasts_ = qr.householderQ() * Eigen::MatrixXd::Identity(n, n);
    contrasts_ *= std::sqrt(static_cast<double>(n));
  }

  const experiment::Parameter& parameter_;
  Eigen::MatrixXd contrasts_;
};

using Orders = std::vector<int>;  ///< one for each axis

void AddOrders(const std::vector<Axis>& axes, int left, size_t most, Orders& orders, size_t axis,
               std::vector<Orders>& terms) {
  if (terms.size() > most) return;
  if (axis == axes.size()) {
    terms.push_back(orders);
    return;
  }
  for (int order = 0; order <= axes[axis].MostOrder(); ++order) {
    const int degree = axes[axis].DegreeOf(order);
    if (degree > left) break;
    orders[axis] = order;
    AddOrders(axes, left - degree, most, orders, axis + 1, terms);
  }
  orders[axis] = 0;
}

struct Data {
  std::vector<const TrialRow*> rows;
  Eigen::VectorXd gaps_m;
};

Data Pick(const SweepResult& result, int most) {
  std::vector<const TrialRow*> all;
  for (const int row : RowsThatCount(result)) all.push_back(&result.rows[row]);
  Data data;
  const size_t step = 1 + all.size() / static_cast<size_t>(most + 1);
  for (size_t i = 0; i < all.size(); i += step) data.rows.push_back(all[i]);
  data.gaps_m.resize(static_cast<Eigen::Index>(data.rows.size()));
  for (size_t i = 0; i < data.rows.size(); ++i) {
    data.gaps_m[static_cast<Eigen::Index>(i)] = Loss_m(*data.rows[i], result.gap.threshold_m);
  }
  return data;
}

Eigen::MatrixXd DesignOf(const Data& data, const std::vector<Axis>& axes,
                         const std::vector<Orders>& terms) {
  Eigen::MatrixXd design(data.gaps_m.size(), static_cast<Eigen::Index>(terms.size()));
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    for (Eigen::Index j = 0; j < design.cols(); ++j) {
      double value = 1.0;
      for (size_t axis = 0; axis < axes.size(); ++axis) {
        const int order = terms[static_cast<size_t>(j)][axis];
        if (order > 0)
          value *= axes[axis].Value(order, data.rows[static_cast<size_t>(i)]->theta[axis]);
      }
      design(i, j) = value;
    }
  }
  return design;
}

/// Share of the variance that the fit predicts of each trial from the others (PRESS).
double LeaveOneOut(const Eigen::MatrixXd& design, const Eigen::VectorXd& y) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(design);
  if (qr.rank() < design.cols()) return -1.0;
  const Eigen::MatrixXd q =
      qr.householderQ() * Eigen::MatrixXd::Identity(design.rows(), design.cols());
  const Eigen::VectorXd residual = y - q * (q.transpose() * y);
  double press = 0.0;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    press += std::pow(residual[i] / std::max(1e-9, 1.0 - q.row(i).squaredNorm()), 2);
  }
  const double total = (y.array() - y.mean()).square().sum();
  return total > 0.0 ? 1.0 - press / total : -1.0;
}

struct Expansion {
  std::vector<Orders> terms;
  Eigen::MatrixXd design;
  double q2 = -1.0;
  int degree = 0;
};

Expansion BestExpansion(const Data& data, const std::vector<Axis>& axes,
                        const SensitivityOptions& options) {
  Expansion best;
  const double affordable = static_cast<double>(data.rows.size()) / kTrialsPerTerm;
  const auto most = static_cast<size_t>(std::min<double>(options.most_terms, affordable));
  for (int degree = 1; degree <= options.most_degree; ++degree) {
    Expansion next{.degree = degree};
    Orders orders(axes.size(), 0);
    AddOrders(axes, degree, most, orders, 0, next.terms);
    if (next.terms.size() > most) break;
    next.design = DesignOf(data, axes, next.terms);
    next.q2 = LeaveOneOut(next.design, data.gaps_m);
    if (next.q2 > best.q2) best = std::move(next);
  }
  return best;
}

struct Shares {
  Eigen::VectorXd first, total;
};

/// Squared coefficients are shares of the variance, since the functions are orthonormal.
Shares SharesOf(const Expansion& expansion, const Eigen::VectorXd& coefficients, size_t axes) {
  Shares shares{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(axes)),
                Eigen::VectorXd::Zero(static_cast<Eigen::Index>(axes))};
  double variance = 0.0;
  for (size_t j = 0; j < expansion.terms.size(); ++j) {
    const Orders& orders = expansion.terms[j];
    const auto involved = std::count_if(orders.begin(), orders.end(), [](int o) { return o > 0; });
    const double square = std::pow(coefficients[static_cast<Eigen::Index>(j)], 2);
    if (involved > 0) variance += square;
    for (size_t axis = 0; axis < axes; ++axis) {
      if (orders[axis] == 0) continue;
      shares.total[static_cast<Eigen::Index>(axis)] += square;
      if (involved == 1) shares.first[static_cast<Eigen::Index>(axis)] += square;
    }
  }
  if (variance > 0.0) {
    shares.first /= variance;
    shares.total /= variance;
  }
  return shares;
}

/// Least squares of the trials, each counted as often as it was drawn.
Eigen::VectorXd Weighted(const Eigen::MatrixXd& design, const Eigen::VectorXd& y,
                         const Eigen::VectorXd& weights) {
  const Eigen::MatrixXd weighted = design.transpose() * weights.asDiagonal();
  return (weighted * design).ldlt().solve(weighted * y);
}

std::pair<double, double> Middle95(const std::vector<double>& values) {
  const auto [low, high] = statistics::CentralInterval(values, 0.95);
  return {low, high};
}

std::vector<Shares> Bootstrap(const Expansion& expansion, const Eigen::VectorXd& y, size_t axes,
                              const SensitivityOptions& options) {
  std::mt19937_64 random(options.seed);
  std::vector<Shares> shares;
  for (int b = 0; b < options.bootstraps; ++b) {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(y.size());
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      weights[static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(y.size()))] += 1.0;
    }
    shares.push_back(SharesOf(expansion, Weighted(expansion.design, y, weights), axes));
  }
  return shares;
}

std::vector<SobolIndex> IndicesOf(const SweepResult& result, const Expansion& expansion,
                                  const Eigen::VectorXd& y, const SensitivityOptions& options) {
  const size_t axes = result.parameters.size();
  const Shares fitted = SharesOf(expansion, expansion.design.colPivHouseholderQr().solve(y), axes);
  const std::vector<Shares> drawn = Bootstrap(expansion, y, axes, options);
  std::vector<SobolIndex> indices;
  for (size_t axis = 0; axis < axes; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    std::vector<double> first, total;
    for (const Shares& shares : drawn) {
      first.push_back(shares.first[at]);
      total.push_back(shares.total[at]);
    }
    SobolIndex index{.parameter = result.parameters[axis].Name(), .index = static_cast<int>(axis)};
    index.first = fitted.first[at];
    index.total = fitted.total[at];
    std::tie(index.first_low, index.first_high) = Middle95(first);
    std::tie(index.total_low, index.total_high) = Middle95(total);
    indices.push_back(index);
  }
  std::stable_sort(indices.begin(), indices.end(),
                   [](const auto& a, const auto& b) { return a.total > b.total; });
  return indices;
}

}  // namespace

Sensitivity EstimateSensitivity(const SweepResult& result, const SensitivityOptions& options) {
  Sensitivity sensitivity;
  const bool has_range =
      std::any_of(result.parameters.begin(), result.parameters.end(),
                  [](const experiment::Parameter& parameter) { return parameter.IsContinuous(); });
  if (!has_range) return sensitivity;
  std::vector<Axis> axes;
  for (const experiment::Parameter& parameter : result.parameters) axes.emplace_back(parameter);
  const Data data = Pick(result, options.most_trials);
  sensitivity.trials = static_cast<int>(data.rows.size());
  if (sensitivity.trials < 4) {
    sensitivity.note = "too few trials with a gap to tell what matters";
    return sensitivity;
  }
  const Expansion best = BestExpansion(data, axes, options);
  if (best.degree == 0) {
    sensitivity.note = "the gap does not vary, or there are fewer than 3 trials for each parameter";
    return sensitivity;
  }
  sensitivity.q2 = best.q2;
  sensitivity.degree = best.degree;
  sensitivity.indices = IndicesOf(result, best, data.gaps_m, options);
  sensitivity.note = fmt::format(
      "from a polynomial of degree {} through {} trials, which predicts {:.0f} % of the variance "
      "of "
      "a trial left out{}",
      best.degree, sensitivity.trials, 100.0 * std::max(0.0, best.q2),
      best.q2 < kTrustedQ2 ? "; with so little, the shares say what it saw and not what is" : "");
  return sensitivity;
}

}  // namespace rift::sweep
