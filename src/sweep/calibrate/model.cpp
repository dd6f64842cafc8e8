#include "model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "fitted_simulator.hpp"
#include "rift/statistics/random.hpp"
#include "rift/sweep/calibrate/likeness.hpp"

namespace rift::sweep {
namespace {

// Whole runs of a delayed bang-bang loop are chaotic: over a small step the scatter of their traits
// is many times their slope.
constexpr double kStepOfRuns = 0.2;
constexpr double kLeastStep = 1e-3;  // where the domain leaves no room for a longer one
// Of the seeds of a log its own runs are the first ones, and those that judge the ones from 50,000
// on.
constexpr std::uint64_t kSeedsOfTry = 1'000;
constexpr std::uint64_t kSeedsOfRepeat = 20'000;
constexpr auto kRepeatsBetweenLogs = static_cast<int>(kSeedsOfLog / kSeedsOfRepeat) - 1;
constexpr std::uint64_t kSeedsOfFurtherRepeats = 2000 * kSeedsOfLog;  // beyond those of all logs

constexpr std::uint64_t kMiddleStream = 112;
constexpr int kTried = 32;       // places; the mean of those within is the middle
constexpr int kBisections = 24;  // to 1e-7 of a range

}  // namespace

Domain::Domain(Contained contained, const Eigen::VectorXd& start)
    : contained_(std::move(contained)), middle_(start) {
  if (!contained_) return;
  const statistics::CounterRandom random(1, kMiddleStream);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(start.size());
  int found = 0;
  for (int i = 0; i < kTried; ++i) {
    Eigen::VectorXd shares(start.size());
    for (Eigen::Index k = 0; k < shares.size(); ++k) {
      shares[k] = random.Uniform(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(k));
    }
    if (!Contains(shares)) continue;
    sum += shares;
    ++found;
  }
  if (found > 0 && Contains(sum / found)) middle_ = sum / found;
}

Eigen::VectorXd Domain::Nearest(const Eigen::VectorXd& shares) const {
  if (Contains(shares)) return shares;
  double within = 0.0, beyond = 1.0;
  for (int i = 0; i < kBisections; ++i) {
    const double share = 0.5 * (within + beyond);
    (Contains(middle_ + share * (shares - middle_)) ? within : beyond) = share;
  }
  return middle_ + within * (shares - middle_);
}

std::uint64_t SeedInPlace(std::uint64_t first, int repeat, int attempt) {
  const auto place = static_cast<std::uint64_t>(repeat % kRepeatsBetweenLogs + 1);
  const auto block = static_cast<std::uint64_t>(repeat / kRepeatsBetweenLogs);
  return first + place * kSeedsOfRepeat + block * kSeedsOfFurtherRepeats +
         static_cast<std::uint64_t>(attempt) * kSeedsOfTry;
}

trajectory::Trajectory RunWithin(double longest_m, SimulatedTrial twin, int repeat) {
  const std::uint64_t first = twin.seed;
  trial::TrialResult run;
  for (int i = 0; i < kMostTries; ++i) {
    twin.seed = SeedInPlace(first, repeat, i);
    run = Simulate(twin).result;
    const bool has_arrived = run.outcome == trial::Outcome::kReached;
    if (has_arrived && LengthByStrides_m(run.trajectory) <= longest_m) break;
  }
  return std::move(run.trajectory);
}

std::vector<double> ValuesAt(const std::vector<experiment::FreeParameter>& parameters,
                             const Eigen::VectorXd& shares) {
  std::vector<double> values;
  for (size_t i = 0; i < parameters.size(); ++i) {
    const experiment::FreeParameter& p = parameters[i];
    values.push_back(p.min + shares[static_cast<Eigen::Index>(i)] * (p.max - p.min));
  }
  return values;
}

Prior PriorOf(const std::vector<experiment::FreeParameter>& parameters) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  Prior prior{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const experiment::FreeParameter& p = parameters[static_cast<size_t>(k)];
    if (p.prior_sd == 0.0) continue;
    const double width = p.max - p.min;
    prior.mean[k] = (p.prior_mean - p.min) / width;
    prior.weight[k] = (width / p.prior_sd) * (width / p.prior_sd);
  }
  return prior;
}

