#include "errors.hpp"

#include <algorithm>
#include <cmath>

#include "fitted_simulator.hpp"
#include "rift/gap/comparison.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// Of a log of which no run arrives, in its scatter: as far off as one log is from the next, so
/// that not arriving is no way to a smaller loss.
constexpr double kUntold = 1.0;

/// The published gaps leave the first tenth out; jitter of a standing robot would count as spread.
gap::GapOptions SpreadGap() {
  gap::GapOptions options;
  options.skip_start = 0.1;
  return options;
}

double LogSpread(const Trajectory& a, const Trajectory& b) {
  return std::log(std::max(1e-4, gap::Gap(a, b, SpreadGap())));
}

/// One where it is not known how the values scatter: of one alone, and of logs that are alike to
/// the micrometre that logs are written to, as no two drives are.
double Scatter(std::vector<double> values) {
  constexpr double kLeast = 1e-4;  // of a logarithm, in s, in rad/s
  std::erase_if(values, [](double value) { return std::isnan(value); });
  const double deviation = statistics::StandardDeviation(values);
  return deviation > kLeast ? deviation : 1.0;
}

double SpreadError(const LogPrediction& a, const LogPrediction& b, double logged, double scatter) {
  double sum = 0.0;
  const size_t runs = std::min(a.runs.size(), b.runs.size());
  for (size_t i = 0; i < runs; ++i) sum += LogSpread(a.runs[i], b.runs[i]) - logged;
  return runs > 0 ? sum / static_cast<double>(runs) / scatter : kUntold;
}

double SlopeOfHuber(double error, double outlier) {
  const double size = std::abs(error);
  return size <= outlier ? 1.0 : std::sqrt(outlier / (2.0 * size - outlier));
}

/// What each error is divided by: its scale, its share of the motions of a row, its weight.
Eigen::VectorXd UnitsOf(const LogErrors& errors, const Eigen::MatrixXd& scale) {
  const Eigen::Index motions = errors.motions.size();
  Eigen::VectorXd units = Eigen::VectorXd::Ones(motions + errors.traits.size());
  for (Eigen::Index i = 0; i < motions; ++i) {
    units[i] = scale(errors.frames[static_cast<size_t>(i / 3)] - 1, i % 3);
  }
  return units;
}

Eigen::VectorXd WeightsOf(const LogErrors& errors, const CalibrationOptions& options) {
  const Eigen::Index motions = errors.motions.size();
  Eigen::VectorXd weights(motions + errors.traits.size());
  // Motions over 1 to n frames from one row share their frames: together they count once.
  weights.head(motions).setConstant(1.0 /
                                    std::sqrt(static_cast<double>(options.horizon.most_frames)));
  weights.tail(errors.traits.size()).setConstant(std::sqrt(options.likeness_weight));
  return weights;
}

/// Of all motions over so many frames.
std::vector<double> SizesOf(const std::vector<LogErrors>& errors, int frames, int channel) {
  std::vector<double> sizes;
  for (const LogErrors& log : errors) {
    for (size_t i = 0; i < log.frames.size(); ++i) {
      if (log.frames[i] != frames) continue;
      sizes.push_back(std::abs(log.motions[3 * static_cast<Eigen::Index>(i) + channel]));
    }
  }
  return sizes;
}

/// Of a density exp(-Huber^2 / 2): where the mean of z^2, beyond outliers of outlier z, is one.
double LikeliestScale(const std::vector<double>& sizes, double outlier) {
  constexpr int kMostSteps = 100;
  constexpr double kSettled = 1e-9;
  double scale = statistics::RootMeanSquare(sizes);
  for (int i = 0; i < kMostSteps && scale > 0.0; ++i) {
    double sum = 0.0;
    for (const double size : sizes) {
      const double z = size / scale;
      sum += std::min(z * z, outlier * z);
    }
    const double factor = std::sqrt(sum / static_cast<double>(sizes.size()));
    scale *= factor;
    if (std::abs(factor - 1.0) < kSettled) break;
  }
  return scale;
}

Eigen::VectorXd AllOf(const LogErrors& errors) {
  Eigen::VectorXd all(errors.motions.size() + errors.traits.size());
  all << errors.motions, errors.traits;
  return all;
}

}  // namespace

double Huber(double error, double outlier) {
  const double size = std::abs(error);
  if (size <= outlier) return error;
  return std::copysign(std::sqrt(outlier * (2.0 * size - outlier)), error);
}

Traits MeanTraits(const std::vector<Traits>& of_runs) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  int told = 0;
  for (const Traits& traits : of_runs) {
    if (traits) sum += *traits, ++told;
  }
  return told > 0 ? Traits(sum / told) : Traits();
}

