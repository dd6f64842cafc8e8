// One damped step of a fit beside its bounds.
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "sweep/calibrate/model.hpp"

namespace rift::sweep {
namespace {

TEST_CASE("A parameter that a bound stops takes no part in the step of the others") {
  Eigen::Matrix3d hessian;
  hessian << 4.0, 1.5, 0.5, 1.5, 3.0, -0.8, 0.5, -0.8, 2.0;
  const Eigen::Vector3d low(0.0, 0.0, 0.0), high(1.0, 1.0, 1.0);
  constexpr double kDamping = 0.1;
  Eigen::Matrix3d damped = hessian;
  damped.diagonal() *= 1.0 + kDamping;
  for (const int stopped : {0, 1, 2}) {
    CAPTURE(stopped);
    for (const bool is_above : {false, true}) {
      Eigen::Vector3d at(0.5, 0.5, 0.5), gradient(0.7, -0.4, 0.3);
      at[stopped] = is_above ? 1.0 : 0.0;
      gradient[stopped] = is_above ? -0.6 : 0.6;  // downhill is beyond the bound
      const Eigen::Vector3d step = StepWithin(at, low, high, hessian, gradient, kDamping);
      CHECK(step[stopped] == 0.0);
      const int a = stopped == 0 ? 1 : 0, b = stopped == 2 ? 1 : 2;
      Eigen::Matrix2d others;
      others << damped(a, a), damped(a, b), damped(b, a), damped(b, b);
      const Eigen::Vector2d expected =
          -others.inverse() * Eigen::Vector2d(gradient[a], gradient[b]);
      CHECK(step[a] == Approx(expected[0]).epsilon(1e-6));
      CHECK(step[b] == Approx(expected[1]).epsilon(1e-6));

      gradient[stopped] = -gradient[stopped];  // back into the range
      const Eigen::Vector3d free = StepWithin(at, low, high, hessian, gradient, kDamping);
      const Eigen::Vector3d of_all = -damped.inverse() * gradient;
      for (const int k : {0, 1, 2}) CHECK(free[k] == Approx(of_all[k]).epsilon(1e-6));
    }
  }
}

}  // namespace
}  // namespace rift::sweep
