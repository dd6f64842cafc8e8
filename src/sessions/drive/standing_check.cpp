#include "standing_check.hpp"

#include <utility>

namespace rift::sessions {
namespace {

constexpr double kAtRest_px = 1.0;  // a hand that carries a robot moves it further

Eigen::Vector2d MiddleOf(const vision::TagCorners& corners) {
  return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

}  // namespace

void StandingCheck::Add(const vision::Sighting& sighting) {
  const std::lock_guard lock(mutex_);
  if (is_found_) return;
  const Eigen::Vector2d at_px = MiddleOf(sighting.corners);
  if (!check_ || (at_px - rests_px_).norm() > kAtRest_px) {
    rests_px_ = at_px;
    check_.emplace(camera_, tag_);
  }
  warning_ = check_->Add(sighting);
  is_found_ = warning_.has_value();
}

std::optional<std::string> StandingCheck::Take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(warning_, std::nullopt);
}

}  // namespace rift::sessions
