#include "feature_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "feature_model.hpp"
#include "model.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/statistics/random.hpp"

namespace rift::sweep {
namespace {

using Eigen::Index;

constexpr std::uint64_t kDrawStream = 111;
constexpr int kPair = 2;
constexpr double kFarthest = 2.0;  // draws and estimates of a round, in scatters
/// Scatter of the first draws and the limits of later ones, as shares of the ranges.
constexpr double kFirstScatter = 0.15, kLeastScatter = 0.02, kMostScatter = 0.3;
/// Draws reach as far as the estimate is uncertain, twice: slopes over less are noise.
constexpr double kReach = 2.0;
/// 1 / sd^2 of an even spread over a range about its end.
constexpr double kUntold = 3.0;
/// Of a range, for whether a parameter changes anything.
constexpr double kTriedStep = 0.1, kLeastTriedStep = 1e-3;
constexpr int kMostSteps = 200;
constexpr double kConverged = 1e-6;
constexpr double kRounding = 1e-9;
constexpr double kLargestDamping = 1e9;
/// Drives of each log behind the losses.
constexpr int kJudgeRuns = 8;

/// One region of values, about a centre in shares of the ranges.
class Region {
 public:
  Region(Eigen::VectorXd centre, Eigen::VectorXd scatter, const Prior& prior)
      : centre_(std::move(centre)), scatter_(std::move(scatter)), prior_(prior) {}

  /// Pairs on both sides of the centre (antithetic: what two drives of the same noise share is in
  /// no slope), as far as ranges allow: a draw beyond a bound is one at it.
  Eigen::MatrixXd Drawn(int draws, statistics::Random& random) const {
    Eigen::MatrixXd z(draws, centre_.size());
    for (Index i = 0; i < z.rows(); ++i) {
      for (Index k = 0; k < z.cols(); ++k)
        z(i, k) = i % kPair == 0 ? random.Normal() : -z(i - 1, k);
    }
    return z.cwiseMax(Low().transpose().replicate(draws, 1))
        .cwiseMin(High().transpose().replicate(draws, 1));
  }
  Eigen::VectorXd SharesAt(const Eigen::VectorXd& z) const {
    return (centre_ + scatter_.cwiseProduct(z)).cwiseMax(0.0).cwiseMin(1.0);
  }
  /// z, or the nearest one to it whose shares are in the domain.
  Eigen::VectorXd Within(const Domain& domain, const Eigen::VectorXd& z) const {
    const Eigen::VectorXd shares = SharesAt(z);
    if (domain.Contains(shares)) return z;
    return (domain.Nearest(shares) - centre_).cwiseQuotient(scatter_);
  }
  Eigen::VectorXd Least(const FeatureModel& model) const;
  /// Covariance of the shares about z (sandwich: White 1982), of what scatters the estimate.
  Eigen::MatrixXd CovarianceAt(const FeatureModel& model, const Eigen::VectorXd& z) const {
    Eigen::VectorXd known = scatter_.cwiseAbs2().cwiseProduct(prior_.weight);
    // A parameter that nothing tells is as uncertain as its range is wide.
    known += kUntold * scatter_.cwiseAbs2();
    Eigen::MatrixXd precision = model.InformationAt(z), score = model.ScoreCovarianceAt(z);
    precision.diagonal() += known;
    score.diagonal() += known;
    const auto solver = precision.ldlt();
    const Eigen::MatrixXd half = scatter_.asDiagonal() * solver.solve(score);
    const Eigen::MatrixXd covariance = half * solver.solve(scatter_.asDiagonal().toDenseMatrix());
    return 0.5 * (covariance + covariance.transpose());  // one number on both sides of the diagonal
  }

 private:
  Eigen::VectorXd Low() const { return (-centre_).cwiseQuotient(scatter_).cwiseMax(-kFarthest); }
  Eigen::VectorXd High() const {
    return (1.0 - centre_.array()).matrix().cwiseQuotient(scatter_).cwiseMin(kFarthest);
  }
  FeatureModel::Expansion WithPrior(const FeatureModel& model, const Eigen::VectorXd& z) const {
    FeatureModel::Expansion at = model.At(z);
    const Eigen::VectorXd shares = centre_ + scatter_.cwiseProduct(z);
    at.loss += prior_.LossAt(shares);
    at.gradient += 2.0 * scatter_.cwiseProduct(prior_.GradientAt(shares));
    at.hessian +=
        2.0 * scatter_.cwiseAbs2().cwiseProduct(prior_.weight).asDiagonal().toDenseMatrix();
    return at;
  }

