#include "rift/simulation/link.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

namespace rift::simulation {
namespace {

LinkOptions Direct() {
  LinkOptions options;
  options.delay_s = 0.0;
  options.baud = 0.0;
  options.poll_s = 0.0;
  return options;
}

/// The first moment, to a millisecond, at which the link holds the power.
double HeldFrom_s(Link& link, double left, double until_s) {
  for (int i = 0; i <= std::lround(until_s * 1000); ++i) {
    link.Advance(0.001 * i);
    if (link.Held().left == left) return 0.001 * i;
  }
  return -1.0;
}

TEST_CASE("A link without any delay passes a command at once") {
  Link link(Direct(), 1);
  link.Send(0.0, {0.25, -0.5});
  link.Advance(0.0);
  CHECK(link.Held() == control::WheelPower{0.25, -0.5});
}

TEST_CASE("A step sees the mean of the power over it") {
  LinkOptions options = Direct();
  options.delay_s = 0.003;
  Link link(options, 1);
  link.Send(0.0, {0.4, 0.8});
  const control::WheelPower mean = link.Advance(0.004);
  CHECK(mean.left == Approx(0.1));
  CHECK(mean.right == Approx(0.2));
  CHECK(link.Advance(0.008).left == Approx(0.4));
}

TEST_CASE("A command arrives after the radio and the time of its line") {
  LinkOptions options = Direct();
  options.delay_s = 0.040;
  options.baud = 9600.0;
  Link link(options, 1);
  link.Send(0.0, {0.20, 0.15});  // "0.20 0.15\n": 10 bytes of 10 bits
  CHECK(HeldFrom_s(link, 0.20, 0.2) == Approx(0.040 + 100.0 / 9600.0).margin(0.001));
}

TEST_CASE("Lines wait for the one before them on the wire") {
  LinkOptions options = Direct();
  options.baud = 1000.0;
  Link link(options, 1);
  link.Send(0.0, {0.20, 0.20});
  link.Send(0.0, {0.30, 0.30});
  CHECK(HeldFrom_s(link, 0.30, 0.5) == Approx(0.200).margin(0.001));
}

TEST_CASE("Powers travel with two decimals or exactly") {
  LinkOptions options = Direct();
  Link rounded(options, 1);
  rounded.Send(0.0, {0.123456, -0.987});
  rounded.Advance(0.0);
  CHECK(rounded.Held() == control::WheelPower{0.12, -0.99});
  options.two_decimals = false;
  Link exact(options, 1);
  exact.Send(0.0, {0.123456, -1.0 / 3.0});
  exact.Advance(0.0);
  CHECK(exact.Held() == control::WheelPower{0.123456, -1.0 / 3.0});
}

TEST_CASE("A listener that polls holds its command until the next poll") {
  LinkOptions options = Direct();
  options.poll_s = 0.1;
  double previous_s = -1.0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Link link(options, seed);
    link.Send(0.0, {0.2, 0.2});
    const double first_s = HeldFrom_s(link, 0.2, 0.2);
    CHECK(first_s >= 0.0);
    CHECK(first_s <= 0.101);
    CHECK(first_s != previous_s);  // each seed finds the listener elsewhere in its interval
    previous_s = first_s;
    link.Send(first_s + 0.001, {0.3, 0.3});
    link.Advance(first_s + 0.098);
    CHECK(link.Held().left == 0.2);
    link.Advance(first_s + 0.101);
    CHECK(link.Held().left == 0.3);
  }
}

TEST_CASE("The phase of a listener can be given instead of drawn") {
  LinkOptions options = Direct();
  options.poll_s = 0.1;
  for (const double phase : {0.0, 0.25, 0.999}) {
    options.poll_phase = phase;
    for (const std::uint64_t seed : {1, 2}) {
      Link link(options, seed);
      link.Send(0.0, {0.2, 0.2});
      CHECK(HeldFrom_s(link, 0.2, 0.2) == Approx(0.1 * phase).margin(0.001));
    }
  }
}

/// A line every 20 ms, its left power counting up by 0.01; what is held after 0.9 s.
double AgeOfHeld_s(const LinkOptions& options, std::uint64_t seed) {
  Link link(options, seed);
  double worst_s = 0.0;
  for (int i = 0; i < 90; ++i) {
    link.Send(0.02 * i, {0.01 * i, 0.5});
    link.Advance(0.02 * i + 0.0199);
    if (i > 20) worst_s = std::max(worst_s, 0.02 * (i - std::round(100.0 * link.Held().left)));
  }
  return worst_s;
}

TEST_CASE("A small receive buffer keeps the oldest lines and so ages the command") {
  LinkOptions options = Direct();
  options.poll_s = 0.1;
  options.uart_bytes = 0;
  const double unlimited_s = AgeOfHeld_s(options, 4);
  options.uart_bytes = 32;
  const double small_s = AgeOfHeld_s(options, 4);
  CHECK(unlimited_s <= 0.101);
  CHECK(small_s > unlimited_s + 0.015);
}

TEST_CASE("A line that lost its point arrives as another number and is limited to full power") {
  LinkOptions options = Direct();
  options.byte_loss = 0.1;
  for (const double sign : {1.0, -1.0}) {
    INFO(sign);
    bool saw_full_left = false, saw_full_right = false, saw_wrong = false;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      Link link(options, seed);
      link.Send(0.0, {sign * 0.85, sign * 0.85});
      link.Advance(0.1);
      const control::WheelPower held = link.Held();
      CHECK(std::abs(held.left) <= 1.0);
      CHECK(std::abs(held.right) <= 1.0);
      saw_full_left = saw_full_left || held.left == sign;
      saw_full_right = saw_full_right || held.right == sign;
      saw_wrong = saw_wrong || (held.left != sign * 0.85 && held.left != 0.0);
    }
    CHECK(saw_full_left);
    CHECK(saw_full_right);
    CHECK(saw_wrong);
  }
}

