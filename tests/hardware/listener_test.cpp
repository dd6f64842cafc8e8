#include "rift/hardware/listener.hpp"

#include <catch2/catch.hpp>
#include <random>

namespace rift::hardware {
namespace {

using Chunk = std::vector<std::uint8_t>;

Chunk Frame(int sequence, MilliPower power) {
  const CommandBytes bytes = Encode(CommandFrame{static_cast<std::uint8_t>(sequence), power});
  return {bytes.begin(), bytes.end()};
}
Chunk Text(const std::string& text) { return {text.begin(), text.end()}; }

TEST_CASE("A million random frames do not move a wheel") {
  std::mt19937_64 random(8);
  Listener listener;
  listener.Poll(0, Frame(1, {}), {});
  for (int i = 0; i < 1'000'000; ++i) {
    CommandBytes bytes;
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    bytes[0] = CommandFrame::kStart;
    listener.Poll(static_cast<std::uint32_t>(i), bytes, {});
    REQUIRE(listener.Motors().IsZero());
  }
}

TEST_CASE("A frame is obeyed once and only when it is newer than the last") {
  Listener listener;
  listener.Poll(0, Frame(10, {}), {});
  CHECK_FALSE(listener.Poll(1, Frame(11, {100, 100}), {}).empty());
  CHECK(listener.Motors() == MilliPower{100, 100});
  CHECK(listener.Poll(2, Frame(11, {100, 100}), {}).empty());
  CHECK(listener.Poll(3, Frame(9, {200, 200}), {}).empty());
  CHECK(listener.Poll(4, Frame(11 + 128, {200, 200}), {}).empty());
  CHECK(listener.Motors() == MilliPower{100, 100});
  listener.Poll(5, Frame(9, {}), {});
  CHECK(listener.Motors().IsZero());
  // The doubled frame has not fed the watchdog.
  listener.Poll(6, Frame(12, {100, 100}), {});
  listener.Poll(200, Frame(12, {100, 100}), {});
  listener.Poll(306, {}, {});
  CHECK(listener.Motors().IsZero());
}

TEST_CASE("A frame is newer when its number is one to 127 ahead, through the wrap as well") {
  for (const int before : {0, 10, 200, 255}) {
    for (const auto& [ahead, is_obeyed] :
         {std::pair{1, true}, {127, true}, {128, false}, {255, false}, {0, false}}) {
      Listener listener;
      listener.Poll(0, Frame(before, {}), {});
      listener.Poll(1, Frame(before + ahead, {100, -200}), {});
      INFO(before << " + " << ahead);
      CHECK(listener.Motors() == (is_obeyed ? MilliPower{100, -200} : MilliPower{}));
      CHECK(listener.Rejected() == (is_obeyed ? 0 : 1));
    }
  }
}

TEST_CASE(
    "A plain line of the longest kind is obeyed and one byte more makes it noise to its end") {
  Listener listener;
  listener.Poll(0, Text("-0.85 -0.90\n"), {});
  CHECK(listener.Motors() == MilliPower{-850, -900});
  listener.Poll(1, Text("-0.85 -0.900"), {});
  CHECK(listener.Rejected() == 1);
  listener.Poll(2, Text("\n0.10 0.20\n"), {});
  CHECK(listener.Motors() == MilliPower{100, 200});
  CHECK(listener.Rejected() == 1);
}

TEST_CASE("Plain lines are answered five times a second and frames each time") {
  Listener listener;
  std::vector<int> answered_ms;
  for (int ms = 0; ms <= 450; ++ms) {
    const Chunk said =
        listener.Poll(static_cast<std::uint32_t>(ms), Text("0.10 0.10\n"), {7, -8, 9});
    if (said.empty()) continue;
    answered_ms.push_back(ms);
    CHECK(std::string(said.begin(), said.end()) == AnswerLine(Answer{{}, 0, 7, -8, 9, 0}));
  }
  CHECK(answered_ms == std::vector{0, 200, 400});
  const Chunk frame = listener.Poll(451, Frame(3, {}), {1, 2, 3});
  CHECK(DecodeAnswer(frame) == Answer{3, 0, 1, 2, 3, 0});
}

TEST_CASE("A module that lost its partner stops the robot at once and counts as a stop") {
  Listener listener;
  listener.Poll(0, Text("0.50 0.60\n"), {});
  listener.Poll(1, Text("OK+LOS"), {});
  CHECK(listener.Motors() == MilliPower{500, 600});
  listener.Poll(2, Text("T"), {});
  CHECK(listener.Motors().IsZero());
  CHECK(listener.Stops() == 1);
  listener.Poll(1000, {}, {});
  CHECK(listener.Stops() == 1);  // it stands already
}

TEST_CASE("After it has stopped by itself a zero must come before frames move it again") {
  Listener listener;
  listener.Poll(0, Frame(1, {300, 300}), {});
  CHECK(listener.Motors().IsZero());  // just switched on
  listener.Poll(1, Frame(2, {}), {});
  listener.Poll(2, Frame(3, {300, 300}), {});
  CHECK(listener.Motors() == MilliPower{300, 300});
  listener.Poll(302, Frame(4, {300, 300}), {});
  CHECK(listener.Motors().IsZero());
  CHECK(listener.Stops() == 1);
  listener.Poll(303, Frame(5, {}), {});
  listener.Poll(304, Frame(6, {300, 300}), {});
  CHECK(listener.Motors() == MilliPower{300, 300});
}

TEST_CASE("The authors' lines are obeyed as they come and held for the watchdog's time") {
  Listener listener;
  listener.Poll(0, Text("0.85 -0.90\n"), {});
  CHECK(listener.Motors() == MilliPower{850, -900});
  listener.Poll(299, Text("0.8 0.90\n85 0.90\n1.01 0.00\nnan nan\n"), {});
  CHECK(listener.Motors() == MilliPower{850, -900});
  CHECK(listener.Rejected() == 4);
  listener.Poll(300, {}, {});
  CHECK(listener.Motors().IsZero());
}

TEST_CASE("While frames come no plain line moves the robot but one stops it") {
  Listener listener;
  listener.Poll(0, Frame(1, {}), {});
  listener.Poll(1, Frame(2, {300, 300}), {});
  listener.Poll(2, Text("0.85 0.85\n"), {});
  CHECK(listener.Motors() == MilliPower{300, 300});
  listener.Poll(3, Text("0.00 0.00\n"), {});
  CHECK(listener.Motors().IsZero());
}

}  // namespace
}  // namespace rift::hardware
