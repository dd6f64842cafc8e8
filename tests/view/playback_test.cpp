#include "rift/view/film.hpp"

#include <catch2/catch.hpp>

namespace rift::view {
namespace {

constexpr int kRightArrow = 0xFF53, kLeftArrow = 0xFF51;

TEST_CASE("A window plays at its speed up to the end") {
  Playback playback{.speed = 2.0};
  playback = AfterTime(playback, 0.5, 3.0);
  CHECK(playback.t_s == 1.0);
  CHECK(AfterTime(playback, 10.0, 3.0).t_s == 3.0);
}

TEST_CASE("Space stops the clock and starts it again") {
  Playback playback = AfterKey({}, ' ');
  CHECK(AfterTime(playback, 1.0, 3.0).t_s == 0.0);
  playback = AfterKey(playback, ' ');
  CHECK(AfterTime(playback, 1.0, 3.0).t_s == 1.0);
}

TEST_CASE("Arrows change the speed within bounds") {
  CHECK(AfterKey({}, kRightArrow).speed == 2.0);
  CHECK(AfterKey({}, kLeftArrow).speed == 0.5);
  Playback playback;
  for (int i = 0; i < 50; ++i) playback = AfterKey(playback, kLeftArrow);
  CHECK(playback.speed > 0.0);
}

TEST_CASE("The end is held as long as it is not paused") {
  Playback playback = AfterTime({}, 5.0, 3.0);
  CHECK(playback.over_since_s == 0.0);
  CHECK(AfterTime(playback, 1.5, 3.0).over_since_s == 1.5);
  CHECK(AfterTime(AfterKey(playback, ' '), 1.5, 3.0).over_since_s == 0.0);
}

TEST_CASE("Leaving and starting over have keys and no key changes nothing") {
  CHECK(AfterKey({}, 'q').left);
  CHECK(AfterKey({}, 27).left);
  CHECK_FALSE(AfterKey({}, -1).left);
  const Playback over{.t_s = 3.0, .over_since_s = 2.0};
  CHECK(AfterKey(over, 'r').t_s == 0.0);
  CHECK_FALSE(AfterKey({.paused = true}, 'r').paused);
  CHECK_FALSE(AfterKey({.paused = true}, 'R').paused);
  CHECK(AfterKey(over, 'r').over_since_s == 0.0);
}

TEST_CASE("Speeds double and halve between a 32nd and 64 times, by either pair of arrows") {
  constexpr int kUpArrow = 0xFF52, kDownArrow = 0xFF54;
  for (const auto& [faster, slower] :
       {std::pair{kRightArrow, kLeftArrow}, {kUpArrow, kDownArrow}}) {
    Playback playback;
    for (const double speed : {2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 64.0}) {
      playback = AfterKey(playback, faster);
      CHECK(playback.speed == speed);
    }
    playback.speed = 0.125;
    for (const double speed : {0.0625, 0.03125, 0.03125}) {
      playback = AfterKey(playback, slower);
      CHECK(playback.speed == speed);
    }
    CHECK((!playback.paused && !playback.left && playback.t_s == 0.0));
  }
  for (const int other : {-1, int{'x'}, 0, 26, 28, 31, 33, 0xFF50, 0xFF55}) {
    const Playback playback = AfterKey({.t_s = 1.0, .paused = true}, other);
    CHECK((playback.t_s == 1.0 && playback.paused && !playback.left && playback.speed == 1.0));
  }
  CHECK(AfterKey({}, 'Q').left);
}

TEST_CASE("The end is held from when it was reached, in the window's time") {
  Playback playback{.t_s = 2.5, .speed = 4.0};
  playback = AfterTime(playback, 0.25, 3.0);
  CHECK((playback.t_s == 3.0 && playback.over_since_s == 0.0));
  playback = AfterTime(playback, 0.25, 3.0);
  CHECK((playback.t_s == 3.0 && playback.over_since_s == 0.25));
}

}  // namespace
}  // namespace rift::view