TEST_CASE("Lines get lost as often as asked") {
  LinkOptions options = Direct();
  options.line_loss = 0.25;
  Link link(options, 9);
  int lost = 0;
  for (int i = 0; i < 4000; ++i) {
    const double power = i % 2 ? 0.5 : 0.25;
    link.Send(0.01 * i, {power, i % 100 / 100.0});
    link.Advance(0.01 * i);
    lost += link.Held().left != power || link.Held().right != i % 100 / 100.0;
  }
  CHECK(lost / 4000.0 == Approx(0.25).margin(0.03));
}

TEST_CASE("In the share of the runs that is asked nothing is heard before the link stands") {
  LinkOptions options = Direct();
  options.late_share = 0.25;
  options.late_s = 1.7;
  constexpr int kRuns = 2000;
  int late = 0;
  double sum_s = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    Link link(options, seed);
    link.Send(0.0, {0.5, 0.5});
    link.Advance(0.0);
    if (link.Held().left == 0.5) continue;
    ++late;
    double heard_s = 0.0;
    while (link.Held().left != 0.5 && heard_s < 60.0) {
      heard_s += 0.01;
      link.Send(heard_s, {0.5, 0.5});
      link.Advance(heard_s);
    }
    sum_s += heard_s;
  }
  CHECK(late == Approx(0.25 * kRuns).margin(60.0));
  CHECK(sum_s / late == Approx(1.7).margin(0.25));
}

TEST_CASE("Without a watchdog the last command is held for ever and with one it ends") {
  LinkOptions options = Direct();
  Link forever(options, 1);
  forever.Send(0.0, {0.2, 0.2});
  forever.Advance(100.0);
  CHECK(forever.Held().left == 0.2);
  options.watchdog_s = 0.5;
  Link guarded(options, 1);
  guarded.Send(0.0, {0.2, 0.2});
  CHECK(guarded.Advance(1.0).left == Approx(0.1));
  CHECK(guarded.Held().left == 0.0);
  guarded.Send(1.0, {0.3, 0.3});
  guarded.Advance(1.1);
  CHECK(guarded.Held().left == 0.3);
}

