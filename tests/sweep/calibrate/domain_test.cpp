// The values that a rule allows, in shares of the ranges: where their middle is and where they end.
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

}  // namespace
}  // namespace rift::sweep