  Eigen::VectorXd centre_, scatter_;
  const Prior& prior_;
};

/// Levenberg and Marquardt within the region; what a bound stops is left alone.
Eigen::VectorXd Region::Least(const FeatureModel& model) const {
  const Eigen::VectorXd low = Low(), high = High();
  Eigen::VectorXd z = Eigen::VectorXd::Zero(centre_.size());
  FeatureModel::Expansion at = WithPrior(model, z);
  double damping = 1e-2;
  for (int i = 0; i < kMostSteps && damping < kLargestDamping; ++i) {
    const Eigen::VectorXd tried = (z + StepWithin(z, low, high, at.hessian, at.gradient, damping))
                                      .cwiseMax(low)
                                      .cwiseMin(high);
    const FeatureModel::Expansion there = WithPrior(model, tried);
    if (there.loss >= at.loss) {
      damping *= 10.0;
      continue;
    }
    const double moved = (tried - z).cwiseAbs().maxCoeff();
    z = tried, at = there;
    damping = std::max(1e-6, 0.1 * damping);
    if (moved < kConverged) break;
  }
  return z;
}

/// The parameters that change anything, in shares of their ranges; the others stay where they are.
class Active {
 public:
  explicit Active(const Calibration& found) {
    all_.resize(static_cast<Index>(found.parameters.size()));
    start_ = all_;
    for (const CalibratedParameter& one : found.parameters) {
      const experiment::FreeParameter& p = one.parameter;
      const auto k = static_cast<Index>(parameters_.size());
      all_[k] = (one.value - p.min) / (p.max - p.min);
      start_[k] = (p.start - p.min) / (p.max - p.min);
      if (one.has_effect) places_.push_back(k);
      parameters_.push_back(p);
    }
    const Prior all = PriorOf(parameters_);
    prior_ = {all.mean(places_), all.weight(places_)};
  }

  const std::vector<Index>& Places() const { return places_; }
  Eigen::VectorXd Found() const { return all_(places_); }
  Eigen::VectorXd Start() const { return start_(places_); }
  const Prior& PriorOfThem() const { return prior_; }
  /// Of all parameters.
  std::vector<double> Values(const Eigen::VectorXd& shares) const {
    Eigen::VectorXd all = all_;
    all(places_) = shares;
    return ValuesAt(parameters_, all);
  }
  /// `most_likely`: of the normal posterior, in shares. An interval ends with the range.
  void Tell(const Eigen::VectorXd& most_likely, const Eigen::VectorXd& mean,
            const Eigen::MatrixXd& covariance, const CalibrationOptions& options,
            Calibration& found) const;

