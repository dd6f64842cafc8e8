#include "rift/sweep/calibrate/calibration.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "feature_fit.hpp"
#include "fitted_simulator.hpp"
#include "intervals.hpp"
#include "model.hpp"

namespace rift::sweep {
namespace {

constexpr double kConverged = 5e-3;  // of the range, for the largest change of a parameter
constexpr double kFirstDamping = 1e-2;
constexpr double kLargestDamping = 1e6;
constexpr std::array kSearchSpans{0.1, 0.05, 0.02};  // of the range
constexpr int kMostHalvings = 5;
constexpr double kTrusted = 2.0;  // a growth of the deviance by so many times what slopes say

Eigen::VectorXd SharesOfStart(const std::vector<experiment::FreeParameter>& parameters) {
  Eigen::VectorXd shares(static_cast<Eigen::Index>(parameters.size()));
  for (size_t i = 0; i < parameters.size(); ++i) {
    const experiment::FreeParameter& p = parameters[i];
    shares[static_cast<Eigen::Index>(i)] = (p.start - p.min) / (p.max - p.min);
  }
  return shares;
}

/// First down to the least errors, then on to where the errors are those of logs that the simulator
/// makes itself. Whole runs alone descend by their motions before their traits have a say: a path
/// and its mirror image weave alike.
class Fit {
 public:
  Fit(const std::vector<experiment::FreeParameter>& parameters,
      const std::vector<CalibrationLog>& logs, FittedSimulator& simulator,
      const CalibrationOptions& options, const Domain& domain)
      : parameters_(parameters),
        options_(options),
        has_whole_runs_only_(simulator.HasWholeRunsOnly()),
        domain_(domain),
        shares_(domain.Nearest(SharesOfStart(parameters))),
        prior_(PriorOf(parameters)),
        model_(parameters, logs, simulator, options_, shares_, domain),
        step_(std::max(options.step, options.first_step)) {}

  Calibration Run(std::mt19937_64& generator, const CalibrationStep& on_step);

 private:
  using Part = CalibrationProgress::Part;
  void Descend(Calibration& result, const CalibrationStep& on_step, Part part);
  void Search();
  void DescendByMotions(Calibration& result, const CalibrationStep& on_step);
  void Tell(const CalibrationStep& on_step, Part part, int step, int most) const;
  bool Improve(double deviance);
  void Correct();
  Eigen::VectorXd Trusted(Eigen::VectorXd step, double deviance);
  double DevianceOf(const std::vector<LogErrors>& raw, const Eigen::VectorXd& shares) const {
    return Deviance(raw, options_) + prior_.LossAt(shares);
  }
  double DevianceAt(const Eigen::VectorXd& shares) {
    return DevianceOf(model_.RawErrorsAt(shares), shares);
  }
  double LossAt(const Eigen::VectorXd& shares) {
    return SquaredSum(model_.ErrorsAt(shares, scale_)) + prior_.LossAt(shares);
  }
  Eigen::MatrixXd Hessian() const { return Sum(at_.hessians) + prior_.Hessian(); }
  Eigen::VectorXd Gradient() const { return Sum(at_.gradients) + prior_.GradientAt(shares_); }
  Eigen::VectorXd StepFor(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                          double damping) const;
  Eigen::VectorXd Within(const Eigen::VectorXd& shares) const {
    return domain_.Nearest(shares.cwiseMax(0.0).cwiseMin(1.0));
  }

