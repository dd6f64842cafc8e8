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
