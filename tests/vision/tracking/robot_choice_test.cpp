#include "vision/tracking/robot_choice.hpp"

#include <catch2/catch.hpp>

namespace rift::vision {
namespace {

using Places = std::vector<Eigen::Vector3d>;

const Eigen::Vector3d kHere(0.0, 0.0, 0.03), kThere(0.7, 0.0, 0.03);

TEST_CASE(
    "A tag that the robot cannot have reached is ambiguous until nothing speaks for another") {
  TagOptions options;
  RobotChoice choice(options);
  CHECK_FALSE(choice.Choose(0.0, {kHere}, true).is_ambiguous);
  const auto jumped = choice.Choose(1.0 / 30.0, {kThere}, true);
  REQUIRE(jumped.robot);
  CHECK(jumped.is_ambiguous);
  CHECK(choice.Choose(1.0, {kThere}, true).is_ambiguous);
  CHECK_FALSE(choice.Choose(1.1 + options.doubt_s, {kThere}, true).is_ambiguous);
}

TEST_CASE("Beside a tag that was known before, the robot stays the robot after an occlusion") {
  RobotChoice choice({});
  choice.Choose(0.0, {kHere}, true);
  CHECK_FALSE(choice.Choose(0.1, {kHere, kThere}, true).is_ambiguous);
  CHECK(choice.Tags() == 2);
  CHECK_FALSE(choice.Choose(1.0, {kThere}, true).robot);  // the robot is hidden
  const auto back = choice.Choose(2.0, {kThere, kHere + Eigen::Vector3d(0.1, 0.0, 0.0)}, true);
  REQUIRE(back.robot);
  CHECK(*back.robot == 1);
  CHECK_FALSE(back.is_ambiguous);
}

TEST_CASE("Of two tags at the start neither is the robot for certain until one drives away") {
  RobotChoice choice({});
  CHECK(choice.Choose(0.0, {kHere, kThere}, true).is_ambiguous);
  CHECK(choice.Choose(0.1, {kHere, kThere}, true).is_ambiguous);
  SECTION("the chosen one drives") {
    Eigen::Vector3d p = kHere;
    for (int i = 1; i <= 10; ++i) {
      p.x() -= 0.02;
      choice.Choose(0.1 + 0.1 * i, {p, kThere}, true);
    }
    CHECK_FALSE(choice.Choose(1.2, {p, kThere}, true).is_ambiguous);
  }
  SECTION("the other one drives") {
    Eigen::Vector3d p = kThere;
    for (int i = 1; i <= 10; ++i) {
      p.x() += 0.02;
      choice.Choose(0.1 + 0.1 * i, {kHere, p}, true);
    }
    const auto verdict = choice.Choose(1.2, {kHere, p}, true);
    REQUIRE(verdict.robot);
    CHECK(*verdict.robot == 1);
    CHECK_FALSE(verdict.is_ambiguous);
  }
}

}  // namespace
}  // namespace rift::vision