LoggedTraits TraitsOfLogs(const std::vector<CalibrationLog>& logs, const FittedSimulator& simulator,
                          const std::vector<double>& values) {
  LoggedTraits traits;
  std::vector<std::vector<double>> columns(kTraits);
  for (size_t i = 0; i < logs.size(); ++i) {
    traits.of_log.push_back(simulator.TraitsOf(logs[i].log, i, values));
    for (int k = 0; k < kTraits && traits.of_log.back(); ++k) {
      columns[k].push_back((*traits.of_log.back())[k]);
    }
    traits.partner.push_back(-1);
    traits.log_spread.push_back(gap::kNotComputed);
    for (size_t j = 0; j < i; ++j) {
      if (logs[j].setting != logs[i].setting) continue;
      traits.partner.back() = static_cast<int>(j);
      traits.log_spread.back() = LogSpread(logs[j].log, logs[i].log);
    }
  }
  for (int k = 0; k < kTraits; ++k) traits.scatter[k] = Scatter(columns[k]);
  traits.spread_scatter = Scatter(traits.log_spread);
  return traits;
}

std::vector<LogErrors> ErrorsAt(const std::vector<CalibrationLog>& logs, const LoggedTraits& traits,
                                FittedSimulator& simulator, const std::vector<double>& values,
                                const CalibrationOptions& options) {
  std::vector<LogPrediction> predictions = simulator.Predict(logs, values, options);
  std::vector<LogErrors> errors;
  for (size_t i = 0; i < predictions.size(); ++i) {
    LogErrors& one = errors.emplace_back();
    one.traits = Eigen::VectorXd::Zero(kTraits + 1);
    const Traits &logged = traits.of_log[i], &mean = predictions[i].mean_traits;
    if (logged && mean) {
      one.traits.head<kTraits>() = (*mean - *logged).cwiseQuotient(traits.scatter);
    } else if (logged && options.runs > 0) {
      one.traits.head<kTraits>().setConstant(kUntold);
    }
    if (traits.partner[i] >= 0 && options.runs > 0) {
      one.traits[kTraits] = SpreadError(predictions[i], predictions[traits.partner[i]],
                                        traits.log_spread[i], traits.spread_scatter);
    }
  }
  for (size_t i = 0; i < predictions.size(); ++i) {
    errors[i].motions = std::move(predictions[i].motions);
    errors[i].frames = std::move(predictions[i].frames);
  }
  return errors;
}

Eigen::MatrixXd ScaleOf(const std::vector<LogErrors>& errors, const CalibrationOptions& options) {
  Eigen::MatrixXd scale = Eigen::MatrixXd::Ones(options.horizon.most_frames, 3);
  for (int frames = 1; frames <= options.horizon.most_frames; ++frames) {
    for (int channel = 0; channel < 3; ++channel) {
      const std::vector<double> sizes = SizesOf(errors, frames, channel);
      if (sizes.empty()) continue;
      scale(frames - 1, channel) = std::max(1e-9, LikeliestScale(sizes, options.outlier_sd));
    }
  }
  return scale;
}

double Deviance(const std::vector<LogErrors>& errors, const CalibrationOptions& options) {
  const Eigen::MatrixXd scale = ScaleOf(errors, options);
  const Eigen::MatrixXd log_scale = scale.array().log();
  double sum = 0.0, logarithms = 0.0;
  for (const LogErrors& log : errors) {
    sum += Weighted(log, scale, options).squaredNorm();
    for (const int frames : log.frames) logarithms += log_scale.row(frames - 1).sum();
  }
  return sum + 2.0 * logarithms / static_cast<double>(options.horizon.most_frames);
}

Eigen::VectorXd Weighted(const LogErrors& errors, const Eigen::MatrixXd& scale,
                         const CalibrationOptions& options) {
  const Eigen::VectorXd scaled = AllOf(errors).cwiseQuotient(UnitsOf(errors, scale));
  return WeightsOf(errors, options).cwiseProduct(scaled.unaryExpr([&](double error) {
    return Huber(error, options.outlier_sd);
  }));
}

Eigen::VectorXd WeightedSlope(const LogErrors& errors, const LogErrors& slope,
                              const Eigen::MatrixXd& scale, const CalibrationOptions& options) {
  const Eigen::VectorXd units = UnitsOf(errors, scale);
  const Eigen::VectorXd of_huber = AllOf(errors).cwiseQuotient(units).unaryExpr(
      [&](double error) { return SlopeOfHuber(error, options.outlier_sd); });
  return WeightsOf(errors, options)
      .cwiseProduct(of_huber)
      .cwiseProduct(AllOf(slope).cwiseQuotient(units));
}

}  // namespace rift::sweep
