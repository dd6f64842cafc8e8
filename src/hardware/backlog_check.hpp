#pragma once

#include <deque>
#include <optional>
#include <string>

#include "motion_step.hpp"
#include "rift/hardware/options.hpp"

namespace rift::hardware {

/// Finds pictures that come later and later. A link that carries fewer pictures than the camera
/// takes and keeps the rest delivers each one fresh by its stamp, and the motion that they show
/// falls behind the wheels little by little. That looks like slip; but then fewer pictures come
/// than before, which slip does not do.
class BacklogCheck {
 public:
  explicit BacklogCheck(const EvidenceOptions& options) : options_(options) {}

  /// From one picture to the next.
  struct Motion {
    double elapsed_s = 0.0;
    Step rolled;
    Step seen;
  };

  /// A picture came; times rise.
  void SeePicture(double t_s);
  /// The camera's period is that of the pictures of the last seconds: they are known to be in time.
  void LearnPeriod();
  bool KnowsPeriod() const { return period_s_.has_value(); }
  /// Forgets the motions; not the period.
  void Restart() { motions_.clear(); }
  /// What is wrong, for people; none: nothing. `is_measured`: the wheels, by encoders.
  /// `is_latency_known`: stamps are those of the light.
  std::optional<std::string> Check(const Motion& motion, bool is_measured, bool is_latency_known);

 private:
  /// Over the newest motions to one side: forward or backward, left or right.
  struct Behind {
    double way_m = 0.0;     ///< of the wheels
    double behind_m = 0.0;  ///< what the pose shows less
    double elapsed_s = 0.0;
    double moving_s = 0.0;
    double missing_s = 0.0;  ///< the time of the pictures that did not come
  };
  Behind BehindIn(double Step::*part) const;

  EvidenceOptions options_;
  std::deque<double> pictures_s_;
  std::optional<double> period_s_;
  std::deque<Motion> motions_;
};

}  // namespace rift::hardware
