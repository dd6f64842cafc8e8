#include "rift/hardware/options.hpp"

#include <catch2/catch.hpp>

#include "rift/hardware/ping.hpp"
#include "rift/hardware/wire.hpp"

namespace rift::hardware {
namespace {

TEST_CASE("The stopping distance is the speed's way in watchdog and delay, and the braking") {
  const StoppingOptions options{
      .full_power_speed_mps = 1.6, .braking_mps2 = 2.0, .robot_watchdog_s = 0.3, .delay_s = 0.1};
  // 0.8 m/s for 0.4 s, and 0.64 / 4 m.
  CHECK(StoppingDistance_m(options, 0.5) == Approx(0.32 + 0.16));
  CHECK(StoppingDistance_m(options, 1.0) == Approx(0.64 + 0.64));
  CHECK(StoppingDistance_m(options, 0.0) == 0.0);
  // A camera that is blind for longer than the watchdog waits; one that is not changes nothing.
  CHECK(StoppingDistance_m(options, 0.5, options.robot_watchdog_s + 0.1) ==
        Approx(0.32 + 0.16 + 0.08));
  CHECK(StoppingDistance_m(options, 0.5, options.robot_watchdog_s - 0.1) == Approx(0.32 + 0.16));
}

TEST_CASE("A heartbeat must be shorter than the lag that stops a drive") {
  HardwareOptions options;
  options.guard.link_lag_s = 0.125;
  options.line.heartbeat_s = 0.1249;
  CHECK_NOTHROW(options.Check());
  options.line.heartbeat_s = 0.125;
  CHECK_THROWS_WITH(options.Check(),
                    "line.heartbeat_s is 0.125, and it must be below "
                    "guard.link_lag_s, which is 0.125");
}

TEST_CASE("A plain command has up to 64 bytes, whichever wheel makes it long") {
  const auto check = [](const std::string& format) { PlainOptions{.format = format}.Check(); };
  // "-1.00 0.00" and the line ending are 11 bytes.
  CHECK_NOTHROW(check(std::string(53, 'x') + "{left:.2f} {right:.2f}\n"));
  CHECK_THROWS_WITH(check(std::string(54, 'x') + "{left:.2f} {right:.2f}\n"),
                    Catch::Contains("but a command of it has 65 bytes: at most 64"));
  CHECK_THROWS_WITH(check("\t{left:.2f}\r"),
                    Catch::Contains(R"(format is "\t{left:.2f}\r", but the right power is not)"));
  CHECK_THROWS_WITH(check("{left:.2f}|{left:.2f}{right:.0f}{left:.2f}"),
                    Catch::Contains("a command must end with a line ending"));
}

PingResult Good() {
  return {hardware::Protocol::kFramed, 400, 380, 0.05, 3, 0.03, 0.05, 0.15, 0.2, 0.006, 5.0};
}

TEST_CASE("A link keeps its budget at each limit and breaks it beyond, told with both numbers") {
  const PingOptions options{.max_p99_s = 0.15, .max_loss = 0.05, .max_burst = 3};
  CHECK(BrokenBudget(Good(), options).empty());
  PingResult slow = Good();
  slow.p99_s = 0.1501;
  REQUIRE(BrokenBudget(slow, options).size() == 1);
  CHECK_THAT(BrokenBudget(slow, {.max_p99_s = 0.1})[0],
             Catch::StartsWith("99 % of the round trips take up to 0.150 s, and the budget is "
                               "0.100 s"));
  PingResult lossy = Good();
  lossy.loss = 0.0625;
  REQUIRE(BrokenBudget(lossy, options).size() == 1);
  CHECK_THAT(BrokenBudget(lossy, options)[0],
             Catch::StartsWith("6.2 % of the commands are lost, and the budget is 5.0 %"));
  PingResult bursts = Good();
  bursts.longest_burst = 4;
  REQUIRE(BrokenBudget(bursts, options).size() == 1);
  CHECK_THAT(BrokenBudget(bursts, options)[0],
             Catch::StartsWith("4 commands in a row were lost, and the budget is 3"));
  slow.loss = 0.5;
  slow.longest_burst = 9;
  CHECK(BrokenBudget(slow, options).size() == 3);
  slow.protocol = Protocol::kPlain;
  CHECK(BrokenBudget(slow, options).empty());
  PingResult silent{.protocol = Protocol::kFramed, .sent = 96};
  REQUIRE(BrokenBudget(silent, options).size() == 1);
  CHECK_THAT(BrokenBudget(silent, options)[0], Catch::StartsWith("none of 96 commands"));
}

}  // namespace
}  // namespace rift::hardware
