#include "rift/hardware/arming.hpp"

#include <termios.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <string>
#include <utility>
#include <vector>

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

TEST_CASE("What is asked before the start is told once, and either end of a line answers it") {
  for (const char enter : {'\n', '\r'}) {
    Keyboard keyboard;
    Operator person(false);
    Listening listening;
    for (int i = 0; i < 3; ++i) CHECK_FALSE(person.MayArm(listening.say));
    CHECK(listening.told ==
          std::vector<std::string>{
              "hands off? Enter starts the robot, then any key stops it (before: q gives up)"});
    keyboard.Type(enter);
    CHECK_FALSE(person.Stopper()());
    CHECK(person.MayArm(listening.say));
    CHECK_FALSE(person.Stopper()());
    keyboard.Type(enter);
    const auto stop = person.Stopper()();
    REQUIRE(stop);
    CHECK(*stop == std::pair(StopReason::kOperator, std::string("a key was pressed")));
  }
}

TEST_CASE("A signal and a closed window stop a robot before any key, each for its own reason") {
  Keyboard keyboard;
  Operator person(true);
  person.CloseWindow();
  keyboard.Type('a');
  CHECK(*person.Stopper()() ==
        std::pair(StopReason::kOperator, std::string("the window was closed")));
  std::raise(SIGTERM);
  CHECK(*person.Stopper()() == std::pair(StopReason::kSignal, std::string("SIGTERM came")));
}

TEST_CASE("Keys come at once and unseen while a robot is driven, and the terminal is as before") {
  const Keyboard keyboard;
  const auto settings = [] {
    termios now{};
    REQUIRE(::tcgetattr(STDIN_FILENO, &now) == 0);
    return now;
  };
  const termios before = settings();
  REQUIRE((before.c_lflag & (ICANON | ECHO | ISIG)) == (ICANON | ECHO | ISIG));
  {
    const Operator person(true);
    const termios now = settings();
    CHECK((now.c_lflag & (ICANON | ECHO)) == 0);
    CHECK((now.c_lflag & ISIG) != 0);  // Ctrl-C is a signal
    CHECK((now.c_iflag & IXON) == 0);
    CHECK(now.c_cc[VMIN] == 0);
    CHECK(now.c_cc[VTIME] == 0);
  }
  const termios after = settings();
  CHECK(after.c_lflag == before.c_lflag);
  CHECK(after.c_iflag == before.c_iflag);
  CHECK(after.c_cc[VMIN] == before.c_cc[VMIN]);
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
