#pragma once

#include <optional>

namespace rift::control {

struct PidGains {
  double p = 0.0;
  double i = 0.0;
  double d = 0.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("p", self.p, 0.0, 1e3, "output for each unit of error");
    field("i", self.i, 0.0, 1e3, "output for each unit of error and second");
    field("d", self.d, 0.0, 1e3, "output for each unit of error per second");
  }
};

/// A PID loop on an error, and nothing but its state: time comes in with every step.
class Pid {
 public:
  /// The integral of the error is held within +-integral_limit, so a loop that cannot reach its
  /// goal does not wind up. With `derivative_kick` the error before the first step counts as
  /// zero; without, the derivative of the first step is zero.
  Pid(const PidGains& gains, double integral_limit, bool derivative_kick);

  /// Output for an error that has held for `dt_s` > 0 since the last step.
  double Step(double dt_s, double error);
  /// Forgets the integral and the last error.
  void Reset();

  double integral() const { return integral_; }

 private:
  PidGains gains_;
  double integral_limit_;
  bool derivative_kick_;
  double integral_ = 0.0;
  std::optional<double> last_error_;
};

}  // namespace rift::control