double SquaredSum(const Blocks& blocks) {
  double sum = 0.0;
  for (const Eigen::VectorXd& block : blocks) sum += block.squaredNorm();
  return sum;
}

size_t Count(const Blocks& blocks) {
  size_t count = 0;
  for (const Eigen::VectorXd& block : blocks) count += static_cast<size_t>(block.size());
  return count;
}

double RidgeOf(const Eigen::MatrixXd& hessian) {
  constexpr double kRidge = 1e-9;
  return kRidge + kRidge * hessian.diagonal().maxCoeff();
}

Eigen::VectorXd StepWithin(const Eigen::VectorXd& at, const Eigen::VectorXd& low,
                           const Eigen::VectorXd& high, const Eigen::MatrixXd& hessian,
                           const Eigen::VectorXd& gradient, double damping) {
  Eigen::MatrixXd matrix = hessian;
  matrix.diagonal() *= 1.0 + damping;
  matrix.diagonal().array() += RidgeOf(hessian);
  Eigen::VectorXd slope = gradient;
  for (Eigen::Index k = 0; k < slope.size(); ++k) {
    const bool is_stopped =
        (at[k] <= low[k] && slope[k] > 0.0) || (at[k] >= high[k] && slope[k] < 0.0);
    if (!is_stopped) continue;
    matrix.row(k).setZero();
    matrix.col(k).setZero();
    matrix(k, k) = 1.0;
    slope[k] = 0.0;
  }
  return -matrix.ldlt().solve(slope);
}

ErrorModel::ErrorModel(const std::vector<experiment::FreeParameter>& parameters,
                       std::vector<CalibrationLog> logs, FittedSimulator& simulator,
                       const CalibrationOptions& options, const Eigen::VectorXd& start,
                       Domain domain)
    : parameters_(parameters),
      logs_(std::move(logs)),
      simulator_(simulator),
      options_(options),
      domain_(std::move(domain)),
      traits_(TraitsOfLogs(logs_, simulator, ValuesAt(parameters, start))) {}

ErrorModel ErrorModel::OfSimulatedLogs(const Eigen::VectorXd& shares, int repeat) const {
  std::vector<CalibrationLog> logs;
  std::vector<trajectory::Trajectory> runs =
      simulator_.LogsAt(logs_, ValuesAt(parameters_, shares), repeat);
  for (size_t i = 0; i < logs_.size(); ++i) {
    logs.push_back({logs_[i].name, logs_[i].setting, std::move(runs[i])});
    logs.back().drives_grid_fps = logs_[i].drives_grid_fps;
    if (logs_[i].began_s) logs.back().began_s = 0.0;  // a simulated clock begins with the trial
  }
  ErrorModel model(parameters_, std::move(logs), simulator_, options_, shares, domain_);
  model.traits_.scatter = traits_.scatter;
  model.traits_.spread_scatter = traits_.spread_scatter;
  return model;
}

std::vector<LogErrors> ErrorModel::Errors(const Eigen::VectorXd& shares,
                                          const CalibrationOptions& options) {
  trials_simulated_ += logs_.size() * static_cast<size_t>(options.horizon.phases + options.runs);
  return sweep::ErrorsAt(logs_, traits_, simulator_, ValuesAt(parameters_, shares), options);
}

std::vector<LogErrors> ErrorModel::RawErrorsAt(const Eigen::VectorXd& shares) {
  return Errors(shares, options_);
}

Blocks ErrorModel::ErrorsAt(const Eigen::VectorXd& shares, const Eigen::MatrixXd& scale) {
  return WeightedAt(shares, scale, options_);
}

