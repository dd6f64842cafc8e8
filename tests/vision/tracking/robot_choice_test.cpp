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

Eigen::Vector3d At(double x_m, double y_m = 0.0) { return {x_m, y_m, 0.03}; }

TEST_CASE("A robot can have got as far as its speed allows, and a little more") {
  TagOptions options{.reach_mps = 2.0, .reach_m = 0.125, .doubt_s = 1.0};
  const double since_s = GENERATE(0.25, -0.25);  // a clock that ran back counts for nothing
  const double reach_m = since_s > 0.0 ? 0.625 : 0.125;
  for (const double off_m : {reach_m - 1e-9, reach_m + 1e-9}) {
    RobotChoice choice(options);
    choice.Choose(5.0, {At(0.0)}, true);
    const auto verdict = choice.Choose(5.0 + since_s, {At(0.0, off_m)}, true);
    REQUIRE(verdict.robot);
    CHECK(*verdict.robot == 0);
    CHECK(verdict.is_ambiguous == (off_m > reach_m));
    CHECK(choice.IsInDoubt() == (off_m > reach_m));
  }
}

TEST_CASE("Of several in reach the nearest is taken, wherever it stands in the list, in doubt") {
  for (std::size_t nearest = 0; nearest < 3; ++nearest) {
    Places seen{At(0.04), At(0.03), At(-0.035)};
    seen[nearest] = At(0.01);
    RobotChoice choice({});
    choice.Choose(0.0, {At(0.0)}, true);
    const auto verdict = choice.Choose(0.03, seen, true);
    CHECK(verdict.robot == nearest);
    CHECK(verdict.is_ambiguous);
    CHECK(choice.Tags() == 3);
  }
  RobotChoice of_two({});
  of_two.Choose(0.0, {At(0.0)}, true);
  CHECK(of_two.Choose(0.03, {At(0.04), At(0.01)}, true).is_ambiguous);
  // Of those beyond reach the first, which is the best that was seen.
  RobotChoice choice({});
  choice.Choose(0.0, {At(0.0)}, true);
  CHECK(choice.Choose(0.03, {At(3.0), At(2.0)}, true).robot == 0U);
}

TEST_CASE("What was looked at in part counts no tags and refutes no rival") {
  const TagOptions options{.doubt_s = 1.0};
  RobotChoice choice(options);
  CHECK(choice.Tags() == 1);
  CHECK(choice.Choose(0.0, {At(0.0), At(0.7)}, false).is_ambiguous);
  CHECK(choice.Tags() == 1);
  CHECK(choice.Choose(0.1, {At(0.0), At(0.7)}, true).is_ambiguous);
  CHECK(choice.Tags() == 2);
  // Not seen for as long as is asked for: only a search of the whole picture can say so.
  CHECK(choice.Choose(1.2, {At(0.0)}, false).is_ambiguous);
  CHECK(choice.Tags() == 2);
  CHECK_FALSE(choice.Choose(1.2, {At(0.0)}, true).is_ambiguous);
  CHECK(choice.Tags() == 1);
  CHECK_FALSE(choice.Choose(1.3, {}, true).robot);
  CHECK(choice.Tags() == 1);
}

TEST_CASE("A rival is refuted once it was not seen for longer than the limit") {
  for (const double since_s : {0.999, 1.001}) {
    RobotChoice choice({.doubt_s = 1.0});
    choice.Choose(0.0, {At(0.0), At(0.7)}, true);
    CHECK(choice.Choose(since_s, {At(0.0)}, true).is_ambiguous == (since_s < 1.0));
  }
}

TEST_CASE("Forgotten, a choice begins anew") {
  RobotChoice choice({});
  choice.Choose(0.0, {At(0.0), At(0.7)}, true);
  choice.Forget();
  CHECK_FALSE(choice.IsInDoubt());
  CHECK(choice.Tags() == 1);
  const auto verdict = choice.Choose(0.03, {At(5.0)}, true);
  CHECK(verdict.robot == 0U);
  CHECK_FALSE(verdict.is_ambiguous);
}

TEST_CASE("The robot is cleared of doubt by driving ten centimetres while its rivals rest") {
  // The chosen tag drives by so much, and its rival by so much, within one second.
  const auto is_in_doubt = [](double robot_m, double rival_m) {
    RobotChoice choice({});
    choice.Choose(0.0, {At(0.0), At(0.7)}, true);
    return choice.Choose(1.0, {At(-robot_m), At(0.7 + rival_m)}, true).is_ambiguous;
  };
  CHECK(is_in_doubt(0.099, 0.0));
  CHECK_FALSE(is_in_doubt(0.101, 0.0));
  CHECK_FALSE(is_in_doubt(0.101, 0.019));
  CHECK(is_in_doubt(0.101, 0.021));
}

