#include "expansion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "first_rows.hpp"
#include "rift/statistics/sample.hpp"
#include "rift/sweep/falsify/distinct_rows.hpp"

namespace rift::sweep {
namespace {

/// A model with curves or interactions needs so many trials for each of its columns.
constexpr double kTrialsPerTerm = 2.0;
/// A plain model may have more columns than one with interactions: one for each value of a list.
constexpr size_t kMostPlainTerms = 300;
constexpr double kFewestResidualDf = 2.0;

/// Functions of one axis, orthonormal when its values are even: normalised Legendre polynomials of
/// a range, contrasts between the values of a list that were tried.
class Axis {
 public:
  Axis(const experiment::Parameter& parameter, int index, const Observations& data)
      : parameter_(parameter) {
    if (parameter_.IsContinuous()) return;
    std::set<experiment::ParameterValue> seen;
    for (const TrialRow* row : data.rows) seen.insert(row->theta[index]);
    levels_.assign(seen.begin(), seen.end());
    MakeContrasts();
  }

  /// Orders above this do not exist.
  int MostOrder() const {
    return parameter_.IsContinuous() ? 64 : static_cast<int>(levels_.size()) - 1;
  }
  /// How much of the total degree a function uses up: all contrasts of a list are of the first.
  int DegreeOf(int order) const { return parameter_.IsContinuous() ? order : std::min(order, 1); }

  double Value(int order, const experiment::ParameterValue& value) const {
    if (parameter_.IsContinuous()) return Legendre(order, *value.number);
    const auto found = std::lower_bound(levels_.begin(), levels_.end(), value);
    return contrasts_(found - levels_.begin(), order);
  }

 private:
  double Legendre(int order, double x) const {
    double t = 2.0 * (x - parameter_.min) / (parameter_.max - parameter_.min) - 1.0;
    if (parameter_.is_logarithmic) {
      t = 2.0 * std::log(x / parameter_.min) / std::log(parameter_.max / parameter_.min) - 1.0;
    }
    return std::sqrt(2.0 * order + 1.0) *
           std::legendre(static_cast<unsigned>(order), std::clamp(t, -1.0, 1.0));
  }

  /// An orthogonal matrix whose first column is constant, scaled to mean squares of one.
  void MakeContrasts() {
    const auto n = static_cast<Eigen::Index>(levels_.size());
    Eigen::MatrixXd columns = Eigen::MatrixXd::Identity(n, n);
    columns.col(0).setOnes();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
    contrasts_ = qr.householderQ() * Eigen::MatrixXd::Identity(n, n);
    contrasts_ *= std::sqrt(static_cast<double>(n));
  }

  const experiment::Parameter& parameter_;
  std::vector<experiment::ParameterValue> levels_;  ///< sorted
  Eigen::MatrixXd contrasts_;
};

/// Every combination of orders up to a total degree, but no more than one beyond `most`.
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
}

Eigen::MatrixXd DesignOf(const Observations& data, const std::vector<Axis>& axes,
                         const std::vector<Orders>& terms) {
  Eigen::MatrixXd design(data.losses_m.size(), static_cast<Eigen::Index>(terms.size()));
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const experiment::Theta& theta = data.rows[static_cast<size_t>(i)]->theta;
    for (Eigen::Index j = 0; j < design.cols(); ++j) {
      const Orders& orders = terms[static_cast<size_t>(j)];
      double value = 1.0;
      for (size_t axis = 0; axis < axes.size(); ++axis) {
        if (orders[axis] > 0) {
          value *= axes[axis].Value(orders[axis], theta[data.parameters[axis]]);
        }
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

bool SeveralSettingsTell(const SweepResult& result) {
  return std::count_if(result.settings.begin(), result.settings.end(),
                       [](const auto& setting) { return setting.verdict.repeats > 0; }) > 1;
}

}  // namespace

Observations Observe(const SweepResult& result, int most) {
  const FirstRows first = FirstOfEachSetting(result, RowsThatCount(result));
  Observations data{.most_of_setting = first.most_of_setting};
  for (const size_t i : statistics::SampleInOrder(first.rows.size(), static_cast<size_t>(most))) {
    data.rows.push_back(&result.rows[first.rows[i]]);
  }
  data.losses_m.resize(static_cast<Eigen::Index>(data.rows.size()));
  for (size_t i = 0; i < data.rows.size(); ++i) {
    data.losses_m[static_cast<Eigen::Index>(i)] = Loss_m(*data.rows[i], result.gap.threshold_m);
  }
  for (int i = 0; i < static_cast<int>(result.parameters.size()); ++i) {
    const bool is_varied = std::any_of(data.rows.begin(), data.rows.end(), [&](const auto* row) {
      return row->theta[i] != data.rows.front()->theta[i];
    });
    if (is_varied) data.parameters.push_back(i);
  }
  data.are_same_runs = !data.rows.empty() && data.parameters.empty() && SeveralSettingsTell(result);
  return data;
}

Expansion BestExpansion(const SweepResult& result, const Observations& data,
                        const ExpansionLimits& limits) {
  std::vector<Axis> axes;
  for (const int i : data.parameters) axes.emplace_back(result.parameters[i], i, data);
  const auto trials = static_cast<double>(data.rows.size());
  const auto plain = static_cast<size_t>(std::max(0.0, trials - kFewestResidualDf));
  Expansion best;
  for (int degree = 1; degree <= limits.most_degree; ++degree) {
    const size_t most =
        degree == 1
            ? std::min(kMostPlainTerms, plain)
            : static_cast<size_t>(std::min<double>(limits.most_terms, trials / kTrialsPerTerm));
    Expansion next{.degree = degree};
    Orders orders(axes.size(), 0);
    AddOrders(axes, degree, most, orders, 0, next.terms);
    if (next.terms.size() > most) break;
    next.design = DesignOf(data, axes, next.terms);
    next.predicted = LeaveOneOut(next.design, data.losses_m);
    if (degree == 1 || next.predicted > best.predicted) best = std::move(next);
  }
  return best;
}

Regression::Regression(const Expansion& expansion, const Eigen::VectorXd& losses_m)
    : terms_(expansion.terms) {
  const Eigen::VectorXd y = losses_m.array() - losses_m.mean();
  xx_ = expansion.design.transpose() * expansion.design;
  xy_ = expansion.design.transpose() * y;
  total_ = y.squaredNorm();
}

Regression::Fit Regression::With(const std::function<bool(const Orders&)>& is_wanted) const {
  std::vector<int> columns;
  for (size_t i = 0; i < terms_.size(); ++i) {
    const bool is_constant =
        std::all_of(terms_[i].begin(), terms_[i].end(), [](int order) { return order == 0; });
    if (is_constant || is_wanted(terms_[i])) columns.push_back(static_cast<int>(i));
  }
  const Eigen::MatrixXd xx = xx_(columns, columns);
  const Eigen::VectorXd xy = xy_(columns);
  // Combinations that were never tried cost rank, not sense.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(xx);
  const double least = 1e-10 * solver.eigenvalues().maxCoeff();
  const Eigen::VectorXd along = solver.eigenvectors().transpose() * xy;
  Fit fit{total_, 0.0};
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    if (solver.eigenvalues()[i] <= least) continue;
    fit.sse -= along[i] * along[i] / solver.eigenvalues()[i];
    fit.rank += 1.0;
  }
  const bool is_exact = fit.sse < 1e-12 * total_;  // rounding of the normal equations
  if (is_exact) fit.sse = 0.0;
  return fit;
}

}  // namespace rift::sweep
