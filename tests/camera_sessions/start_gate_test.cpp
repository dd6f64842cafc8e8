#include "sessions/drive/start_gate.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace rift::sessions {
namespace {

const geometry::Pose2 kStart{1.0, 2.0, geometry::kPi};
const geometry::Pose2 kNear{1.01, 2.0, -geometry::RadFromDeg(179.0)};
const geometry::Pose2 kFar{1.0, 2.12, geometry::kPi};
const geometry::Pose2 kTurned{1.0, 2.0, geometry::kPi - 0.2};

/// A person who presses Enter, and what this person was told.
struct Person {
  bool has_agreed = false;
  std::vector<std::string> told, shown;

  StartGate::Person AtTerminal() {
    StartGate::Person person = Absent();
    person.ask_again = [this] { has_agreed = false; };
    person.show = [this](const std::string& line) { shown.push_back(line); };
    return person;
  }
  StartGate::Person Absent() {
    return {.has_agreed = [this] { return has_agreed; },
            .say = [this](const std::string& line) { told.push_back(line); }};
  }
};

TEST_CASE("How far off a robot stands does not depend on how its angle is written") {
  const Placement placement = PlacementOf(kNear, kStart);
  CHECK(placement.off_m == Approx(0.01));
  CHECK(placement.off_deg == Approx(1.0));
  CHECK(PlacementText(placement) == "1.0 cm, 1 deg off");
}

TEST_CASE("A robot starts when the countdown after Enter is over") {
  Person person;
  StartGate gate({}, kStart, false, person.AtTerminal());
  CHECK_FALSE(gate.MayStart(0.0, kNear));
  CHECK_FALSE(gate.MayStart(60.0, kNear));
  person.has_agreed = true;
  CHECK_FALSE(gate.MayStart(60.1, kNear));
  CHECK_FALSE(gate.MayStart(62.5, kNear));
  CHECK_FALSE(gate.MayStart(63.0, kNear));
  CHECK(gate.MayStart(63.2, kNear));
  REQUIRE(person.told.size() == 1);
  CHECK_THAT(person.told[0], Catch::Contains("starts in 3 s") && Catch::Contains("cancels"));
  CHECK_THAT(person.shown.back(), Catch::Contains("any key"));
  CHECK(person.shown[person.shown.size() - 2] == "1 ...");
}

TEST_CASE("No countdown starts with Enter") {
  Person person{.has_agreed = true};
  StartGate gate({.countdown_s = 0.0}, kStart, false, person.AtTerminal());
  CHECK(gate.MayStart(0.0, kNear));
  CHECK(person.told.empty());
}

TEST_CASE("While nobody agreed the distance from the start is shown as it changes") {
  Person person;
  StartGate gate({}, kStart, false, person.AtTerminal());
  gate.MayStart(0.0, kFar);
  gate.MayStart(0.095, kNear);  // too soon to be read
  gate.MayStart(0.105, kNear);
  gate.MayStart(0.4, std::nullopt);
  REQUIRE(person.shown.size() == 3);
  CHECK(person.shown[0] == "put the robot at the start: 12.0 cm, 0 deg off; Enter");
  CHECK(person.shown[1] == "put the robot at the start: 1.0 cm, 1 deg off; Enter");
  CHECK_THAT(person.shown[2], Catch::Contains("not seen"));
}

TEST_CASE("A robot that stands far off or turned is refused until it is put right") {
  for (const geometry::Pose2& wrong : {kFar, kTurned}) {
    Person person{.has_agreed = true};
    StartGate gate({}, kStart, false, person.AtTerminal());
    CHECK_FALSE(gate.MayStart(0.0, wrong));
    CHECK_FALSE(person.has_agreed);
    REQUIRE(person.told.size() == 1);
    CHECK_THAT(person.told[0], Catch::Contains("0.05 m and 5 deg are allowed") &&
                                   Catch::Contains("x 1.000 m, y 2.000 m, heading 180 deg"));
    CHECK_FALSE(gate.MayStart(10.0, kNear));  // Enter was not pressed again
    person.has_agreed = true;
    CHECK_FALSE(gate.MayStart(11.0, kNear));
    CHECK(gate.MayStart(14.1, kNear));
  }
}

TEST_CASE("A robot that is pushed away during the countdown does not start") {
  Person person{.has_agreed = true};
  StartGate gate({}, kStart, false, person.AtTerminal());
  CHECK_FALSE(gate.MayStart(0.0, kNear));
  CHECK_FALSE(gate.MayStart(3.5, kFar));
  CHECK_FALSE(person.has_agreed);
}

TEST_CASE("A robot that is not seen does not start, wherever it may start") {
  for (const bool any_place : {false, true}) {
    Person person{.has_agreed = true};
    StartGate gate({.countdown_s = 0.0}, kStart, any_place, person.AtTerminal());
    CHECK_FALSE(gate.MayStart(0.0, std::nullopt));
    CHECK_FALSE(gate.MayStart(9.9, std::nullopt));
    CHECK_THAT(person.shown.back(), Catch::Contains("not seen"));
    CHECK(person.has_agreed);
    CHECK(gate.MayStart(9.95, kNear));
  }
}

TEST_CASE("A robot that is covered during the countdown has all of it again") {
  Person person{.has_agreed = true};
  StartGate gate({}, kStart, false, person.AtTerminal());
  CHECK_FALSE(gate.MayStart(0.0, kNear));
  CHECK_FALSE(gate.MayStart(2.0, std::nullopt));
  CHECK_FALSE(gate.MayStart(4.0, kNear));
  CHECK_FALSE(gate.MayStart(6.9, kNear));
  CHECK(gate.MayStart(7.1, kNear));
}

TEST_CASE("A countdown that begins again shows its first second again") {
  Person person{.has_agreed = true};
  StartGate gate({}, kStart, false, person.AtTerminal());
  gate.MayStart(0.0, kNear);
  CHECK(person.shown.back() == "3 ...");
  gate.MayStart(0.1, std::nullopt);
  CHECK(person.shown.back() != "3 ...");
  gate.MayStart(0.2, kNear);
  CHECK(person.shown.back() == "3 ...");
}

TEST_CASE("A robot that is not seen for ten seconds has to be agreed to anew, or ends the drive") {
  Person person{.has_agreed = true};
  StartGate gate({.countdown_s = 0.0}, kStart, false, person.AtTerminal());
  const auto sees_nothing_until = [](StartGate& one, double end_s) {
    for (double t_s = 0.0; t_s < end_s; t_s += 1.0) one.MayStart(t_s, std::nullopt);
  };
  sees_nothing_until(gate, 10.5);
  CHECK(person.has_agreed);
  gate.MayStart(11.0, std::nullopt);
  CHECK_FALSE(person.has_agreed);
  REQUIRE(person.told.size() == 1);
  CHECK_THAT(person.told[0], Catch::Contains("not been seen for 10 s") && Catch::Contains("tag") &&
                                 Catch::EndsWith("; then Enter"));
  person.has_agreed = true;
  gate.MayStart(12.0, std::nullopt);  // counts from the new Enter
  CHECK(person.has_agreed);
  CHECK(gate.MayStart(13.0, kNear));

  Person nobody{.has_agreed = true};
  StartGate alone({.countdown_s = 0.0}, kStart, false, nobody.Absent());
  CHECK_THROWS_WITH(sees_nothing_until(alone, 12.0),
                    Catch::StartsWith("not started: the robot has not been seen for 10 s"));
}

TEST_CASE("Where nobody can be asked a robot that is far off ends the drive with what to do") {
  Person person{.has_agreed = true};
  StartGate gate({}, kStart, false, person.Absent());
  CHECK_THROWS_WITH(gate.MayStart(0.0, kFar),
                    Catch::Contains("0.120 m and 0.0 deg off") && Catch::Contains("--any-start"));
}

TEST_CASE("With any start a robot that is far off is warned of once") {
  Person person{.has_agreed = true};
  StartGate gate({.countdown_s = 0.5}, kStart, true, person.Absent());
  CHECK_FALSE(gate.MayStart(0.0, kFar));
  CHECK_FALSE(gate.MayStart(0.1, kFar));
  CHECK(gate.MayStart(0.6, kFar));
  REQUIRE(person.told.size() == 2);
  CHECK_THAT(person.told[0], Catch::StartsWith("warning: the robot stands 0.120 m"));
}

TEST_CASE("A countdown shows each of its seconds and ends exactly when they are over") {
  constexpr double kMoment_s = 1.0 / 1024.0;
  Person person{.has_agreed = true};
  StartGate gate({.countdown_s = 2.5}, kStart, false, person.AtTerminal());
  for (const double t_s : {100.0, 100.25, 100.5, 101.0, 101.5, 102.0, 102.5 - kMoment_s}) {
    CHECK_FALSE(gate.MayStart(t_s, kNear));
  }
  CHECK(person.told == std::vector<std::string>{"starts in 2.5 s; any key or Ctrl-C cancels"});
  CHECK(person.shown == std::vector<std::string>{"3 ...", "2 ...", "1 ..."});
  CHECK(gate.MayStart(102.5, kNear));
  CHECK(person.shown.back() == "the robot drives: any key or Ctrl-C stops it");
}

TEST_CASE("A robot may stand as far off and turned as is allowed, to each side, and no farther") {
  const hardware::StartOptions options{.within_m = 0.25, .within_deg = 12.0, .countdown_s = 0.0};
  const geometry::Pose2 start{0.5, -1.5, 0.25};
  const auto may_start = [&](double x_m, double y_m, double turn_deg) {
    Person person{.has_agreed = true};
    StartGate gate(options, start, false, person.AtTerminal());
    const geometry::Pose2 seen{start.x_m + x_m, start.y_m + y_m,
                               start.yaw_rad + geometry::RadFromDeg(turn_deg)};
    const bool may = gate.MayStart(0.0, seen);
    CHECK(person.has_agreed == may);
    return may;
  };
  for (const double sign : {1.0, -1.0}) {
    CHECK(may_start(sign * 0.25, 0.0, 0.0));
    CHECK_FALSE(may_start(sign * 0.2501, 0.0, 0.0));
    CHECK(may_start(0.0, sign * 0.25, 0.0));
    CHECK_FALSE(may_start(0.0, sign * 0.2501, 0.0));
    CHECK(may_start(0.15 * sign, -0.1999 * sign, 0.0));
    CHECK_FALSE(may_start(0.15 * sign, -0.2001 * sign, 0.0));
    CHECK(may_start(0.0, 0.0, sign * 11.99));
    CHECK_FALSE(may_start(0.0, 0.0, sign * 12.01));
    CHECK_FALSE(may_start(sign * 0.3, 0.0, sign * 5.0));
    CHECK_FALSE(may_start(sign * 0.1, 0.0, sign * 13.0));
  }
}

TEST_CASE("What is wrong with a start is told with both distances, both limits and the place") {
  Person person{.has_agreed = true};
  StartGate gate({.within_m = 0.07, .within_deg = 6.5}, {0.4, -1.2, geometry::RadFromDeg(-30.0)},
                 false, person.AtTerminal());
  gate.MayStart(0.0, geometry::Pose2{0.7, -0.8, geometry::RadFromDeg(-47.3)});
  CHECK(
      person.told ==
      std::vector<std::string>{
          "not started: the robot stands 0.500 m and 17.3 deg off its start, and 0.07 m and 6.5 "
          "deg are allowed (hardware.start): put it on x 0.400 m, y -1.200 m, heading -30 deg, or "
          "give --any-start; then Enter"});
}

TEST_CASE("A robot that is not seen is told so at once, and refused after more than ten seconds") {
  Person person{.has_agreed = true};
  StartGate gate({.countdown_s = 0.0}, kStart, false, person.AtTerminal());
  gate.MayStart(20.0, std::nullopt);
  CHECK(person.shown == std::vector<std::string>{"put the robot at the start: it is not seen"});
  gate.MayStart(30.0, std::nullopt);
  CHECK(person.has_agreed);
  CHECK(person.told.empty());
  gate.MayStart(30.0625, std::nullopt);
  CHECK_FALSE(person.has_agreed);
  CHECK(person.told ==
        std::vector<std::string>{
            "not started: the robot has not been seen for 10 s: see to it that its tag is in the "
            "picture, flat and well lit; then Enter"});
}

}  // namespace
}  // namespace rift::sessions