 private:
  std::vector<experiment::FreeParameter> parameters_;
  std::vector<Index> places_;
  Eigen::VectorXd all_, start_;
  Prior prior_;
};

void Active::Tell(const Eigen::VectorXd& most_likely, const Eigen::VectorXd& mean,
                  const Eigen::MatrixXd& covariance, const CalibrationOptions& options,
                  Calibration& found) const {
  const double deviations = statistics::NormalQuantile(0.5 + 0.5 * options.confidence);
  const Eigen::VectorXd sd = covariance.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation = covariance.cwiseQuotient(sd * sd.transpose());
  found.correlation.setConstant(std::numeric_limits<double>::quiet_NaN());
  found.correlation(places_, places_) = correlation;
  for (size_t i = 0; i < places_.size(); ++i) {
    const auto k = static_cast<Index>(i);
    CalibratedParameter& one = found.parameters[static_cast<size_t>(places_[i])];
    const double min = one.parameter.min, width = one.parameter.max - min;
    const double reach = deviations * sd[k];
    one.value = min + mean[k] * width;
    one.low = min + std::max(0.0, most_likely[k] - reach) * width;
    one.high = min + std::min(1.0, most_likely[k] + reach) * width;
    one.is_at_bound = most_likely[k] <= kRounding || most_likely[k] >= 1.0 - kRounding;
    one.is_identified = reach <= options.identified_share;
    // The posterior's weight is the sum of both.
    one.is_from_prior = prior_.weight[k] > 0.5 / (sd[k] * sd[k]);
  }
}

/// Of the parameters that change anything, the others staying where they are.
Domain DomainOf(const Active& active, const IsAllowed& is_allowed) {
  if (!is_allowed) return Domain();
  return Domain([&](const Eigen::VectorXd& shares) { return is_allowed(active.Values(shares)); },
                active.Found());
}

/// Of each parameter, where its range cuts the posterior off: near a bound the most likely value
/// hangs on chance far more than the mean does.
Eigen::VectorXd MeansWithinRanges(const Eigen::VectorXd& most_likely,
                                  const Eigen::MatrixXd& covariance) {
  Eigen::VectorXd means = most_likely;
  for (Index k = 0; k < means.size(); ++k) {
    means[k] =
        statistics::MeanOfNormalWithin(most_likely[k], std::sqrt(covariance(k, k)), 0.0, 1.0);
  }
  return means;
}

bool IsSame(const trajectory::Trajectory& a, const trajectory::Trajectory& b) {
  return std::equal(a.poses.begin(), a.poses.end(), b.poses.begin(), b.poses.end(),
                    [](const auto& one, const auto& other) {
                      return one.t_s == other.t_s && one.Planar() == other.Planar();
                    });
}

/// A value of the parameter to the other side, or nearer, that is allowed; else its own.
double OtherSide(std::vector<double> values, size_t k, const CalibratedParameter& one,
                 const IsAllowed& is_allowed) {
  const double width = one.parameter.max - one.parameter.min;
  double step = kTriedStep;
  while (step > kLeastTriedStep) {
    for (const double moved : {one.value - step * width, one.value + step * width}) {
      values[k] = moved;
      const bool is_in_range = moved >= one.parameter.min && moved <= one.parameter.max;
      if (is_in_range && is_allowed(values)) return moved;
    }
    step *= 0.5;
  }
  return one.value;
}

/// Logs x parameters: whether it changes a drive of the log. Motions do not see all that whole
/// drives do, such as the tracker's scatter.
FeatureModel::Acts FindEffects(const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                               const IsAllowed& is_allowed, Calibration& found) {
  std::vector<double> values;
  for (const CalibratedParameter& one : found.parameters) values.push_back(one.value);
  FeatureModel::Acts acts(static_cast<Index>(logs.size()), static_cast<Index>(values.size()));
  for (size_t i = 0; i < logs.size(); ++i) {
    const SimulatedRun run = Simulate(twin(i, values));
    for (size_t k = 0; k < values.size(); ++k) {
      CalibratedParameter& one = found.parameters[k];
      const double width = one.parameter.max - one.parameter.min;
      const bool is_low = one.value < one.parameter.min + 0.5 * width;
      std::vector<double> moved = values;
      moved[k] += (is_low ? kTriedStep : -kTriedStep) * width;
      if (is_allowed && !is_allowed(moved)) moved[k] = OtherSide(values, k, one, is_allowed);
      const bool acts_here =
          !IsSame(run.result.trajectory, Simulate(twin(i, moved)).result.trajectory);
      acts(static_cast<Index>(i), static_cast<Index>(k)) = acts_here;
      one.has_effect = one.has_effect || acts_here;
    }
    found.trials_simulated += 1 + values.size();
  }
  return acts;
}

/// Draws that are as many as the coefficients are met exactly, and what they scatter by looks like
/// what the logs tell.
void CheckDraws(const FeatureFitOptions& options, Index parameters) {
  const auto least = 2 * FeatureModel::Coefficients(parameters);
  if (options.draws >= least) return;
  throw std::invalid_argument(fmt::format(
      "calibrate.method.features.draws is {}, and {} parameters that act need {} or more",
      options.draws, parameters, least));
}

/// Logs x features of the logs themselves.
Eigen::MatrixXd RealRows(const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                         const std::vector<double>& values) {
  Eigen::MatrixXd rows;
  for (size_t i = 0; i < logs.size(); ++i) {
    const Eigen::VectorXd row = FeatureRow(logs[i].log, twin(i, values));
    if (i == 0) rows.resize(static_cast<Index>(logs.size()), row.size());
    rows.row(static_cast<Index>(i)) = row;
  }
  return rows;
}

/// Standard error of how the losses of these drives differ: jackknife over the drives of a log.
double NoiseOfDifference(const FeatureModel& model, const std::vector<FeatureRows>& before,
                         const std::vector<FeatureRows>& after) {
  std::vector<double> differences;
  for (size_t left_out = 0; left_out < before.size(); ++left_out) {
    std::vector<FeatureRows> fewer_before = before, fewer_after = after;
    fewer_before.erase(fewer_before.begin() + static_cast<std::ptrdiff_t>(left_out));
    fewer_after.erase(fewer_after.begin() + static_cast<std::ptrdiff_t>(left_out));
    differences.push_back(model.LossOf(fewer_after) - model.LossOf(fewer_before));
  }
  return static_cast<double>(differences.size() - 1) * statistics::StandardDeviation(differences) /
         std::sqrt(static_cast<double>(differences.size()));
}

}  // namespace

void FitFeatures(const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                 const CalibrationOptions& options, std::uint64_t seed, int threads,
                 const CalibrationStep& on_step, Calibration& found, const IsAllowed& is_allowed) {
  const FeatureModel::Acts all_acts = FindEffects(logs, twin, is_allowed, found);
  const Active active(found);
  const FeatureModel::Acts acts = all_acts(Eigen::all, active.Places());
  const Prior& prior = active.PriorOfThem();
  Eigen::VectorXd shares = active.Found();
  if (shares.size() == 0) return;
  const Domain domain = DomainOf(active, is_allowed);
  const Eigen::VectorXd start = domain.Nearest(active.Start());
  CheckDraws(options.features, shares.size());
  std::vector<std::string> group_of_log;
  for (const CalibrationLog& log : logs) group_of_log.push_back(log.group);
  const Eigen::MatrixXd real = RealRows(logs, twin, active.Values(shares));
  const auto drive = [&](const std::vector<std::vector<double>>& values, int round, int alike) {
    found.trials_simulated += values.size() * logs.size();
    return DriveAt(values, logs, twin, static_cast<std::uint64_t>(round), alike, threads);
  };
  statistics::Random random(seed, kDrawStream);
  Eigen::VectorXd scatter = Eigen::VectorXd::Constant(shares.size(), kFirstScatter);
  for (int round = 0; round < options.features.rounds; ++round) {
    const Region region(shares, scatter, prior);
    const bool is_last = round + 1 == options.features.rounds;
    Eigen::MatrixXd draws =
        region.Drawn(is_last ? std::max(options.features.draws, options.features.last_draws)
                             : options.features.draws,
                     random);
    std::vector<std::vector<double>> values;
    for (Index i = 0; i < draws.rows(); ++i) {
      draws.row(i) = region.Within(domain, draws.row(i)).transpose();
      values.push_back(active.Values(region.SharesAt(draws.row(i))));
    }
    const FeatureModel model(group_of_log, real, draws, acts, drive(values, round, kPair),
                             options.features.failures, kPair);
    const auto features = static_cast<double>(model.FeatureCount());
    const Eigen::VectorXd z = region.Within(domain, region.Least(model));
    shares = region.SharesAt(z);
    const Eigen::MatrixXd covariance = region.CovarianceAt(model, z);
    scatter = (kReach * covariance.diagonal().cwiseSqrt()).cwiseMax(kLeastScatter);
    scatter = scatter.cwiseMin(kMostScatter);
    found.has_converged = z.cwiseAbs().maxCoeff() < kFarthest;
    if (on_step) {
      on_step({.part = CalibrationProgress::Part::kFeatures,
               .step = round + 1,
               .most = options.features.rounds,
               .loss = model.At(z).loss / features,
               .values = active.Values(shares)});
    }
    if (!is_last) continue;
    const Eigen::VectorXd most_likely = shares;
    shares = domain.Nearest(MeansWithinRanges(most_likely, covariance));
    active.Tell(most_likely, shares, covariance, options, found);
    // With the same noise on both sides.
    const auto drive_often = [&](const Eigen::VectorXd& at) {
      const std::vector<std::vector<double>> repeated(kJudgeRuns, active.Values(at));
      return drive(repeated, options.features.rounds, 1);
    };
    const std::vector<FeatureRows> before = drive_often(start), after = drive_often(shares);
    found.loss_before = (model.LossOf(before) + prior.LossAt(start)) / features;
    found.loss_after = (model.LossOf(after) + prior.LossAt(shares)) / features;
    found.loss_noise = NoiseOfDifference(model, before, after) / features;
  }
}

}  // namespace rift::sweep