  const std::vector<experiment::FreeParameter>& parameters_;
  CalibrationOptions options_;  ///< the model's as well
  bool has_whole_runs_only_;
  const Domain& domain_;
  Eigen::VectorXd shares_;
  Prior prior_;
  ErrorModel model_;
  double step_;
  double damping_ = kFirstDamping;
  Eigen::MatrixXd scale_;
  Linearised at_;                      ///< the logs at shares_
  std::vector<Linearised> simulated_;  ///< simulated logs where each correction set out from
  size_t trials_of_simulated_ = 0;
};

void Append(Linearised& logs, const Linearised& more) {
  logs.hessians.insert(logs.hessians.end(), more.hessians.begin(), more.hessians.end());
  logs.gradients.insert(logs.gradients.end(), more.gradients.begin(), more.gradients.end());
}

Eigen::VectorXd Fit::StepFor(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                             double damping) const {
  const Eigen::VectorXd low = Eigen::VectorXd::Zero(shares_.size());
  const Eigen::VectorXd high = Eigen::VectorXd::Ones(shares_.size());
  return StepWithin(shares_, low, high, hessian, gradient, damping);
}

void Fit::Tell(const CalibrationStep& on_step, Part part, int step, int most) const {
  if (!on_step) return;
  CalibrationProgress progress{.part = part, .step = step, .most = most};
  progress.loss = SquaredSum(at_.errors) / static_cast<double>(Count(at_.errors));
  for (size_t i = 0; i < parameters_.size(); ++i) {
    const experiment::FreeParameter& p = parameters_[i];
    progress.values.push_back(p.min + shares_[static_cast<Eigen::Index>(i)] * (p.max - p.min));
  }
  on_step(progress);
}

/// One step of Levenberg and Marquardt, damped until it helps; false when none does.
bool Fit::Improve(double deviance) {
  const Eigen::MatrixXd hessian = Hessian();
  const Eigen::VectorXd gradient = Gradient();
  for (; damping_ < kLargestDamping; damping_ *= 10.0) {
    const Eigen::VectorXd tried = Within(shares_ + StepFor(hessian, gradient, damping_));
    if ((tried - shares_).cwiseAbs().maxCoeff() < kConverged) return false;
    if (DevianceAt(tried) >= deviance) continue;
    shares_ = tried;
    damping_ = std::max(1e-4, 0.1 * damping_);
    return true;
  }
  return false;
}

/// The loss has leaps, as a command that just misses one look of the listener waits for the next:
/// slopes over long steps see past them, shorter ones tell the place.
void Fit::Descend(Calibration& result, const CalibrationStep& on_step, Part part) {
  result.has_converged = false;  // an earlier part may have
  const int first_step = result.steps;
  const int most_steps = result.steps + options_.iterations;
  while (result.steps < most_steps) {
    const std::vector<LogErrors> raw = model_.RawErrorsAt(shares_);
    scale_ = ScaleOf(raw, options_);
    at_ = model_.LinearisedAt(shares_, raw, scale_, step_);
    const bool helped = Improve(DevianceOf(raw, shares_));
    result.steps += helped;
    if (helped) {
      Tell(on_step, part, result.steps - first_step, options_.iterations);
      continue;
    }
    result.has_converged = step_ <= options_.step;
    if (result.has_converged) return;
    step_ = std::max(options_.step, 0.5 * step_);
    damping_ = kFirstDamping;
  }
}

/// Along one parameter after the other and along the axes of what the logs tell of them together,
/// over ever shorter spans, to where a parabola through three deviances is least: what a log tells
/// of a delay lies within the leaps that slopes have to see past.
void Fit::Search() {
  const Eigen::Index n = shares_.size();
  Eigen::MatrixXd ways(n, 2 * n);
  ways << Eigen::MatrixXd::Identity(n, n),
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Hessian()).eigenvectors();
  double least = DevianceAt(shares_);
  for (const double span : kSearchSpans) {
    for (const auto& way : ways.colwise()) {
      const auto along = [&](double by) { return Within(shares_ + by * way); };
      const double below = DevianceAt(along(-span)), above = DevianceAt(along(span));
      const double curvature = below + above - 2.0 * least;
      double by = below < above ? -span : span;
      if (curvature > 0.0) by = std::clamp(0.5 * span * (below - above) / curvature, -span, span);
      const Eigen::VectorXd tried = along(by);
      const double deviance = DevianceAt(tried);
      if (deviance >= least) continue;
      shares_ = tried;
      least = deviance;
    }
  }
}

void Fit::DescendByMotions(Calibration& result, const CalibrationStep& on_step) {
  const double likeness_weight = std::exchange(options_.likeness_weight, 0.0);
  Descend(result, on_step, Part::kMotions);
  options_.likeness_weight = likeness_weight;
  step_ = options_.step;
  damping_ = kFirstDamping;
}

/// Least errors are not at the truth: what the robot did went into the log, so its luck went into
/// the commands that are replayed. Logs of the simulator have the same bias, and there the truth is
/// known (indirect inference, Gourieroux, Monfort and Renault 1993).
void Fit::Correct() {
  const std::vector<LogErrors> raw = model_.RawErrorsAt(shares_);
  at_ = model_.LinearisedAt(shares_, raw, scale_, step_);
  // Few logs repeat more: what the simulated ones scatter by goes into the estimate.
  const int logs = static_cast<int>(model_.LogCount());
  const int repeats = (options_.simulated_logs + logs - 1) / logs;
  Linearised made;
  for (int i = 0; i < repeats; ++i) {
    ErrorModel model = model_.OfSimulatedLogs(shares_, i);
    Append(made, model.LinearisedAt(shares_, model.RawErrorsAt(shares_), scale_, step_));
    trials_of_simulated_ += model.TrialsSimulated();
  }
  Eigen::VectorXd gradient = Gradient();
  if (repeats > 0) {
    gradient -= Sum(made.gradients) / repeats;
    simulated_.push_back(std::move(made));
  }
  const Eigen::VectorXd step = StepFor(Hessian(), gradient, kFirstDamping);
  shares_ = Trusted(step.cwiseMax(-options_.first_step).cwiseMin(options_.first_step),
                    DevianceOf(raw, shares_));
}

/// As much of a step as errors follow their slopes for, which is none of it across a leap.
Eigen::VectorXd Fit::Trusted(Eigen::VectorXd step, double deviance) {
  const Eigen::MatrixXd hessian = Hessian();
  const Eigen::VectorXd slope = Gradient();
  for (int i = 0; i <= kMostHalvings; ++i, step *= 0.5) {
    const Eigen::VectorXd tried = Within(shares_ + step), by = tried - shares_;
    const double expected = std::max(0.0, 2.0 * slope.dot(by) + by.dot(hessian * by));
    if (DevianceAt(tried) - deviance <= kTrusted * expected) return tried;
  }
  return shares_;
}

Calibration Fit::Run(std::mt19937_64& generator, const CalibrationStep& on_step) {
  Calibration result;
  const Eigen::VectorXd start = shares_;
  if (has_whole_runs_only_) DescendByMotions(result, on_step);
  Descend(result, on_step, Part::kDescent);
  step_ = options_.step;
  if (result.has_converged && options_.runs == 0 && !has_whole_runs_only_) {
    Search();
    step_ = std::min(step_, kSearchSpans.back());  // there, slopes over longer steps say less
  }
  for (int i = 0; i < options_.corrections; ++i) {
    Correct();
    Tell(on_step, Part::kCorrection, i + 1, options_.corrections);
  }
  if (options_.corrections == 0) {
    at_ = model_.LinearisedAt(shares_, model_.RawErrorsAt(shares_), scale_, step_);
  }
  Judge(parameters_, options_, shares_, at_, simulated_, prior_, generator, result);
  const auto count = static_cast<double>(Count(at_.errors));
  result.loss_after = LossAt(shares_) / count;
  result.loss_before = LossAt(start) / count;
  result.trials_simulated = model_.TrialsSimulated() + trials_of_simulated_;
  return result;
}

void Check(const std::vector<experiment::FreeParameter>& parameters,
           const std::vector<CalibrationLog>& logs) {
  if (parameters.empty()) throw std::invalid_argument("a calibration needs a free parameter");
  if (logs.size() < 2) {
    throw std::invalid_argument(
        fmt::format("a calibration needs at least 2 logs, and there are {}", logs.size()));
  }
  for (const experiment::FreeParameter& p : parameters) {
    if (p.min < p.max && p.start >= p.min && p.start <= p.max) continue;
    throw std::invalid_argument(fmt::format(
        "{} starts at {}, but it must lie in its range [{}, {}]", p.key, p.start, p.min, p.max));
  }
}

}  // namespace

