#pragma once

#include <cstdint>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/search/strategy.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::test {

/// A falsification task on the identified 3pi+, against its nominal run: where it drives (surface),
/// how the controller is set (pace, v_min, w_min), and what may drift (motors, radio delay). The
/// first two are categories.
class RobotSpace {
 public:
  /// Exceeded in 0.16 % of the volume: by 32 of 20,000 uniform points, of which 19,357 arrive; all
  /// of them drive downhill. search_study --only robot --measure counts anew.
  static constexpr double kThreshold_m = 0.51;

  RobotSpace();

  const std::vector<search::Axis>& Axes() const { return axes_; }
  /// Gap in m between the run at a point and the nominal one, the same noise in both; NaN where the
  /// robot did not reach the end.
  double Gap_m(const search::Point& point) const;

 private:
  trajectory::Trajectory Drive(const experiment::Experiment& experiment) const;

  std::vector<search::Axis> axes_;
  experiment::Experiment nominal_;
  trajectory::Trajectory reference_;
};

}  // namespace rift::test
