#pragma once

#include <cstdint>
#include <vector>

#include "rift/config/experiment.hpp"
#include "rift/search/strategy.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::test {

/// A falsification task on the identified 3pi+: six parameters, two of them categories, each within
/// what the logs leave open, against the run with nominal values.
class RobotSpace {
 public:
  /// Exceeded in 0.1 % of the volume.
  static constexpr double kThreshold_m = 0.33;

  RobotSpace();

  const std::vector<search::Axis>& Axes() const { return axes_; }
  /// Gap in m between the run at a point and the nominal one, the same noise in both; NaN where the
  /// robot did not reach the end.
  double Gap_m(const search::Point& point) const;

 private:
  trajectory::Trajectory Drive(const config::Experiment& experiment,
                               const geometry::Pose2& start) const;

  std::vector<search::Axis> axes_;
  config::Experiment nominal_;
  trajectory::Trajectory reference_;
};

}  // namespace rift::test
