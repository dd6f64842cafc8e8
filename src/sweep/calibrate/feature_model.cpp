#include "feature_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
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
constexpr size_t kFewestLogs = 4;  ///< whose own scatter is looked at

/// 1, z and the squares of z.
Eigen::VectorXd BasisAt(const Eigen::VectorXd& z) {
  Eigen::VectorXd basis(1 + 2 * z.size());
  basis << 1.0, z, z.cwiseAbs2();
  return basis;
}

Eigen::MatrixXd BasisOf(const Eigen::MatrixXd& draws) {
  Eigen::MatrixXd basis(draws.rows(), 1 + 2 * draws.cols());
  basis << Eigen::VectorXd::Ones(draws.rows()), draws, draws.cwiseAbs2();
  return basis;
}

/// Least squares with a ridge, so that squares have to be seen to count.
Eigen::MatrixXd Regressed(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& values) {
  const Index parameters = (basis.cols() - 1) / 2;
  Eigen::MatrixXd normal = basis.transpose() * basis;
  normal.diagonal().segment(1, parameters).array() += kSlopeRidge;
  normal.diagonal().tail(parameters).array() += kSquareRidge;
  return normal.ldlt().solve(basis.transpose() * values);
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
                           const std::vector<FeatureRows>& driven, double failures)
    : failures_(failures) {
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
    groups_.push_back(GroupOf(std::move(logs), real, draws, driven));
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
                                          const Eigen::MatrixXd& draws,
                                          const std::vector<FeatureRows>& driven) const {
  Group group{.logs = std::move(logs)};
  const auto count = static_cast<Index>(group.logs.size());
  const auto draw_count = static_cast<Index>(driven.size());
  const Index features = real.cols();

  Eigen::MatrixXd all = Kept(group, Stacked(driven, group.logs));
  group.low = group.high = Eigen::VectorXd::Zero(features);
  for (Index k = 0; k < features; ++k) {
    const std::vector<double> known = KnownOf(all.col(k));
    if (known.empty()) continue;
    const double beyond =
        0.5 * (statistics::Quantile(known, 0.75) - statistics::Quantile(known, 0.25));
    group.low[k] = statistics::Quantile(known, kTail) - beyond;
    group.high[k] = statistics::Quantile(known, 1.0 - kTail) + beyond;
  }
  all = Kept(group, Stacked(driven, group.logs));

  // Each log has a mean of its own; what is regressed is how its drives differ from that.
  group.log_mean.resize(count, features);
  for (Index log = 0; log < count; ++log) {
    const auto own = Eigen::seqN(log, draw_count, count);
    group.log_mean.row(log) = MeanOfKnown(all(own, Eigen::all));
    for (Index draw = 0; draw < draw_count; ++draw) {
      all.row(draw * count + log) -= group.log_mean.row(log);
    }
  }
  const Eigen::MatrixXd real_off = Kept(group, real(group.logs, Eigen::all)) - group.log_mean;
  Eigen::MatrixXd mean_of_draw(draw_count, features);
  Eigen::VectorXd failing(draw_count);
  for (Index draw = 0; draw < draw_count; ++draw) {
    mean_of_draw.row(draw) = MeanOfKnown(all.middleRows(draw * count, count));
    failing[draw] = driven[static_cast<size_t>(draw)].has_failed(group.logs).mean();
  }
  const Eigen::MatrixXd basis = BasisOf(draws);
  group.failing = Regressed(basis, failing);

  const Eigen::MatrixXd slopes = Regressed(basis, mean_of_draw.unaryExpr([](double value) {
    return std::isnan(value) ? 0.0 : value;  // no log told it at this draw: the mean of all
  }));
  const Eigen::MatrixXd regressed = basis * slopes;
  Eigen::MatrixXd scattered = all;
  for (Index draw = 0; draw < draw_count; ++draw) {
    scattered.middleRows(draw * count, count).rowwise() -= regressed.row(draw);
  }
  std::vector<double> told_logs, deviations;
  for (Index k = 0; k < features; ++k) {
    const std::vector<double> of_logs = KnownOf(real_off.col(k)),
                              of_drives = KnownOf(scattered.col(k));
    double deviation = statistics::RootMeanSquare(of_drives);
    if (of_logs.size() >= kFewestLogs) {
      deviation = std::max(deviation, statistics::StandardDeviation(of_logs));
    }
    if (of_logs.empty() || of_drives.size() < 2 || !(deviation > 1e-12)) continue;
    group.told.push_back(k);
    told_logs.push_back(static_cast<double>(of_logs.size()));
    deviations.push_back(deviation);
  }
  const auto told = static_cast<Index>(group.told.size());
  group.slopes = slopes(Eigen::all, group.told);
  group.real_off = MeanOfKnown(real_off(Eigen::all, group.told));
  const Eigen::MatrixXd known = scattered(Eigen::all, group.told).unaryExpr([](double value) {
    return std::isnan(value) ? 0.0 : value;
  });
  const Eigen::MatrixXd products = known.transpose() * known;
  Eigen::MatrixXd covariance(told, told);
  for (Index a = 0; a < told; ++a) {
    for (Index b = 0; b < told; ++b) {
      const double correlation =
          a == b ? 1.0 : kCorrelation * products(a, b) / std::sqrt(products(a, a) * products(b, b));
      covariance(a, b) =
          correlation * deviations[a] * deviations[b] / std::sqrt(told_logs[a] * told_logs[b]);
    }
    covariance(a, a) += std::pow(kModelError * deviations[a], 2);
  }
  group.weights = covariance.ldlt().solve(Eigen::MatrixXd::Identity(told, told));
  return group;
}

FeatureModel::Expansion FeatureModel::At(const Eigen::VectorXd& z) const {
  Expansion at{.gradient = Eigen::VectorXd::Zero(z.size()),
               .hessian = Eigen::MatrixXd::Zero(z.size(), z.size())};
  const Eigen::VectorXd basis = BasisAt(z);
  for (const Group& group : groups_) {
    const Eigen::VectorXd error = group.slopes.transpose() * basis - group.real_off;
    Eigen::MatrixXd slope = group.slopes.middleRows(1, z.size());
    slope += (2.0 * z).asDiagonal() * group.slopes.bottomRows(z.size());
    at.loss += error.dot(group.weights * error);
    at.gradient += 2.0 * slope * (group.weights * error);
    at.hessian += 2.0 * slope * group.weights * slope.transpose();
    // -2 log (1 - p) of each log, for small p.
    const double share = group.failing.dot(basis);
    if (share <= 0.0) continue;
    const double weight = FailureWeight(group);
    at.loss += weight * share;
    at.gradient += weight * (group.failing.segment(1, z.size()) +
                             2.0 * z.cwiseProduct(group.failing.tail(z.size())));
  }
  return at;
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
    const Eigen::VectorXd error =
        MeanOfKnown(off(Eigen::all, group.told)).unaryExpr([](double value) {
          return std::isnan(value) ? 0.0 : value;
        }) -
        group.real_off;
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
