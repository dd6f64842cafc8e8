#include "rift/hardware/ping.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "bench.hpp"

namespace rift::hardware {
namespace {

TEST_CASE("Ping measures the round trip of a link whose delay is known") {
  Bench bench;
  bench.line_delay_s = 0.03;
  const PingResult result = Ping(bench, bench, {}, Protocol::kFramed, {});
  // Twice the radio and the bytes of command and answer at 9600 baud.
  const double expected_s = 2 * 0.03 + (11 + 15) * 10.0 / 9600.0;
  CHECK(result.p50_s == Approx(expected_s).margin(0.003));
  CHECK(result.max_s == Approx(expected_s).margin(0.004));
  CHECK(result.jitter_s < 0.002);
  CHECK(result.loss == 0.0);
  CHECK(result.longest_burst == 0);
  CHECK(result.sent == Approx(3.0 / 0.03125).margin(4));
  CHECK(result.battery_v == Approx(5.0));
  CHECK(BrokenBudget(result, {}).empty());
  CHECK(bench.obeyed == std::set<std::pair<int, int>>{{0, 0}});
}

TEST_CASE("The delay for the simulated link is that of the radio, without the bytes of both ways") {
  for (const double delay_s : {0.02, 0.034}) {
    Bench bench;
    bench.line_delay_s = delay_s;
    const PingResult result = Ping(bench, bench, {}, Protocol::kFramed, {});
    CHECK(RadioDelay_s(result, {}) == Approx(delay_s).margin(0.0015));
    // At 1200 baud the bytes alone take longer than the whole round trip did.
    CHECK(RadioDelay_s(result, {.baud = 1200}) == 0.0);
    CHECK(RadioDelay_s(result, {.baud = 4'000'000}) == Approx(result.OneWay_s()).margin(1e-4));
  }
  CHECK(RadioDelay_s({}, {}) == -1.0);
}

TEST_CASE("Jitter is the mean change from one round trip to the next") {
  Bench bench;
  bench.line_delay_s = 0.005;
  // Every second command and its answer take 8 ms longer: after the first two, 22.9 ms apart for
  // the bytes of a command, one is sent each 31.25 ms.
  bench.extra_delay_s = [&bench] {
    return std::fmod(bench.Now_s() - 100.0 + 0.0625 - 0.019, 0.0625) < 0.03125 ? 0.0 : 0.008;
  };
  const PingResult result = Ping(bench, bench, {}, Protocol::kFramed, {});
  CHECK(result.loss == 0.0);
  CHECK(result.jitter_s == Approx(0.016).margin(0.0015));
  CHECK(result.max_s == Approx(2 * 0.013 + (11 + 15) * 10.0 / 9600.0).margin(0.003));
}

TEST_CASE("The quantiles of a ping are the round trips that 50, 95 and 99 of 100 do not exceed") {
  const auto ping = [](int every) {
    Bench bench;
    bench.line_delay_s = 0.005;
    int commands = 0;
    bench.lose_command = [&] { return ++commands < 0; };
    // One round trip of `every` takes 16 ms longer: 8 ms there and 8 ms back.
    bench.extra_delay_s = [&, every] { return commands % every == 0 ? 0.008 : 0.0; };
    const PingResult result = Ping(bench, bench, {}, Protocol::kFramed, {});
    CHECK(result.sent == Approx(96).margin(2));
    return result;
  };
  const double usual_s = 2 * 0.005 + (11 + 15) * 10.0 / 9600.0, slow_s = usual_s + 0.016;
  const PingResult some = ping(14);  // six of 96
  CHECK(some.p50_s == Approx(usual_s).margin(0.002));
  CHECK(some.p95_s == Approx(slow_s).margin(0.002));
  CHECK(some.p99_s == Approx(slow_s).margin(0.002));
  const PingResult few = ping(40);  // two
  CHECK(few.p50_s == Approx(usual_s).margin(0.002));
  CHECK(few.p95_s == Approx(usual_s).margin(0.002));
  CHECK(few.p99_s == Approx(slow_s).margin(0.002));
}

TEST_CASE("Ping counts what was lost and for how long in a row") {
  Bench lossy;
  int commands = 0;
  lossy.lose_command = [&] { return ++commands % 20 < 4; };
  const PingResult result = Ping(lossy, lossy, {}, Protocol::kFramed, {});
  CHECK(result.loss == Approx(0.2).margin(0.03));
  CHECK(result.longest_burst == 4);
  CHECK(BrokenBudget(result, {}).size() == 2);
}

TEST_CASE("A link without an answer breaks the budget and a plain robot is not measured") {
  Bench deaf;
  deaf.to_robot_is_cut = true;
  const PingResult result = Ping(deaf, deaf, {}, Protocol::kFramed, {.duration_s = 1.0});
  CHECK_FALSE(result.IsMeasured());
  REQUIRE(BrokenBudget(result, {}).size() == 1);
  CHECK_THAT(BrokenBudget(result, {})[0], Catch::Contains("is the robot on"));
  CHECK(Ping(deaf, deaf, {}, Protocol::kPlain, {}).sent == 0);
}

TEST_CASE("The last commands of a ping may be answered within half a second, and no later") {
  // Command and answer take 0.027 s on the line, and the radio twice its delay.
  for (const auto& [delay_s, is_in_time] : {std::pair{0.225, true}, {0.29, false}}) {
    Bench bench;
    bench.line_delay_s = delay_s;
    const PingResult result = Ping(bench, bench, {}, Protocol::kFramed, {.duration_s = 1.0});
    INFO(delay_s << ": " << result.answered << " of " << result.sent);
    CHECK((result.answered == result.sent) == is_in_time);
    CHECK(result.answered + 6 >= result.sent);
    CHECK(result.max_s == Approx(2 * delay_s + (11 + 15) * 10.0 / 9600.0).margin(0.02));
    if (!is_in_time) CHECK(result.longest_burst == result.sent - result.answered);
  }
}

TEST_CASE("What breaks the budget of a link is told in whole, the worst of each") {
  const PingResult result{.protocol = Protocol::kFramed,
                          .sent = 400,
                          .answered = 350,
                          .loss = 0.125,
                          .longest_burst = 7,
                          .p50_s = 0.03,
                          .p95_s = 0.11,
                          .p99_s = 0.2346,
                          .max_s = 0.4};
  const std::vector<std::string> broken =
      BrokenBudget(result, {.max_p99_s = 0.1234, .max_loss = 0.0376, .max_burst = 2});
  REQUIRE(broken.size() == 3);
  CHECK(broken[0] ==
        "99 % of the round trips take up to 0.235 s, and the budget is 0.123 s: bring the robot "
        "nearer, ask for a shorter BLE connection interval, or raise the baud rate");
  CHECK(broken[1] ==
        "12.5 % of the commands are lost, and the budget is 3.8 %: lower hardware.line.line_share, "
        "or keep other radios away");
  CHECK(broken[2] ==
        "7 commands in a row were lost, and the budget is 2: the robot would stop by itself; look "
        "for what interrupts the radio");
  const PingResult silent{.protocol = Protocol::kFramed, .sent = 61};
  REQUIRE(BrokenBudget(silent, {}).size() == 1);
  CHECK(BrokenBudget(silent, {})[0] ==
        "none of 61 commands was answered: is the robot on, paired, and running rift's listener at "
        "this baud rate?");
}

TEST_CASE("The hello finds frames on a listener of ours and plain where nothing is said") {
  Bench ours;
  CHECK(FindProtocol(ours, ours, {}) == Protocol::kFramed);
  Bench silent;
  silent.from_robot_is_cut = true;
  CHECK(FindProtocol(silent, silent, {}) == Protocol::kPlain);
  CHECK(FindProtocol(silent, silent, {.protocol = Protocol::kFramed}) == Protocol::kFramed);
}

TEST_CASE("At most half of the line is used whatever is commanded") {
  Bench bench;
  RobotLink link(bench, {}, Protocol::kFramed);
  for (int i = 0; i < 10'000; ++i) {
    link.Put({0.0001 * (i % 100), 0.0}, true);
    link.Tick(bench.Now_s());
    bench.Wait(0.001);
  }
  const size_t bytes = link.sent_count() * Answer::kSize;
  CHECK(bytes <= 4800 + Answer::kSize);  // half of ten seconds at 960 bytes a second
  CHECK(bytes >= 4300);
}

}  // namespace
}  // namespace rift::hardware
