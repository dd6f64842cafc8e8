#include "feature_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "rift/statistics/descriptive.hpp"

namespace rift::sweep {
namespace {

using Eigen::Index;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Drives beyond these shares of the simulated ones, and half the distance of the quartiles more,
/// count as at that limit: means of a few logs are not for outliers.
constexpr double kTail = 0.01;
/// No simulator's mean is nearer than this to the robot's, in scatters of one drive.
constexpr double kModelError = 0.1;
/// Dozens of features of a few logs: their correlations are those of the drives, weakened.
constexpr double kCorrelation = 0.6;
constexpr double kSlopeRidge = 0.5, kSquareRidge = 4.0;
constexpr double kNoScatter = 1e-12;
constexpr size_t kFewestLogs = 4;  ///< whose own scatter is looked at

/// Of each row z: 1, z and the squares of z.
Eigen::MatrixXd BasisOf(const Eigen::MatrixXd& draws) {
  Eigen::MatrixXd basis(draws.rows(), FeatureModel::Coefficients(draws.cols()));
  basis << Eigen::VectorXd::Ones(draws.rows()), draws, draws.cwiseAbs2();
  return basis;
}

Eigen::VectorXd BasisAt(const Eigen::VectorXd& z) { return BasisOf(z.transpose()).transpose(); }

/// Of least squares with a ridge, so that squares have to be seen to count.
Eigen::MatrixXd NormalMatrix(const Eigen::MatrixXd& basis) {
  const Index parameters = (basis.cols() - 1) / 2;
  Eigen::MatrixXd normal = basis.transpose() * basis;
  normal.diagonal().segment(1, parameters).array() += kSlopeRidge;
  normal.diagonal().tail(parameters).array() += kSquareRidge;
  return normal;
}

Eigen::MatrixXd Regressed(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& values) {
  return NormalMatrix(basis).ldlt().solve(basis.transpose() * values);
}

/// d basis / dz: parameters x coefficients.
Eigen::MatrixXd SlopeOfBasisAt(const Eigen::VectorXd& z) {
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(z.size(), FeatureModel::Coefficients(z.size()));
  slope.middleCols(1, z.size()).setIdentity();
  slope.rightCols(z.size()) = (2.0 * z).asDiagonal();
  return slope;
}

/// Covariance of regressed coefficients, features weighted and summed; `left`: what the regression
/// leaves, draws x features. Draws that share their noise scatter together (Liang and Zeger 1986).
Eigen::MatrixXd NoiseOfSlopes(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& left,
                              const Eigen::MatrixXd& weights, Index alike) {
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(basis.cols(), basis.cols());
  for (Index first = 0; first < basis.rows(); first += alike) {
    const Index count = std::min(alike, basis.rows() - first);
    const Eigen::MatrixXd own =
        basis.middleRows(first, count).transpose() * left.middleRows(first, count);
    scatter += own * weights * own.transpose();
  }
  const auto normal = NormalMatrix(basis).ldlt();
  const Eigen::MatrixXd half = normal.solve(scatter);
  const auto draws = static_cast<double>(basis.rows());
  return draws / std::max(1.0, draws - static_cast<double>(basis.cols())) *
         normal.solve(half.transpose());
}

/// Where the coefficients of some of the parameters stand among those of all.
std::vector<Index> PlacesOf(const std::vector<Index>& some, Index all) {
  std::vector<Index> places{0};
  for (const Index k : some) places.push_back(1 + k);
  for (const Index k : some) places.push_back(1 + all + k);
  return places;
}

std::vector<double> KnownOf(const auto& values) {
  std::vector<double> known;
  for (const double value : values) {
    if (!std::isnan(value)) known.push_back(value);
  }
  return known;
}

/// Column by column over what is known; NaN for a column that is not.
Eigen::VectorXd MeanOfKnown(const Eigen::MatrixXd& rows) {
  Eigen::VectorXd mean(rows.cols());
  for (Index k = 0; k < rows.cols(); ++k) {
    const std::vector<double> known = KnownOf(rows.col(k));
    mean[k] = known.empty() ? kNone : statistics::Mean(known);
  }
  return mean;
}

Eigen::MatrixXd ZeroWhereUnknown(const Eigen::MatrixXd& rows) {
  return rows.unaryExpr([](double value) { return std::isnan(value) ? 0.0 : value; });
}

/// Of each feature, beyond which a drive is an outlier.
std::pair<Eigen::VectorXd, Eigen::VectorXd> LimitsOf(const Eigen::MatrixXd& drives) {
  Eigen::VectorXd low = Eigen::VectorXd::Zero(drives.cols()), high = low;
  for (Index k = 0; k < drives.cols(); ++k) {
    const std::vector<double> known = KnownOf(drives.col(k));
    if (known.empty()) continue;
    const double beyond =
        0.5 * (statistics::Quantile(known, 0.75) - statistics::Quantile(known, 0.25));
    low[k] = statistics::Quantile(known, kTail) - beyond;
    high[k] = statistics::Quantile(known, 1.0 - kTail) + beyond;
  }
  return {low, high};
}

/// Of drives that are stacked draw by draw, `logs` of each.
Eigen::MatrixXd MeansOfLogs(const Eigen::MatrixXd& drives, Index logs) {
  Eigen::MatrixXd means(logs, drives.cols());
  for (Index log = 0; log < logs; ++log) {
    const auto own = Eigen::seqN(log, drives.rows() / logs, logs);
    means.row(log) = MeanOfKnown(drives(own, Eigen::all));
  }
  return means;
}

/// Which features both sides tell, and the inverse covariance of the mean of the logs there.
/// `real_off`: the logs; `scattered`: what the regression leaves of the drives.
std::pair<std::vector<Index>, Eigen::MatrixXd> ToldAndWeights(const Eigen::MatrixXd& real_off,
                                                              const Eigen::MatrixXd& scattered) {
  std::vector<Index> told;
  std::vector<double> logs, deviations;
  for (Index k = 0; k < real_off.cols(); ++k) {
    const std::vector<double> of_logs = KnownOf(real_off.col(k)),
                              of_drives = KnownOf(scattered.col(k));
    double deviation = statistics::RootMeanSquare(of_drives);
    if (of_logs.size() >= kFewestLogs) {
      deviation = std::max(deviation, statistics::StandardDeviation(of_logs));
    }
    if (of_logs.empty() || of_drives.size() < 2 || !(deviation > kNoScatter)) continue;
    told.push_back(k);
    logs.push_back(static_cast<double>(of_logs.size()));
    deviations.push_back(deviation);
  }
  const Eigen::MatrixXd known = ZeroWhereUnknown(scattered(Eigen::all, told));
  const Eigen::MatrixXd products = known.transpose() * known;
  Eigen::MatrixXd covariance(products.rows(), products.cols());
  for (Index a = 0; a < covariance.rows(); ++a) {
    for (Index b = 0; b < covariance.cols(); ++b) {
      const double scale = std::sqrt(products(a, a) * products(b, b));
      const double correlation = a == b        ? 1.0
                                 : scale > 0.0 ? kCorrelation * products(a, b) / scale
                                               : 0.0;
      covariance(a, b) = correlation * deviations[a] * deviations[b] / std::sqrt(logs[a] * logs[b]);
    }
    covariance(a, a) += std::pow(kModelError * deviations[a], 2);
  }
  return {told,
          covariance.ldlt().solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()))};
}

