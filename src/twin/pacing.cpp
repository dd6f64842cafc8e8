#include "pacing.hpp"

namespace rift::twin {

double Pacer::Simulated_s(double now_s) {
  const double behind_s = now_s - last_s_;
  if (behind_s > kMostBehind_s) {
    epoch_s_ += behind_s - kMostBehind_s;
    skipped_s_ += behind_s - kMostBehind_s;
  }
  last_s_ = now_s;
  return now_s - epoch_s_;
}

void TrialEnd::See(double t_s, const control::WheelPower& power) {
  if (power == control::WheelPower{}) return;
  has_driven_ = true;
  driven_s_ = t_s;
}

}  // namespace rift::twin