Blocks ErrorModel::WeightedBlocks(const std::vector<LogErrors>& raw,
                                  const Eigen::MatrixXd& scale) const {
  Blocks blocks;
  for (const LogErrors& errors : raw) blocks.push_back(Weighted(errors, scale, options_));
  return blocks;
}

Blocks ErrorModel::WeightedAt(const Eigen::VectorXd& shares, const Eigen::MatrixXd& scale,
                              const CalibrationOptions& options) {
  return WeightedBlocks(Errors(shares, options), scale);
}

/// Of every error of each log, by central differences, one-sided at a bound and at the end of the
/// domain, over shorter steps where it is narrow; none where nothing can be moved.
Blocks ErrorModel::Slope(const Eigen::VectorXd& shares, const std::vector<LogErrors>& raw,
                         const Eigen::MatrixXd& scale, Eigen::Index parameter, double step,
                         const CalibrationOptions& options) {
  Eigen::VectorXd below = shares, above = shares;
  for (; below == above && step >= kLeastStep; step *= 0.5) {
    below[parameter] = std::max(0.0, shares[parameter] - step);
    above[parameter] = std::min(1.0, shares[parameter] + step);
    if (!domain_.Contains(below)) below = shares;
    if (!domain_.Contains(above)) above = shares;
  }
  std::vector<LogErrors> slopes = Errors(above, options);
  const std::vector<LogErrors> at_below = Errors(below, options);
  const double way = below == above ? 1.0 : above[parameter] - below[parameter];
  Blocks weighted;
  for (size_t i = 0; i < slopes.size(); ++i) {
    if (!simulator_.HasWholeRunsOnly()) {
      // A motion that leaps over the step is an outlier, and no slope.
      weighted.push_back(
          (Weighted(slopes[i], scale, options) - Weighted(at_below[i], scale, options)) / way);
      continue;
    }
    // A step may change whole runs by many times their scatter: cut at outliers the ends would say
    // that they hardly change.
    slopes[i].motions = (slopes[i].motions - at_below[i].motions) / way;
    slopes[i].traits = (slopes[i].traits - at_below[i].traits) / way;
    weighted.push_back(WeightedSlope(raw[i], slopes[i], scale, options));
  }
  return weighted;
}

Linearised ErrorModel::LinearisedAt(const Eigen::VectorXd& shares,
                                    const std::vector<LogErrors>& raw, const Eigen::MatrixXd& scale,
                                    double step) {
  CalibrationOptions motions_only = options_, runs_mostly = options_;
  const bool has_wide_slopes = options_.runs > 0 && !simulator_.HasWholeRunsOnly();
  if (has_wide_slopes) motions_only.runs = 0;
  runs_mostly.horizon.phases = 1;
  Linearised at{.errors = WeightedBlocks(raw, scale)};
  std::vector<Eigen::MatrixXd> slopes;
  for (const Eigen::VectorXd& block : at.errors) {
    slopes.push_back(Eigen::MatrixXd::Zero(block.size(), shares.size()));
  }
  for (Eigen::Index k = 0; k < shares.size(); ++k) {
    const Blocks near = Slope(shares, raw, scale, k, step, motions_only);
    for (size_t i = 0; i < slopes.size(); ++i) slopes[i].col(k) = near[i];
    if (!has_wide_slopes) continue;
    const Blocks wide = Slope(shares, raw, scale, k, std::max(step, kStepOfRuns), runs_mostly);
    for (size_t i = 0; i < slopes.size(); ++i) {
      slopes[i].col(k).tail(kTraits + 1) = wide[i].tail(kTraits + 1);
    }
  }
  for (size_t i = 0; i < slopes.size(); ++i) {
    at.hessians.push_back(slopes[i].transpose() * slopes[i]);
    at.gradients.push_back(slopes[i].transpose() * at.errors[i]);
  }
  return at;
}

}  // namespace rift::sweep
