#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "rift/experiment/options.hpp"
#include "rift/sweep/calibrate/short_horizon.hpp"

namespace rift::sweep {

/// A log to fit. Logs of one setting repeat each other.
struct CalibrationLog {
  std::string name;
  std::string setting;
  trajectory::Trajectory log;
  /// No simulated log that stands for this one is longer, by strides: such a run circled about a
  /// waypoint, as no log here does, and would count more than all the others.
  double longest_m = std::numeric_limits<double>::infinity();
  /// Logs of one group answer alike to the parameters, as those of one surface do.
  std::string group{};
  /// Of the frames on which the stamps of its drives are put (trajectory::OnFramesOf); 0: none.
  double drives_grid_fps = 0.0;
  /// When its trial began, on its clock, where that is known (Replay).
  std::optional<double> began_s{};
};

/// The simulated twin of a log, with one value for each free parameter. It starts where the robot
/// stood, and its seed is that log's own.
using TwinAt = std::function<SimulatedTrial(size_t log, const std::vector<double>& values)>;

/// Whether values of the free parameters break no rule between keys.
using IsAllowed = std::function<bool(const std::vector<double>& values)>;

/// How far a fit is.
struct CalibrationProgress {
  enum class Part { kMotions, kDescent, kCorrection, kFeatures };
  Part part = Part::kDescent;
  int step = 0;  ///< of this part
  int most = 0;  ///< that part may end before
  /// Mean squared error over its standard deviation; each step judges that deviation anew, so that
  /// losses of two steps are not to be compared.
  double loss = 0.0;
  std::vector<double> values;  ///< of the free parameters
};
using CalibrationStep = std::function<void(const CalibrationProgress&)>;

struct CalibratedParameter {
  experiment::FreeParameter parameter;
  double value = 0.0;
  double low = 0.0;  ///< of the interval, within the range
  double high = 0.0;
  bool has_effect = true;      ///< false: no prediction and no run changed at all
  bool is_at_bound = false;    ///< the fit would go beyond the range
  bool is_identified = true;   ///< false: the logs leave too much of the range open
  bool is_from_prior = false;  ///< what was known before tells more than the logs
};

/// What fits from several starts found for one parameter.
struct StartAgreement {
  std::vector<double> values;  ///< one for each start
  /// Largest distance of two of them over half the width of the first one's interval; infinite for
  /// an interval without width.
  double difference = 0.0;
  bool agrees = true;  ///< by at most kAgreement

  static constexpr double kAgreement = 0.3;
};

struct Calibration {
  std::vector<CalibratedParameter> parameters;
  Eigen::MatrixXd correlation;  ///< of the estimates; NaN in rows of parameters without effect
  double loss_before = 0.0;     ///< mean squared error in standard deviations of the last part
  double loss_after = 0.0;
  double loss_noise = 0.0;  ///< standard error of their difference, where drives are drawn for it
  int steps = 0;            ///< of the fit
  bool has_converged = false;
  size_t trials_simulated = 0;

  /// Both losses are of one scale: that of the last step. By more than chance.
  bool IsWorseThanStart() const { return loss_after > loss_before + 2.0 * loss_noise; }
};

/// Compares fits of the same parameters; empty for fewer than two.
std::vector<StartAgreement> AgreementOf(const std::vector<Calibration>& fits);

/// Fits the parameters to the logs. What is made small: errors of short-horizon predictions over
/// their standard deviation, and how the runs of each log differ from it in weave, spread,
/// speed, loop delay and steering gain over the scatter of these among the logs. Whole paths have
/// no say: of a delayed bang-bang loop they are chaotic. A prior adds the square of the distance
/// from its mean over its standard deviation, as one more error. Intervals and correlations:
/// score bootstrap over logs (Kline and Santos 2012: each draw a Gauss-Newton step along its own
/// gradients with the Hessian of all logs), over the logs alone and over logs and the simulated
/// ones of the corrections together, whichever is wider, by Student's quantile with the degrees of
/// freedom of the logs that tell a parameter (Bell and McCaffrey 2002). With
/// options.features.rounds the estimate then goes on to where whole drives have the features of the
/// logs. Throws std::invalid_argument for no logs, no parameters or a start out of range. `threads`
/// evaluate logs at once and change no result. The fit asks for no twin at values that are not
/// allowed: its steps and draws end before them, as at a bound, and it starts where they are next
/// to the start.
Calibration Calibrate(const std::vector<experiment::FreeParameter>& parameters,
                      const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                      const CalibrationOptions& options, std::mt19937_64& generator,
                      int threads = 1, const CalibrationStep& on_step = {},
                      const IsAllowed& is_allowed = {});

}  // namespace rift::sweep
