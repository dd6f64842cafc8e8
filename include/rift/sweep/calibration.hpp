#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "rift/sweep/short_horizon.hpp"

namespace rift::sweep {

/// How a simulator is fitted to logs.
struct CalibrationOptions {
  ShortHorizonOptions horizon;
  int runs = 4;
  double likeness_weight = 4.0;
  int iterations = 12;
  double first_step = 0.2;
  double step = 0.1;
  int corrections = 2;
  int simulated_logs = 24;
  double outlier_sd = 3.0;
  int resamples = 1000;
  double confidence = 0.95;
  double identified_share = 0.25;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("horizon", self.horizon, "prediction of the next frames from the logged ones");
    field("runs", self.runs, 0, 1000,
          "whole simulated runs of each log, for weave, spread, speed and loop delay; 0: the next "
          "frames alone decide");
    field(
        "likeness_weight", self.likeness_weight, 0.0, 1e6,
        "how much weave, spread, speed and loop delay of a run count beside one predicted motion");
    field("iterations", self.iterations, 1, 1000, "most steps of the fit (Levenberg-Marquardt)");
    field("first_step", self.first_step, 1e-6, 0.5,
          "change of a parameter that its effect is read from at first, as a share of its range: "
          "long, to see past the leaps that a polled link makes");
    field("step", self.step, 1e-6, 0.5, "the same at the end");
    field(
        "corrections", self.corrections, 0, 100,
        "steps after the fit, to where the logs look like those the simulator makes itself; 0: the "
        "least errors, whose delay and mismatch are biased");
    field("simulated_logs", self.simulated_logs, 0, 10'000,
          "simulated logs in them at least: every real one is repeated equally often");
    field("outlier_sd", self.outlier_sd, 1.0, 1e6,
          "errors beyond this many standard deviations count in proportion (Huber 1964)");
    field("resamples", self.resamples, 20, 1'000'000,
          "draws of the logs, with replacement, behind the intervals (bootstrap)");
    field("confidence", self.confidence, 0.5, 0.9999, "of the intervals");
    field("identified_share", self.identified_share, 0.001, 1.0,
          "an interval that reaches further than this share of the range to either side says that "
          "the logs do not tell the parameter");
  }
};

/// A parameter that may change, in its own unit.
struct FreeParameter {
  std::string key;
  double min = 0.0;
  double max = 1.0;
  double start = 0.5;
  std::string origin{};  ///< where it was written, for messages
};

/// A log to fit. Logs of one setting repeat each other.
struct CalibrationLog {
  std::string name;
  std::string setting;
  trajectory::Trajectory log;
  /// No simulated log that stands for this one is longer, by strides: such a run circled about a
  /// waypoint, as no log here does, and would count more than all the others.
  double longest_m = std::numeric_limits<double>::infinity();
};

/// The simulated twin of a log, with one value for each free parameter. It starts where the robot
/// stood, and its seed is that log's own.
using TwinAt = std::function<SimulatedTrial(size_t log, const std::vector<double>& values)>;

/// Told after each step of the fit: how many there were, and the loss (of that step's own scale).
using CalibrationStep = std::function<void(int steps, double loss)>;

struct CalibratedParameter {
  FreeParameter parameter;
  double value = 0.0;
  double low = 0.0;  ///< of the interval, within the range
  double high = 0.0;
  bool has_effect = true;     ///< false: no prediction and no run changed at all
  bool is_at_bound = false;   ///< the fit would go beyond the range
  bool is_identified = true;  ///< false: the logs leave too much of the range open
};

struct Calibration {
  std::vector<CalibratedParameter> parameters;
  Eigen::MatrixXd correlation;  ///< of the estimates; NaN in rows of parameters without effect
  double loss_before = 0.0;     ///< mean squared error in standard deviations of the last fit
  double loss_after = 0.0;
  int steps = 0;  ///< of the fit
  bool has_converged = false;
  size_t trials_simulated = 0;
};

/// Fits the parameters to the logs. What is made small: errors of short-horizon predictions over
/// their standard deviation, and how the runs of each log differ from it in weave, spread, speed
/// and loop delay over the scatter of these among the logs. Whole paths have no say: of a delayed
/// bang-bang loop they are chaotic. Intervals and correlations: bootstrap over logs, each draw
/// fitted by one Gauss-Newton step; over the logs alone and over logs and the simulated ones of the
/// corrections together, whichever is wider. Throws std::invalid_argument for no logs, no
/// parameters or a start out of range. `threads` evaluate logs at once and change no result.
Calibration Calibrate(const std::vector<FreeParameter>& parameters,
                      const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                      const CalibrationOptions& options, std::mt19937_64& generator,
                      int threads = 1, const CalibrationStep& on_step = {});

}  // namespace rift::sweep