TEST_CASE("An urgent line overtakes those that wait even behind half a line") {
  LinkOptions options = Direct();
  options.baud = 1000.0;
  Link link(options, 1);
  for (int i = 0; i < 20; ++i) link.Send(0.0, {0.2, 0.2});
  link.Advance(0.155);  // within the second line
  link.SendUrgently(0.155, {0.0, 0.0});
  link.Advance(0.155 + 0.111);
  CHECK(link.Held() == control::WheelPower{0.0, 0.0});
  link.Advance(10.0);
  CHECK(link.Held() == control::WheelPower{0.0, 0.0});
}

TEST_CASE("A poll faster than any listener is refused") {
  LinkOptions options;
  options.poll_s = 1e-9;
  CHECK_THROWS_WITH(options.Check(), Catch::Contains("poll_s"));
}

TEST_CASE("Of what waits a listener keeps as many bytes as its buffer holds, to the byte") {
  LinkOptions options = Direct();
  options.poll_s = 0.1;
  options.poll_phase = 0.5;
  // Four lines of ten bytes each before the first look, at 0.05 s.
  const auto held = [&](int bytes) {
    options.uart_bytes = bytes;
    Link link(options, 1);
    for (int i = 1; i <= 4; ++i) link.Send(0.0, {0.1 * i, 0.5});
    link.Advance(0.06);
    return std::pair(link, link.Held().left);
  };
  CHECK(held(0).second == 0.4);
  CHECK(held(40).second == 0.4);
  CHECK(held(39).second == 0.3);
  CHECK(held(30).second == 0.3);
  CHECK(held(29).second == 0.2);
  CHECK(held(9).second == 0.0);
  // Two bytes of the fourth line, "0.", stand before the next one: "0.0.60 0.70".
  Link cut = held(32).first;
  cut.Send(0.1, {0.6, 0.7});
  cut.Advance(0.16);
  CHECK(cut.Held() == control::WheelPower{0.0, 0.6});
  // What is read at once needs no buffer.
  options.poll_s = 0.0;
  options.uart_bytes = 1;
  Link direct(options, 1);
  direct.Send(0.0, {0.25, 0.5});
  direct.Advance(0.0);
  CHECK(direct.Held().right == 0.5);
}

TEST_CASE("A listener looks at its phase and then each poll, for as long as it runs") {
  LinkOptions options = Direct();
  options.poll_s = 0.1;
  options.poll_phase = 0.25;
  Link link(options, 1);
  for (int i = 0; i < 20; ++i) {
    const double look_s = 0.025 + 0.1 * i, power = 0.01 * (i + 1);
    link.Send(look_s - 0.002, {power, -power});
    CHECK(link.Advance(look_s - 0.001).left == Approx(power - 0.01).margin(1e-12));
    link.Advance(look_s + 0.001);
    CHECK(link.Held() == control::WheelPower{power, -power});
  }
  CHECK(link.Advance(2.0).right == -0.2);
  CHECK(link.Advance(2.0) == link.Held());  // no time passed
}

TEST_CASE("A watchdog counts from the last line that was understood") {
  LinkOptions options = Direct();
  options.watchdog_s = 0.5;
  Link link(options, 1);
  link.Send(0.0, {0.2, 0.4});
  link.Advance(0.3);
  link.Send(0.3, {0.2, 0.4});
  CHECK(link.Advance(0.799).right == 0.4);
  CHECK(link.Held().right == 0.4);
  CHECK(link.Advance(0.809).right == Approx(0.04));
  CHECK(link.Held() == control::WheelPower{});
}

TEST_CASE("A poll of a tenth of a millisecond is the fastest, and none at all is allowed") {
  LinkOptions options;
  for (const double good_s : {0.0, 1e-4, 2.0}) {
    options.poll_s = good_s;
    CHECK_NOTHROW(options.Check());
  }
  options.poll_s = 0.99e-4;
  CHECK_THROWS_WITH(options.Check(), "poll_s is 9.9e-05, but it must be 0 or at least 0.0001");
}

}  // namespace
}  // namespace rift::simulation
