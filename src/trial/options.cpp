#include "rift/trial/options.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace rift::trial {
namespace {

void CheckSides(std::string_view low_name, const std::optional<double>& low,
                std::string_view high_name, const std::optional<double>& high) {
  if (!low || !high || *low < *high) return;
  throw std::invalid_argument(fmt::format("arena.{} is {}, and it must be below arena.{}, {}",
                                          low_name, *low, high_name, *high));
}

}  // namespace

bool Arena::Contains(double x_m, double y_m) const {
  return !(x_min_m && x_m < *x_min_m) && !(x_max_m && x_m > *x_max_m) &&
         !(y_min_m && y_m < *y_min_m) && !(y_max_m && y_m > *y_max_m);
}

void TrialOptions::Check() const {
  // A period of zero would never end the trial; the other ranges only shape its result.
  if (!(control_period_s > 0.0 && timeout_s > 0.0)) {
    throw std::invalid_argument(
        fmt::format("control_period_s is {} and timeout_s {}, and both must be above zero",
                    control_period_s, timeout_s));
  }
  if (!(pose_stale_s <= lost_after_s)) {
    throw std::invalid_argument(
        fmt::format("pose_stale_s is {}, and it must not exceed lost_after_s, which is {}",
                    pose_stale_s, lost_after_s));
  }
  CheckSides("x_min_m", arena.x_min_m, "x_max_m", arena.x_max_m);
  CheckSides("y_min_m", arena.y_min_m, "y_max_m", arena.y_max_m);
}

}  // namespace rift::trial