/// Rows of the same drives one below the other.
Eigen::MatrixXd Stacked(const std::vector<FeatureRows>& driven, const std::vector<Index>& logs) {
  const auto count = static_cast<Index>(logs.size());
  Eigen::MatrixXd all(count * static_cast<Index>(driven.size()), driven.front().rows.cols());
  for (size_t i = 0; i < driven.size(); ++i) {
    all.middleRows(static_cast<Index>(i) * count, count) = driven[i].rows(logs, Eigen::all);
  }
  return all;
}

}  // namespace

FeatureModel::FeatureModel(const std::vector<std::string>& group_of_log,
                           const Eigen::MatrixXd& real, const Eigen::MatrixXd& draws,
                           const Acts& acts, const std::vector<FeatureRows>& driven,
                           double failures, int alike)
    : failures_(failures),
      slope_noise_(Eigen::MatrixXd::Zero(Coefficients(draws.cols()), Coefficients(draws.cols()))) {
  for (Index k = 0; k < real.cols(); ++k) {
    const auto is_above_zero = [k](const Eigen::MatrixXd& rows) {
      return std::all_of(rows.col(k).begin(), rows.col(k).end(),
                         [](double value) { return std::isnan(value) || value > 0.0; });
    };
    is_positive_.push_back(is_above_zero(real) &&
                           std::all_of(driven.begin(), driven.end(), [&](const FeatureRows& one) {
                             return is_above_zero(one.rows);
                           }));
  }
  std::map<std::string, std::vector<Index>> logs_of;
  for (size_t i = 0; i < group_of_log.size(); ++i) {
    logs_of[group_of_log[i]].push_back(static_cast<Index>(i));
  }
  for (auto& [name, logs] : logs_of) {
    groups_.push_back(GroupOf(std::move(logs), real, draws, acts, driven, alike));
    slope_noise_ += groups_.back().slope_noise;
  }
}

