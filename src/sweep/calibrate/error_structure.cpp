#include "rift/sweep/calibrate/error_structure.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "rift/geometry/pose2.hpp"

namespace rift::sweep {
namespace {

constexpr double kGrid_s = 0.01;
constexpr double kMostLag_s = 0.3;
constexpr double kLowest_hz = 0.2;
constexpr double kStep_hz = 0.05;

/// Yaw rates of both sides over the intervals of a log, evenly in time.
struct Rates {
  std::vector<double> simulated, logged;
};

Rates RatesOf(const std::vector<HorizonError>& errors, const trajectory::Trajectory& log) {
  Rates rates;
  for (const HorizonError& error : errors) {
    if (error.frames != 1) continue;
    const auto &a = log.poses[error.from], &b = log.poses[error.from + 1];
    const double span_s = b.t_s - a.t_s;
    const double logged = geometry::WrapToPi(b.yaw_rad - a.yaw_rad);
    const auto until = static_cast<size_t>(
        std::max(0.0, std::round((b.t_s - log.poses[errors.front().from].t_s) / kGrid_s)));
    rates.logged.resize(std::max(until, rates.logged.size()), logged / span_s);
    rates.simulated.resize(rates.logged.size(), (logged + error.turned_rad) / span_s);
  }
  return rates;
}

/// Correlation of the simulated rate with the logged one `shift` steps earlier.
double CorrelationAt(const Rates& rates, int shift) {
  double n = 0, sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
  const int size = static_cast<int>(rates.logged.size());
  for (int i = std::max(0, shift); i < std::min(size, size + shift); ++i) {
    const double x = rates.simulated[static_cast<size_t>(i)];
    const double y = rates.logged[static_cast<size_t>(i - shift)];
    n += 1, sx += x, sy += y, sxx += x * x, syy += y * y, sxy += x * y;
  }
  const double spread = (n * sxx - sx * sx) * (n * syy - sy * sy);
  return spread > 0.0 ? (n * sxy - sx * sy) / std::sqrt(spread) : 0.0;
}

double LagOf(const std::vector<Rates>& all) {
  const int most = static_cast<int>(std::lround(kMostLag_s / kGrid_s));
  double best = 0.0, best_s = gap::kNotComputed;
  for (int shift = -most; shift <= most; ++shift) {
    double sum = 0.0;
    for (const Rates& rates : all) sum += CorrelationAt(rates, shift);
    if (sum > best) best = sum, best_s = shift * kGrid_s;
  }
  return best_s;
}

/// Errors of the turn over the longest horizon, at the times of its middle.
struct Wave {
  std::vector<double> t_s, error_rad;
};

void FindFrequency(const std::vector<Wave>& waves, double horizon_s, ErrorStructure& structure) {
  double variance = 0.0, mean = 0.0, n = 0.0;
  for (const Wave& wave : waves) {
    for (const double e : wave.error_rad) mean += e, variance += e * e, n += 1.0;
  }
  if (n < 2.0 || !(horizon_s > 0.0)) return;
  mean /= n;
  variance -= n * mean * mean;
  double strongest = 0.0;
  // A horizon averages away what is faster than half a wave within it.
  const auto steps = static_cast<int>(std::floor((0.5 / horizon_s - kLowest_hz) / kStep_hz + 1e-9));
  for (int step = 0; step <= steps; ++step) {
    const double f = kLowest_hz + step * kStep_hz;
    double power = 0.0;
    for (const Wave& wave : waves) {
      std::complex<double> sum = 0.0;
      for (size_t i = 0; i < wave.t_s.size(); ++i) {
        sum +=
            (wave.error_rad[i] - mean) * std::polar(1.0, -2.0 * std::numbers::pi * f * wave.t_s[i]);
      }
      power += 2.0 * std::norm(sum) / std::max<double>(1.0, static_cast<double>(wave.t_s.size()));
    }
    if (power <= strongest) continue;
    strongest = power;
    structure.frequency_hz = f;
    structure.frequency_share = variance > 0.0 ? std::min(1.0, power / variance) : 0.0;
  }
}

struct Sums {
  double n = 0, span_s = 0, ahead = 0, left = 0, turned = 0, ahead2 = 0, left2 = 0, turned2 = 0;
  double to_left = 0, to_left_n = 0, to_right = 0, to_right_n = 0;

  /// The side is that of the prediction: noise of the log would otherwise pass for an error.
  void Add(const HorizonError& error, double seconds, double logged_rad) {
    n += 1, span_s += seconds;
    ahead += error.ahead_m, left += error.left_m, turned += error.turned_rad;
    ahead2 += error.ahead_m * error.ahead_m, left2 += error.left_m * error.left_m;
    turned2 += error.turned_rad * error.turned_rad;
    if (logged_rad + error.turned_rad > 0.0) {
      to_left += error.turned_rad, to_left_n += 1;
    } else {
      to_right += error.turned_rad, to_right_n += 1;
    }
  }
};

void Fill(const Sums& sums, ErrorStructure& structure) {
  structure.motions = static_cast<size_t>(sums.n);
  structure.horizon_s = sums.span_s / sums.n;
  structure.ahead_m = std::sqrt(sums.ahead2 / sums.n);
  structure.left_m = std::sqrt(sums.left2 / sums.n);
  structure.turned_rad = std::sqrt(sums.turned2 / sums.n);
  structure.ahead_bias_m = sums.ahead / sums.n;
  structure.left_bias_m = sums.left / sums.n;
  structure.turned_bias_rad = sums.turned / sums.n;
  structure.turning_left_rad = sums.to_left / sums.to_left_n;
  structure.turning_right_rad = sums.to_right / sums.to_right_n;
}

}  // namespace

ErrorStructure StructureOfErrors(const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                                 const std::vector<double>& values,
                                 const ShortHorizonOptions& options) {
  ErrorStructure structure;
  Sums sums;
  std::vector<Rates> rates;
  std::vector<Wave> waves;
  for (size_t i = 0; i < logs.size(); ++i) {
    const trajectory::Trajectory& log = logs[i].log;
    const auto errors = ShortHorizonErrors(twin(i, values), log, options, logs[i].began_s);
    if (errors.empty()) continue;
    rates.push_back(RatesOf(errors, log));
    Wave& wave = waves.emplace_back();
    for (const HorizonError& error : errors) {
      if (error.frames != options.most_frames) continue;
      const auto &a = log.poses[error.from], &b = log.poses[error.from + error.frames];
      sums.Add(error, b.t_s - a.t_s, geometry::WrapToPi(b.yaw_rad - a.yaw_rad));
      wave.t_s.push_back(0.5 * (a.t_s + b.t_s));
      wave.error_rad.push_back(error.turned_rad);
    }
  }
  if (sums.n == 0) return structure;
  Fill(sums, structure);
  structure.lag_s = LagOf(rates);
  FindFrequency(waves, structure.horizon_s, structure);
  return structure;
}

}  // namespace rift::sweep
