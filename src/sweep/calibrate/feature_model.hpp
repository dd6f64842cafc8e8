#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "rift/sweep/calibrate/calibration.hpp"

namespace rift::sweep {

/// What one drive of a log's task is like: the features of drive_features without those of time
/// stamps, then loop delay, steering gain and bias, then how far left of the straight line to it
/// each waypoint was passed. NaN where it does not tell.
Eigen::VectorXd FeatureRow(const trajectory::Trajectory& path, const SimulatedTrial& twin);

/// The logs, each driven once at one set of values.
struct FeatureRows {
  Eigen::MatrixXd rows;        ///< logs x features; NaN for drives that failed
  Eigen::VectorXd has_failed;  ///< 1 for a drive that did not arrive, or only on a detour
};

/// One element for each set of values. The first `alike` sets, and each `alike` after them, are
/// driven with the same noise, which is that of no other sets, logs or `round`. `threads` drive at
/// once and change no result.
std::vector<FeatureRows> DriveAt(const std::vector<std::vector<double>>& values,
                                 const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                                 std::uint64_t round, int alike, int threads);

/// Logs of one group answer alike to the parameters: what their drives are like on average, as a
/// quadratic function of the parameters without products, regressed over drawn values (Beaumont,
/// Zhang and Balding 2002), beside the real logs.
class FeatureModel {
 public:
  using Acts = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

  /// `group_of_log`: the same text for logs of one group; `real`: logs x features; `draws`: draws x
  /// parameters, about 0 and of unit scatter; `acts`: logs x parameters, whether it changes drives
  /// of the log, without which its slopes are none; `driven`: one element for each draw;
  /// `failures`: FeatureFitOptions::failures; `alike`: as in DriveAt.
  FeatureModel(const std::vector<std::string>& group_of_log, const Eigen::MatrixXd& real,
               const Eigen::MatrixXd& draws, const Acts& acts,
               const std::vector<FeatureRows>& driven, double failures = 1.0, int alike = 1);

  /// What is regressed of each feature: its mean, slopes and squares.
  static Eigen::Index Coefficients(Eigen::Index parameters) { return 1 + 2 * parameters; }

  /// Of -2 log likelihood: features of each log normal about the mean of the simulated drives
  /// (synthetic likelihood, Wood 2010), and no log failed. What the noise of the regressed slopes
  /// adds to it on average is taken out (corrected score, Nakamura 1990): it grows with z, and
  /// would hold an estimate near 0.
  struct Expansion {
    double loss = 0.0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd hessian;  ///< Gauss and Newton's of the loss with that noise: positive
  };
  Expansion At(const Eigen::VectorXd& z) const;
  /// Half the Hessian without that noise: how surely the logs tell z.
  Eigen::MatrixXd InformationAt(const Eigen::VectorXd& z) const;
  /// Covariance of half the gradient: InformationAt where slopes are known, more where they are
  /// regressed from few draws.
  Eigen::MatrixXd ScoreCovarianceAt(const Eigen::VectorXd& z) const;

  /// The same loss of drives at one set of values, several for each log, without the regression. A
  /// feature that no drive of a group tells is as far off as its drives have ever been.
  double LossOf(const std::vector<FeatureRows>& driven) const;
  double FailingShareAt(const Eigen::VectorXd& z) const;
  size_t FeatureCount() const;

 private:
  struct Group {
    std::vector<Eigen::Index> logs;
    std::vector<Eigen::Index> told;  ///< features that both sides tell and that vary
    Eigen::VectorXd low, high;       ///< what is beyond counts as this; of all features
    Eigen::MatrixXd log_mean;        ///< logs of the group x features: of the drives at all draws
    Eigen::VectorXd real_off;        ///< told features: mean of the real logs, off log_mean
    Eigen::MatrixXd weights;         ///< inverse covariance of real_off
    Eigen::MatrixXd slopes;          ///< (1 + 2 parameters) x told features
    Eigen::VectorXd failing;         ///< the same of the share of drives that failed
    Eigen::MatrixXd slope_noise;     ///< of coefficients: their covariance, weighted, summed
  };
  Group GroupOf(std::vector<Eigen::Index> logs, const Eigen::MatrixXd& real,
                const Eigen::MatrixXd& draws, const Acts& acts,
                const std::vector<FeatureRows>& driven, int alike) const;
  Eigen::MatrixXd Kept(const Group& group, const Eigen::MatrixXd& rows) const;

  double FailureWeight(const Group& group) const {
    return 2.0 * failures_ * static_cast<double>(group.logs.size());
  }

  double failures_;
  std::vector<bool> is_positive_;  ///< such features are told as logarithms
  std::vector<Group> groups_;
  Eigen::MatrixXd slope_noise_;  ///< of all groups
};

}  // namespace rift::sweep