/// Logarithms where they are, within the limits of the group where it has them.
Eigen::MatrixXd FeatureModel::Kept(const Group& group, const Eigen::MatrixXd& rows) const {
  Eigen::MatrixXd kept = rows;
  for (Index k = 0; k < kept.cols(); ++k) {
    for (double& value : kept.col(k)) {
      if (is_positive_[static_cast<size_t>(k)]) value = std::log(value);
      if (group.low.size() == 0 || std::isnan(value)) continue;
      value = std::clamp(value, group.low[k], group.high[k]);
    }
  }
  return kept;
}

FeatureModel::Group FeatureModel::GroupOf(std::vector<Index> logs, const Eigen::MatrixXd& real,
                                          const Eigen::MatrixXd& draws, const Acts& acts,
                                          const std::vector<FeatureRows>& driven, int alike) const {
  Group group{.logs = std::move(logs)};
  const auto count = static_cast<Index>(group.logs.size());
  const Eigen::MatrixXd stacked = Stacked(driven, group.logs);
  std::tie(group.low, group.high) = LimitsOf(Kept(group, stacked));
  // Each log has a mean of its own; what is regressed is how its drives differ from that.
  Eigen::MatrixXd drives = Kept(group, stacked);
  group.log_mean = MeansOfLogs(drives, count);
  drives -= group.log_mean.replicate(draws.rows(), 1);
  const Eigen::MatrixXd real_off = Kept(group, real(group.logs, Eigen::all)) - group.log_mean;

  Eigen::MatrixXd mean_of_draw(draws.rows(), real.cols());
  Eigen::VectorXd failing(draws.rows());
  for (Index draw = 0; draw < draws.rows(); ++draw) {
    mean_of_draw.row(draw) = MeanOfKnown(drives.middleRows(draw * count, count));
    failing[draw] = driven[static_cast<size_t>(draw)].has_failed(group.logs).mean();
  }
  std::vector<Index> acting;
  for (Index k = 0; k < draws.cols(); ++k) {
    if (acts(group.logs, k).any()) acting.push_back(k);
  }
  const std::vector<Index> places = PlacesOf(acting, draws.cols());
  const Eigen::MatrixXd basis = BasisOf(draws(Eigen::all, acting));
  group.failing = Eigen::VectorXd::Zero(Coefficients(draws.cols()));
  group.failing(places) = Regressed(basis, failing);
  // A draw at which no log tells a feature has the mean of all.
  const Eigen::MatrixXd own_slopes = Regressed(basis, ZeroWhereUnknown(mean_of_draw));
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(Coefficients(draws.cols()), real.cols());
  slopes(places, Eigen::all) = own_slopes;
  const Eigen::MatrixXd regressed = basis * own_slopes;
  for (Index draw = 0; draw < draws.rows(); ++draw) {
    drives.middleRows(draw * count, count).rowwise() -= regressed.row(draw);
  }
  std::tie(group.told, group.weights) = ToldAndWeights(real_off, drives);
  const Eigen::MatrixXd left =
      ZeroWhereUnknown(mean_of_draw)(Eigen::all, group.told) - regressed(Eigen::all, group.told);
  group.slope_noise = Eigen::MatrixXd::Zero(Coefficients(draws.cols()), Coefficients(draws.cols()));
  group.slope_noise(places, places) = NoiseOfSlopes(basis, left, group.weights, alike);
  group.slopes = slopes(Eigen::all, group.told);
  group.real_off = MeanOfKnown(real_off(Eigen::all, group.told));
  return group;
}