TEST_CASE("A rival that drives ten centimetres while the chosen tag rests is the robot") {
  struct Case {
    double chosen_m, rival_m;
    std::size_t robot;
  };
  for (const Case& one :
       {Case{0.0, 0.099, 0}, {0.0, 0.101, 1}, {0.019, 0.101, 1}, {0.021, 0.101, 0}}) {
    INFO(one.chosen_m << " " << one.rival_m);
    RobotChoice choice({});
    choice.Choose(0.0, {At(0.0), At(0.7)}, true);
    const auto verdict = choice.Choose(1.0, {At(one.chosen_m), At(0.7 + one.rival_m)}, true);
    REQUIRE(verdict.robot == one.robot);
    CHECK(verdict.is_ambiguous);
    if (one.robot == 0) continue;
    // From then on it is the one, and the other is a rival at rest.
    const auto next = choice.Choose(1.1, {At(one.chosen_m), At(0.7 + one.rival_m)}, true);
    CHECK(next.robot == 1U);
    CHECK_FALSE(next.is_ambiguous);
  }
  // A rival that is not in this picture does not take over.
  RobotChoice choice({});
  choice.Choose(0.0, {At(0.0), At(0.7), At(-0.7)}, true);
  CHECK(choice.Choose(0.5, {At(0.0), At(0.9)}, false).robot == 0U);
  CHECK(choice.Choose(1.0, {At(0.0), At(-0.7)}, true).robot == 0U);
}

TEST_CASE("A tag where a rival rested is that rival, unless the robot was nearer") {
  RobotChoice choice({.reach_mps = 0.5, .reach_m = 0.05, .doubt_s = 100.0});
  choice.Choose(0.0, {At(0.0)}, true);
  choice.Choose(0.1, {At(0.0), At(0.7)}, true);  // out of reach: a rival, and no doubt
  CHECK_FALSE(choice.IsInDoubt());
  // After two seconds the robot could be there; within 2 cm it is taken for the rival.
  CHECK_FALSE(choice.Choose(2.1, {At(0.7 - 0.019)}, true).robot);
  CHECK(choice.Choose(2.2, {At(0.7 - 0.021 - 0.019)}, true).robot == 0U);
  CHECK_FALSE(choice.IsInDoubt());
}

TEST_CASE("Rivals that rest in each other's reach are not taken for each other") {
  RobotChoice choice({});
  for (const double t_s : {0.0, 0.2, 0.4}) {
    CHECK(choice.Choose(t_s, {At(0.0), At(0.7), At(0.9)}, true).robot == 0U);
    CHECK(choice.Choose(t_s, {At(0.0), At(0.9), At(0.7)}, true).robot == 0U);
  }
  CHECK(choice.IsInDoubt());
}

TEST_CASE("What is left of the robot may be a rival's place once it was away for long") {
  for (const double away_s : {2.99, 3.01}) {
    RobotChoice choice({.doubt_s = 3.0});
    choice.Choose(0.0, {At(0.0)}, true);
    choice.Choose(0.0, {At(0.0), At(0.7)}, true);
    const auto verdict = choice.Choose(away_s, {At(0.7)}, true);
    CHECK(verdict.robot.has_value() == (away_s > 3.0));
    if (!verdict.robot) continue;
    CHECK(verdict.is_ambiguous);
    // Where the robot was is a rival now: it is not jumped back to.
    CHECK(choice.Choose(away_s + 0.1, {At(0.0), At(0.7)}, true).robot == 1U);
  }
}

TEST_CASE("A rival that is seen first beside another one has not driven there from its place") {
  // The third tag comes into sight 12 cm from a rival at rest, in its reach, in either order.
  for (const bool is_first : {true, false}) {
    RobotChoice choice({});
    choice.Choose(0.0, {At(0.0), At(0.7)}, true);
    choice.Choose(0.3, {At(0.0), At(0.7)}, true);
    Places seen{At(0.0), At(0.7), At(0.82)};
    if (is_first) std::swap(seen[1], seen[2]);
    for (const double t_s : {0.6, 0.9}) {
      const auto verdict = choice.Choose(t_s, seen, true);
      CHECK(verdict.robot == 0U);
      CHECK(verdict.is_ambiguous);
    }
  }
}

}  // namespace
}  // namespace rift::vision
