// The values that a rule allows, in shares of the ranges, and one damped step of a fit beside its
// bounds.
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "rift/statistics/random.hpp"
#include "sweep/calibrate/model.hpp"

namespace rift::sweep {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

/// Mean of those of 32 random places that are within.
VectorXd MiddleOf(const Domain::Contained& contained) {
  const statistics::CounterRandom random(1, 112);
  VectorXd sum = VectorXd::Zero(2);
  double found = 0.0;
  for (std::uint64_t i = 0; i < 32; ++i) {
    const Vector2d place(random.Uniform(i, 0), random.Uniform(i, 1));
    if (contained(place)) sum += place, found += 1.0;
  }
  return sum / found;
}

TEST_CASE("Without a rule every value is within, also beyond the ranges") {
  const Domain all;
  CHECK(all.Contains(Vector2d(-3.0, 7.0)));
  CHECK(all.Nearest(Vector2d(-3.0, 7.0)) == Vector2d(-3.0, 7.0));
}

TEST_CASE("What is not allowed goes to where the way to it from the middle leaves what is") {
  for (const double limit : {0.3, 0.7}) {
    const auto contained = [limit](const VectorXd& shares) { return shares[0] <= limit; };
    const Domain domain(contained, Vector2d(0.1, 0.9));
    const VectorXd middle = MiddleOf(contained), asked = Vector2d(0.95, 0.2);
    const double share = (limit - middle[0]) / (asked[0] - middle[0]);
    const VectorXd expected = middle + share * (asked - middle);
    const VectorXd found = domain.Nearest(asked);
    CHECK(found[0] == Approx(limit).epsilon(3e-7));
    CHECK(found[0] <= limit);
    CHECK(found[1] == Approx(expected[1]).epsilon(3e-7));
    CHECK(domain.Nearest(Vector2d(limit, 0.2)) == Vector2d(limit, 0.2));  // which is allowed
    CHECK(domain.Contains(Vector2d(limit, 5.0)));
    CHECK_FALSE(domain.Contains(Vector2d(limit + 1e-9, 5.0)));
  }
}

TEST_CASE("The middle is where the fit starts where the mean of what is allowed is not") {
  const Domain ends([](const VectorXd& shares) { return shares[0] < 0.2 || shares[0] > 0.8; },
                    Vector2d(0.9, 0.3));
  const VectorXd of_ends = ends.Nearest(Vector2d(0.5, 0.7));  // a quarter of the way is allowed
  CHECK(of_ends[0] == Approx(0.8));
  CHECK(of_ends[1] == Approx(0.4));
  const Vector2d start(0.25, 0.75);
  const Domain small([&](const VectorXd& shares) { return (shares - start).norm() < 1e-4; }, start);
  const VectorXd of_small = small.Nearest(Vector2d(0.25, 0.0));
  CHECK(of_small[0] == 0.25);
  CHECK(of_small[1] == Approx(0.7499));
}

TEST_CASE("A rule is asked about 32 places and their mean, and for an end 24 times on the way") {
  int asked = 0;
  const auto contained = [&asked](const VectorXd& shares) {
    ++asked;
    return shares[1] > 0.4;
  };
  const Domain domain(contained, Vector2d(0.5, 0.9));
  CHECK(asked == 32 + 1);
  asked = 0;
  domain.Nearest(Vector2d(0.5, 0.1));
  CHECK(asked == 1 + 24);
  asked = 0;
  domain.Nearest(Vector2d(0.5, 0.5));
  CHECK(asked == 1);
}

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
