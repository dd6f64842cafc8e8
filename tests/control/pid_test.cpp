#include "rift/control/pid.hpp"

#include <catch2/catch.hpp>

namespace rift::control {
namespace {

TEST_CASE("A steady error gives the proportional output and a growing integral") {
  Pid pid({2.0, 0.5, 0.0}, 100.0, false);
  CHECK(pid.Step(0.1, 3.0) == Approx(2.0 * 3.0 + 0.5 * 0.3));
  CHECK(pid.Step(0.1, 3.0) == Approx(2.0 * 3.0 + 0.5 * 0.6));
}

TEST_CASE("The integral stops at its limit and leaves it as soon as the error turns") {
  Pid pid({0.0, 1.0, 0.0}, 2.0, false);
  for (int i = 0; i < 1000; ++i) CHECK(pid.Step(0.1, 1.0) <= 2.0);
  CHECK(pid.integral() == 2.0);
  CHECK(pid.Step(0.1, -1.0) == Approx(1.9));
}

TEST_CASE("A ramp gives its slope as derivative") {
  Pid pid({0.0, 0.0, 0.3}, 2.0, false);
  CHECK(pid.Step(0.02, 1.0) == 0.0);
  CHECK(pid.Step(0.02, 1.04) == Approx(0.3 * 2.0));
}

TEST_CASE("With the kick the first error is a step up from zero") {
  Pid pid({0.0, 0.0, 0.01}, 2.0, true);
  CHECK(pid.Step(0.032, 0.32) == Approx(0.1));
  CHECK(pid.Step(0.032, 0.32) == Approx(0.0).margin(1e-12));
}

TEST_CASE("A reset loop answers like a new one") {
  for (const bool kick : {false, true}) {
    Pid used({0.9, 0.2, 0.01}, 2.0, kick), fresh({0.9, 0.2, 0.01}, 2.0, kick);
    used.Step(0.02, 5.0);
    used.Step(0.02, -3.0);
    used.Reset();
    CHECK(used.Step(0.02, 0.4) == fresh.Step(0.02, 0.4));
  }
}

}  // namespace
}  // namespace rift::control
