#include "rift/geometry/pose2.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace rift::geometry {
namespace {

Pose2 RandomPose(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> position_m(-3.0, 3.0), yaw_rad(-kPi, kPi);
  return {position_m(generator), position_m(generator), yaw_rad(generator)};
}

TEST_CASE("A quarter turn takes forward to left") {
  const Pose2 b_from_a{1.0, 2.0, kPi / 2.0};
  const Eigen::Vector2d p_in_b = b_from_a * Eigen::Vector2d(1.0, 0.0);
  CHECK(p_in_b.x() == Approx(1.0));
  CHECK(p_in_b.y() == Approx(3.0));
}

TEST_CASE("A motion followed by its inverse moves nothing") {
  std::mt19937_64 generator(1);
  for (int i = 0; i < 100; ++i) {
    const Pose2 b_from_a = RandomPose(generator);
    const Pose2 identity = Inverse(b_from_a) * b_from_a;
    CHECK(identity.Position().norm() < 1e-12);
    CHECK(std::abs(identity.yaw_rad) < 1e-12);
  }
}

TEST_CASE("Composing motions is the same as applying them one after the other") {
  std::mt19937_64 generator(2);
  for (int i = 0; i < 100; ++i) {
    const Pose2 c_from_b = RandomPose(generator), b_from_a = RandomPose(generator);
    const Eigen::Vector2d p_in_a = RandomPose(generator).Position();
    CHECK(((c_from_b * b_from_a) * p_in_a - c_from_b * (b_from_a * p_in_a)).norm() < 1e-12);
  }
}

TEST_CASE("Wrapping an angle keeps its direction and lands within half a turn") {
  for (double angle_rad = -20.0; angle_rad < 20.0; angle_rad += 0.37) {
    const double wrapped_rad = WrapToPi(angle_rad);
    CHECK(std::abs(wrapped_rad) <= kPi);
    CHECK(std::cos(wrapped_rad) == Approx(std::cos(angle_rad)).margin(1e-12));
    CHECK(std::sin(wrapped_rad) == Approx(std::sin(angle_rad)).margin(1e-12));
  }
}

TEST_CASE("Forward is where the yaw looks, and a pose is finite in all of its numbers") {
  CHECK(Pose2{5.0, 6.0, kPi / 6.0}.Forward().x() == Approx(std::sqrt(0.75)));
  CHECK(Pose2{5.0, 6.0, kPi / 6.0}.Forward().y() == Approx(0.5));
  CHECK(Pose2{1.0, 2.0, 3.0}.IsFinite());
  for (const double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    CHECK_FALSE(Pose2{wrong, 2.0, 3.0}.IsFinite());
    CHECK_FALSE(Pose2{1.0, wrong, 3.0}.IsFinite());
    CHECK_FALSE(Pose2{1.0, 2.0, wrong}.IsFinite());
  }
}

}  // namespace
}  // namespace rift::geometry
