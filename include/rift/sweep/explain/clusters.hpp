#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// Failures that are alike: the reference leaves the candidate in the same way at the same place,
/// or the trial ended in the same way before its end.
struct FailureCluster {
  TrialStatus status = TrialStatus::kOk;  ///< kOk: gaps above the threshold
  std::vector<int> rows;  ///< indices into SweepResult::rows, the most typical first
  double mean_gap_m = gap::kNotComputed;
  double mean_u = gap::kNotComputed;  ///< where along the path the gap stands
  Eigen::Vector2d end_error_m =
      Eigen::Vector2d::Zero();  ///< mean of reference - candidate at u = 1
  std::string sentence;
};

struct ClusterOptions {
  int most_clusters = 6;
  /// Below this mean silhouette (Rousseeuw 1987) all failures count as one kind; 0.25 is where he
  /// sees no structure, 0.5 a reasonable one.
  double least_silhouette = 0.4;
  int most_compared = 400;  ///< failures, evenly picked, that the number of clusters is found with
};

/// The distinct ways in which a sweep fails, the largest first.
std::vector<FailureCluster> ClusterFailures(const SweepResult& result,
                                            const ClusterOptions& options = {});

}  // namespace rift::sweep
