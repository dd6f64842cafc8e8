#include "rift/sweep/calibrate/repeated_trial.hpp"

namespace rift::sweep {

using trajectory::Trajectory;

double LengthByStrides_m(const Trajectory& path) {
  constexpr double kStride_m = 0.02;
  double length_m = 0.0;
  Eigen::Vector2d last = path.poses.front().Position();
  for (const trajectory::StampedPose& pose : path.poses) {
    const double moved_m = (pose.Position() - last).norm();
    if (moved_m < kStride_m) continue;
    length_m += moved_m;
    last = pose.Position();
  }
  return length_m;
}

std::vector<RepeatedTrial> WithoutDetours(std::vector<RepeatedTrial> trials, double longest_run) {
  const auto longest_m = LongestBySetting_m(trials, &RepeatedTrial::real);
  for (RepeatedTrial& trial : trials) {
    const double limit_m = longest_run * longest_m.at(trial.setting);
    const auto is_detour = [&](const Trajectory& run) { return LengthByStrides_m(run) > limit_m; };
    const int circled = static_cast<int>(std::erase_if(trial.runs, is_detour));
    trial.circled_runs += circled;
    trial.failed_runs += circled;
  }
  return trials;
}

}  // namespace rift::sweep
