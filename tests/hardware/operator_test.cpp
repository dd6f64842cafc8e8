#include "rift/hardware/arming.hpp"

#include <catch2/catch.hpp>
#include <csignal>

#include "keyboard.hpp"

namespace rift::hardware {
namespace {

struct Listening {
  std::vector<std::string> told;
  std::function<void(const std::string&)> say = [this](const std::string& line) {
    told.push_back(line);
  };
};

TEST_CASE("Enter starts the robot once it was asked for and the next key stops it") {
  Keyboard keyboard;
  Operator person(false);
  const hardware::Stopper stopper = person.Stopper();
  Listening listening;
  keyboard.Type('\n');  // before anybody asked
  CHECK_FALSE(stopper());
  CHECK_FALSE(person.MayArm(listening.say));
  CHECK_FALSE(person.MayArm(listening.say));
  CHECK(listening.told.size() == 1);
  keyboard.Type('x');
  CHECK_FALSE(stopper());
  CHECK_FALSE(person.MayArm(listening.say));
  keyboard.Type('\n');
  CHECK_FALSE(stopper());
  CHECK(person.MayArm(listening.say));
  keyboard.Type(' ');
  REQUIRE(stopper());
  CHECK(stopper()->first == hardware::StopReason::kOperator);
}

TEST_CASE("A start that was taken back is given by the next Enter and no key before it stops") {
  Keyboard keyboard;
  Operator person(false);
  const hardware::Stopper stopper = person.Stopper();
  Listening listening;
  person.MayArm(listening.say);
  keyboard.Type('\n');
  CHECK_FALSE(stopper());
  CHECK(person.MayArm(listening.say));
  person.AskAgain();
  CHECK_FALSE(person.MayArm(listening.say));
  keyboard.Type('x');
  CHECK_FALSE(stopper());
  keyboard.Type('\n');
  CHECK_FALSE(stopper());
  CHECK(person.MayArm(listening.say));
}

TEST_CASE("Before the start q gives up") {
  Keyboard keyboard;
  Operator person(false);
  keyboard.Type('q');
  REQUIRE(person.Stopper()());
  CHECK(person.Stopper()()->second == "a key was pressed");
}

TEST_CASE("With a yes nothing is asked and a key or a signal or the window stops") {
  const auto stops_by = [](const auto& strike) {
    Keyboard keyboard;
    Operator person(true);
    Listening listening;
    CHECK(person.MayArm(listening.say));
    CHECK(listening.told.empty());
    CHECK_FALSE(person.Stopper()());
    strike(keyboard, person);
    return person.Stopper()().value().second;
  };
  CHECK(stops_by([](Keyboard& keyboard, Operator&) { keyboard.Type('a'); }) == "a key was pressed");
  CHECK(stops_by([](Keyboard&, Operator&) { std::raise(SIGHUP); }) == "SIGHUP came");
  CHECK(stops_by([](Keyboard&, Operator& person) { person.CloseWindow(); }) ==
        "the window was closed");
}

TEST_CASE("The keys that hold and release a terminal's output stop a robot as any other") {
  for (const char key : {'\x13', '\x11'}) {
    Keyboard keyboard;
    Operator person(true);
    CHECK_FALSE(person.Stopper()());
    keyboard.Type(key);
    CHECK(person.Stopper()().value().second == "a key was pressed");
  }
}

TEST_CASE("A terminal that goes away stops the robot, whoever said yes") {
  for (const bool says_yes : {true, false}) {
    Keyboard keyboard;
    Operator person(says_yes);
    Listening listening;
    person.MayArm(listening.say);
    CHECK_FALSE(person.Stopper()());
    keyboard.HangUp();
    const auto stop = person.Stopper()();
    REQUIRE(stop);
    CHECK(stop->first == StopReason::kOperator);
    CHECK(stop->second == "the terminal went away, and no key could stop the robot");
    CHECK_FALSE(person.MayArm(listening.say) != says_yes);
  }
}

}  // namespace
}  // namespace rift::hardware