Calibration Calibrate(const std::vector<experiment::FreeParameter>& parameters,
                      const std::vector<CalibrationLog>& logs, FittedSimulator& simulator,
                      const CalibrationOptions& options, std::mt19937_64& generator,
                      const CalibrationStep& on_step, const IsAllowed& is_allowed) {
  Check(parameters, logs);
  Domain::Contained contained;
  if (is_allowed) {
    contained = [&](const Eigen::VectorXd& at) { return is_allowed(ValuesAt(parameters, at)); };
  }
  const Domain domain(contained, SharesOfStart(parameters));
  return Fit(parameters, logs, simulator, options, domain).Run(generator, on_step);
}

Calibration Calibrate(const std::vector<experiment::FreeParameter>& parameters,
                      const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                      const CalibrationOptions& options, std::mt19937_64& generator, int threads,
                      const CalibrationStep& on_step, const IsAllowed& is_allowed) {
  SimulatedTwins simulator(twin, threads);
  Calibration found =
      Calibrate(parameters, logs, simulator, options, generator, on_step, is_allowed);
  if (options.features.rounds > 0) {
    FitFeatures(logs, twin, options, generator(), threads, on_step, found, is_allowed);
  }
  return found;
}

std::vector<StartAgreement> AgreementOf(const std::vector<Calibration>& fits) {
  std::vector<StartAgreement> agreement;
  if (fits.size() < 2) return agreement;
  for (size_t k = 0; k < fits.front().parameters.size(); ++k) {
    StartAgreement& one = agreement.emplace_back();
    for (const Calibration& fit : fits) one.values.push_back(fit.parameters[k].value);
    const auto [least, most] = std::minmax_element(one.values.begin(), one.values.end());
    const CalibratedParameter& first = fits.front().parameters[k];
    one.difference = *most > *least ? (*most - *least) / (0.5 * (first.high - first.low)) : 0.0;
    one.agrees = one.difference <= StartAgreement::kAgreement;
  }
  return agreement;
}

}  // namespace rift::sweep
