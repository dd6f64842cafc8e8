#include "errors.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <stdexcept>

#include "rift/gap/likeness.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/trial/loop_delay.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// The published gaps leave the first tenth out; jitter of a standing robot would count as spread.
gap::GapOptions SpreadGap() {
  gap::GapOptions options;
  options.skip_start = 0.1;
  return options;
}

/// None for a path too short to tell them.
Traits TraitsOf(const Trajectory& path, const SimulatedTrial& twin) {
  try {
    const gap::PathTraits shape = gap::TraitsOf(path, {});
    const trial::LoopDelay delay =
        trial::EstimateLoopDelay(path, twin.task.waypoints, twin.control);
    const Eigen::Vector4d traits(std::log(shape.weave_m), std::log(shape.speed_mps), delay.lag_s,
                                 delay.gain_rad_s);
    if (delay.lag_s >= 0.0 && traits.allFinite()) return traits;
  } catch (const std::invalid_argument&) {
    // It did not drive, or hardly: it has no traits, and the motions still count.
  }
  return {};
}

double LogSpread(const Trajectory& a, const Trajectory& b) {
  return std::log(std::max(1e-4, gap::Gap(a, b, SpreadGap())));
}

double Scatter(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  const double deviation = statistics::StandardDeviation(values);
  return deviation > 0.0 ? deviation : 1.0;
}

/// Whole runs of one log that reached the end.
std::vector<Trajectory> RunsOf(SimulatedTrial twin, int runs) {
  std::vector<Trajectory> paths;
  for (int i = 0; i < runs; ++i, ++twin.seed) {
    SimulatedRun run = Simulate(twin);
    if (run.result.outcome == trial::Outcome::kReached) {
      paths.push_back(std::move(run.result.trajectory));
    }
  }
  return paths;
}

struct Raw {
  LogErrors errors;
  std::vector<Trajectory> runs;
};

Raw Evaluate(const CalibrationLog& log, const Traits& logged, const LoggedTraits& all,
             const SimulatedTrial& twin, const CalibrationOptions& options) {
  Raw raw;
  const std::vector<HorizonError> motions = ShortHorizonErrors(twin, log.log, options.horizon);
  raw.errors.motions.resize(3 * static_cast<Eigen::Index>(motions.size()));
  for (size_t i = 0; i < motions.size(); ++i) {
    raw.errors.motions.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        Eigen::Vector3d(motions[i].ahead_m, motions[i].left_m, motions[i].turned_rad);
    raw.errors.frames.push_back(motions[i].frames);
  }
  raw.errors.traits = Eigen::VectorXd::Zero(kTraits + 1);
  raw.runs = RunsOf(twin, options.runs);
  if (!logged) return raw;
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  int told = 0;
  for (const Trajectory& run : raw.runs) {
    const Traits traits = TraitsOf(run, twin);
    if (traits) mean += *traits, ++told;
  }
  if (told > 0) {
    raw.errors.traits.head<4>() = (mean / told - *logged).cwiseQuotient(all.scatter);
  }
  return raw;
}

/// Evaluates every log; which thread does it changes nothing.
std::vector<Raw> EvaluateAll(const std::vector<CalibrationLog>& logs, const LoggedTraits& traits,
                             const TwinAt& twin, const std::vector<double>& values,
                             const CalibrationOptions& options, int threads) {
  std::vector<Raw> raws(logs.size());
  const auto work = [&](size_t first) {
    for (size_t i = first; i < logs.size(); i += static_cast<size_t>(threads)) {
      raws[i] = Evaluate(logs[i], traits.of_log[i], traits, twin(i, values), options);
    }
  };
  std::vector<std::future<void>> workers;
  for (int i = 1; i < threads; ++i) {
    workers.push_back(std::async(std::launch::async, work, static_cast<size_t>(i)));
  }
  work(0);
  for (std::future<void>& worker : workers) worker.get();
  return raws;
}

double SpreadError(const Raw& a, const Raw& b, double logged, double scatter) {
  double sum = 0.0;
  const size_t runs = std::min(a.runs.size(), b.runs.size());
  for (size_t i = 0; i < runs; ++i) sum += LogSpread(a.runs[i], b.runs[i]) - logged;
  return runs > 0 ? sum / static_cast<double>(runs) / scatter : 0.0;
}

double Huber(double error, double outlier) {
  const double size = std::abs(error);
  if (size <= outlier) return error;
  // Its square is Huber's linear loss.
  return std::copysign(std::sqrt(outlier * (2.0 * size - outlier)), error);
}

}  // namespace

LoggedTraits TraitsOfLogs(const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                          const std::vector<double>& values) {
  LoggedTraits traits;
  std::vector<std::vector<double>> columns(kTraits);
  for (size_t i = 0; i < logs.size(); ++i) {
    traits.of_log.push_back(TraitsOf(logs[i].log, twin(i, values)));
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
                                const TwinAt& twin, const std::vector<double>& values,
                                const CalibrationOptions& options, int threads) {
  std::vector<Raw> raws = EvaluateAll(logs, traits, twin, values, options, threads);
  std::vector<LogErrors> errors;
  for (size_t i = 0; i < raws.size(); ++i) {
    if (traits.partner[i] >= 0) {
      raws[i].errors.traits[kTraits] = SpreadError(raws[i], raws[traits.partner[i]],
                                                   traits.log_spread[i], traits.spread_scatter);
    }
  }
  for (Raw& raw : raws) errors.push_back(std::move(raw.errors));
  return errors;
}

Eigen::MatrixXd ScaleOf(const std::vector<LogErrors>& errors, const CalibrationOptions& options) {
  Eigen::MatrixXd scale = Eigen::MatrixXd::Ones(options.horizon.most_frames, 3);
  for (int frames = 1; frames <= options.horizon.most_frames; ++frames) {
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<double> sizes;
      for (const LogErrors& log : errors) {
        for (size_t i = 0; i < log.frames.size(); ++i) {
          if (log.frames[i] != frames) continue;
          sizes.push_back(std::abs(log.motions[3 * static_cast<Eigen::Index>(i) + channel]));
        }
      }
      if (sizes.empty()) continue;
      scale(frames - 1, channel) = std::max(
          1e-9, statistics::kSigmaOfMedianDeviation * statistics::Median(std::move(sizes)));
    }
  }
  return scale;
}

Eigen::VectorXd Weighted(const LogErrors& errors, const Eigen::MatrixXd& scale,
                         const CalibrationOptions& options) {
  const Eigen::Index motions = errors.motions.size();
  Eigen::VectorXd weighted(motions + errors.traits.size());
  // Motions over 1 to n frames from one row share their frames: together they count once.
  const double share = 1.0 / std::sqrt(static_cast<double>(options.horizon.most_frames));
  for (Eigen::Index i = 0; i < motions; ++i) {
    const int frames = errors.frames[static_cast<size_t>(i / 3)];
    weighted[i] = share * Huber(errors.motions[i] / scale(frames - 1, i % 3), options.outlier_sd);
  }
  for (Eigen::Index i = 0; i < errors.traits.size(); ++i) {
    weighted[motions + i] =
        std::sqrt(options.likeness_weight) * Huber(errors.traits[i], options.outlier_sd);
  }
  return weighted;
}

}  // namespace rift::sweep
