#include "rift/control/pid.hpp"

#include <algorithm>
#include <cassert>

namespace rift::control {

Pid::Pid(const PidGains& gains, double integral_limit, bool derivative_kick)
    : gains_(gains), integral_limit_(integral_limit), derivative_kick_(derivative_kick) {}

double Pid::Step(double dt_s, double error) {
  assert(dt_s > 0.0);
  integral_ = std::clamp(integral_ + error * dt_s, -integral_limit_, integral_limit_);
  const double error_before = last_error_.value_or(derivative_kick_ ? 0.0 : error);
  last_error_ = error;
  return gains_.p * error + gains_.i * integral_ + gains_.d * (error - error_before) / dt_s;
}

void Pid::Reset() {
  integral_ = 0.0;
  last_error_.reset();
}

}  // namespace rift::control