FeatureModel::Expansion FeatureModel::At(const Eigen::VectorXd& z) const {
  const Eigen::VectorXd basis = BasisAt(z);
  const Eigen::MatrixXd slope_of_basis = SlopeOfBasisAt(z);
  Expansion at{.loss = -basis.dot(slope_noise_ * basis),
               .gradient = -2.0 * slope_of_basis * (slope_noise_ * basis),
               .hessian = Eigen::MatrixXd::Zero(z.size(), z.size())};
  for (const Group& group : groups_) {
    const Eigen::VectorXd error = group.slopes.transpose() * basis - group.real_off;
    const Eigen::MatrixXd slope = slope_of_basis * group.slopes;
    at.loss += error.dot(group.weights * error);
    at.gradient += 2.0 * slope * (group.weights * error);
    at.hessian += 2.0 * slope * group.weights * slope.transpose();
    // -2 log (1 - p) of each log, for small p.
    const double share = group.failing.dot(basis);
    if (share <= 0.0) continue;
    const double weight = FailureWeight(group);
    at.loss += weight * share;
    at.gradient += weight * slope_of_basis * group.failing;
  }
  return at;
}

Eigen::MatrixXd FeatureModel::InformationAt(const Eigen::VectorXd& z) const {
  const Eigen::MatrixXd slope_of_basis = SlopeOfBasisAt(z);
  const Eigen::MatrixXd information =
      0.5 * At(z).hessian - slope_of_basis * slope_noise_ * slope_of_basis.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
         solver.eigenvectors().transpose();
}

Eigen::MatrixXd FeatureModel::ScoreCovarianceAt(const Eigen::VectorXd& z) const {
  const Eigen::VectorXd basis = BasisAt(z);
  const Eigen::MatrixXd slope_of_basis = SlopeOfBasisAt(z);
  Eigen::MatrixXd covariance = InformationAt(z);
  for (const Group& group : groups_) {
    if (group.told.empty()) continue;
    const Eigen::MatrixXd slope = slope_of_basis * group.slopes;
    const Eigen::VectorXd error = group.slopes.transpose() * basis - group.real_off;
    // Half the gradient is slope * weights * error, and regressed slopes are in both factors. The
    // drives' mean at a draw scatters as the real logs' does.
    const Eigen::MatrixXd noise = group.slope_noise / static_cast<double>(group.told.size());
    covariance += basis.dot(noise * basis) * slope * group.weights * slope.transpose();
    covariance +=
        error.dot(group.weights * error) * slope_of_basis * noise * slope_of_basis.transpose();
  }
  return covariance;
}

double FeatureModel::LossOf(const std::vector<FeatureRows>& driven) const {
  double loss = 0.0;
  for (const Group& group : groups_) {
    const auto count = static_cast<Index>(group.logs.size());
    Eigen::MatrixXd off = Kept(group, Stacked(driven, group.logs));
    double failing = 0.0;
    for (size_t i = 0; i < driven.size(); ++i) {
      off.middleRows(static_cast<Index>(i) * count, count) -= group.log_mean;
      failing += driven[i].has_failed(group.logs).mean() / static_cast<double>(driven.size());
    }
    const Eigen::VectorXd reach = (group.high - group.low)(group.told);
    Eigen::VectorXd error = MeanOfKnown(off(Eigen::all, group.told)) - group.real_off;
    error = error.array().isNaN().select(reach, error);
    loss += error.dot(group.weights * error) + FailureWeight(group) * failing;
  }
  return loss;
}

double FeatureModel::FailingShareAt(const Eigen::VectorXd& z) const {
  double failing = 0.0, logs = 0.0;
  for (const Group& group : groups_) {
    const auto count = static_cast<double>(group.logs.size());
    failing += count * std::max(0.0, group.failing.dot(BasisAt(z)));
    logs += count;
  }
  return failing / logs;
}

size_t FeatureModel::FeatureCount() const {
  size_t count = 0;
  for (const Group& group : groups_) count += group.told.size();
  return count;
}

}  // namespace rift::sweep
