// Robots that do not answer, with commands in a format of their own.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "bench.hpp"
#include "rift/hardware/arming.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift::hardware {
namespace {

const PlainOptions kWhole{
    .format = "M {left:d},{right:d}\r\n", .range = {-255.0, 255.0}, .watchdog = Watchdog::kRobot};

TEST_CASE("A command is written in the robot's own format and unit") {
  CHECK(PlainLine({1.0, -1.0}, kWhole) == "M 255,-255\r\n");
  CHECK(PlainLine({0.0, 0.5}, kWhole) == "M 0,127\r\n");
  CHECK(PlainLine({-0.25, 0.0}, {.format = "<{right:+.1f}|{left:+.1f}>\n", .range = {-9.0, 9.0}}) ==
        "<+0.0|-2.2>\n");
  // Servos stand at the middle of their range, and one is mounted the other way round.
  CHECK(PlainLine({0.0, 1.0}, {.format = "{left:.0f} {right:.0f}\n", .range = {180.0, 0.0}}) ==
        "90 0\n");
  CHECK_THROWS_AS(PlainLine({1.01, 0.0}, kWhole), std::invalid_argument);
  CHECK(PlainLine({0.2, -0.2}, kWhole) == "M 51,-51\r\n");  // 0.2 x 255 is a little off 51
}

TEST_CASE("No rounding of a command makes it more than was asked for") {
  const std::vector<PlainOptions> all{
      {},
      kWhole,
      {.format = "{left:.1f}0 {right:+.1f}0\n"},
      {.format = "{left:.2e} {right:g}\n"},
      {.format = "{{{left:>8.3f}}} {right:07.2f} {left:.1f}\n", .range = {100.0, -100.0}},
      {.format = "{left:.0f} {right:.1f}\n", .range = {180.0, 0.0}}};
  for (const PlainOptions& plain : all) {
    const double middle = 0.5 * (plain.range[0] + plain.range[1]);
    const double half = std::abs(0.5 * (plain.range[1] - plain.range[0]));
    const auto shares = [&](double left, double right) {
      std::string line = PlainLine({left, right}, plain);
      std::vector<double> found;
      for (char& c : line)
        c = std::string_view("+-.0123456789e").find(c) == std::string::npos ? ' ' : c;
      std::istringstream words(line);
      for (double value = 0.0; words >> value;) found.push_back(std::abs(value - middle) / half);
      return found;
    };
    for (int i = -1000; i <= 1000; ++i) {
      const double power = 0.001 * i;
      INFO(plain.format << " at " << power);
      const std::vector<double> written = shares(power, power);
      REQUIRE(written.size() >= 2);
      for (const double share : written) {
        CHECK(share <= std::abs(power) + 1e-9);
        CHECK(share >= std::abs(power) - 0.1 - 1e-9);
      }
    }
  }
  CHECK(PlainLine({-0.08, 0.08}, {.format = "{left:.1f}0 {right:.1f}0\n"}) == "-0.00 0.00\n");
}

TEST_CASE("What a format must round down is still as near as its last digit") {
  const PlainOptions fine{.format = "{left:.5f} {right:.5f}\n"};
  CHECK(PlainLine({2.0 / 3.0, -2.0 / 3.0}, fine) == "0.66666 -0.66666\n");
  CHECK(PlainLine({1.0 / 3.0, -1.0 / 6.0}, fine) == "0.33333 -0.16666\n");
}

TEST_CASE("A format that cannot command both wheels is refused with the rule it breaks") {
  const auto refusal = [](const std::string& format, std::vector<double> range = {-1.0, 1.0}) {
    try {
      PlainOptions{.format = format, .range = std::move(range)}.Check();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  CHECK(refusal("{left:.2f} {right:.2f}\n") == "taken");
  CHECK(refusal("{left:d};{right:d}\r", {-100, 100}) == "taken");
  CHECK_THAT(refusal("{left:.2f}\n"), Catch::Contains("the right power is not in it"));
  CHECK_THAT(refusal("{right:.2f}\n"), Catch::Contains("the left power is not in it"));
  CHECK_THAT(refusal("{left:d} {right:d}\n", {-0.4, 0.4}),
             Catch::Contains("the left power is not"));
  CHECK_THAT(refusal("{left:.2f} {right:.2f}"), Catch::Contains("line ending"));
  CHECK(refusal("{left:.0f} {right:d}\n", {180, 0}) == "taken");
  CHECK(refusal("{left:d} {right:d}\n", {-20, 20}) == "taken");
  CHECK_THAT(refusal("{left:d} {right:d}\n", {-19, 19}),
             Catch::Contains("for the left wheel at power") && Catch::Contains("0.05 apart"));
  CHECK_THAT(refusal("{left:.2f} {right:.1f}\n"), Catch::Contains("for the right wheel at power"));
  CHECK_THAT(refusal("{left:d} {right:d}\n"), Catch::Contains("0.05 apart"));
  CHECK_THAT(refusal("{left:d} {right:d}\n", {0, 255}),
             Catch::Contains("128 for the left wheel at zero power") && Catch::Contains("127.5"));
  CHECK(refusal("{left:d} {right:d}\n", {0, 254}) == "taken");
  CHECK_THAT(refusal("{left:x} {right:x}\n", {-255, 255}), Catch::Contains("a decimal number"));
  CHECK_THAT(refusal("{links:.2f} {right:.2f}\n"), Catch::Contains("argument not found"));
  CHECK_THAT(refusal("{left:.2f} {right:.2f\n"), Catch::Contains("format is \"{left:.2f}"));
  CHECK_THAT(refusal("{left:.60f} {right:.60f}\n"), Catch::Contains("at most 64"));
  CHECK_THAT(refusal("{left:.2f} {right:.2f}\n", {1.0}), Catch::Contains("two different numbers"));
  CHECK_THAT(refusal("{left:.2f} {right:.2f}\n", {1.0, 1.0}),
             Catch::Contains("two different numbers"));
}

/// Why a format is refused.
std::string RuleOf(const std::string& format, std::vector<double> range) {
  const PlainOptions plain{.format = format, .range = std::move(range)};
  try {
    plain.Check();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
}

TEST_CASE("Powers that a format writes alike are told with the wheel and both of them") {
  const std::string apart =
      ": powers 0.05 apart must be told apart: write more decimals, or a wider range";
  // One digit: 0.5, 1, and 1.5 is not to become 2.
  CHECK(RuleOf("{left:.1g} {right:.3f}\n", {-10.0, 10.0}) ==
        "format is \"{left:.1g} {right:.3f}\\n\", but it writes 1 for the left wheel at power 0.1 "
        "and at 0.15" +
            apart);
  CHECK(RuleOf("{left:.3f} {right:.1g}\r\n", {10.0, -10.0}) ==
        "format is \"{left:.3f} {right:.1g}\\r\\n\", but it writes -1 for the right wheel at "
        "power 0.1 and at 0.15" +
            apart);
  // Two digits from 1000 down to 0, but none between 1000 and 1050.
  CHECK(RuleOf("{left:.2g} {right:.2g}\n", {2000.0, 0.0}) ==
        "format is \"{left:.2g} {right:.2g}\\n\", but it writes 1000 for the left wheel at power 0 "
        "and at -0.05" +
            apart);
  CHECK(RuleOf("{left:d} {right:.2f}\n", {-19.0, 19.0}) ==
        "format is \"{left:d} {right:.2f}\\n\", but it writes 0 for the left wheel at power 0 and "
        "at 0.05" +
            apart);
}

TEST_CASE("A zero that a format cannot write is told with the wheel and the middle of the range") {
  const std::string rule =
      " wheel at zero power, and the middle of the range is 127.5: write more decimals, or choose "
      "a range whose middle it can write";
  CHECK(RuleOf("{left:.0f} {right:.1f}\n", {0.0, 255.0}) ==
        "format is \"{left:.0f} {right:.1f}\\n\", but it writes 128 for the left" + rule);
  CHECK(RuleOf("{left:.1f} {right:.0f}\n", {0.0, 255.0}) ==
        "format is \"{left:.1f} {right:.0f}\\n\", but it writes 128 for the right" + rule);
}

TEST_CASE("A line that does not say which wheel is meant is refused, and so is one of no number") {
  // Both wheels stand at 1: 11 and 1 for the left wheel, 1 and 11 for the right one.
  CHECK(RuleOf("{left:.0f}{right:.0f}\n", {-9.0, 11.0}) ==
        "format is \"{left:.0f}{right:.0f}\\n\", but left and right cannot be told apart");
  CHECK(RuleOf("{left:.0f},{right:.0f}\n", {-39.0, 41.0}) == "taken");
  for (const char* type : {"x", "X", "o", "b", "B", "a", "A", "c", "s", "p"}) {
    const std::string format = fmt::format("{{left:{}}} {{right:.2f}}\n", type);
    INFO(format);
    CHECK(RuleOf(format, {-100.0, 100.0}) ==
          fmt::format("format is \"{{left:{}}} {{right:.2f}}\\n\", but a power must be a decimal "
                      "number: write {{left:.2f}} or {{left:d}}",
                      type));
  }
  CHECK(RuleOf("{left:.2f} {right:.2f}\n", {1.0, 2.0, 3.0}) ==
        "range must be two different numbers, full power backward and forward, such as [-255, "
        "255]");
}

/// A robot of another make, on the bench: its lines are taken for what they mean.
class OtherRobot : public ByteLine {
 public:
  explicit OtherRobot(Bench& bench) : bench_(bench) {}
  bool Write(Bytes bytes) override {
    text_.append(bytes.begin(), bytes.end());
    for (size_t end = 0; (end = text_.find("\r\n")) != text_.npos; text_.erase(0, end + 2)) {
      int left = 0, right = 0;
      if (std::sscanf(text_.c_str(), "M %d,%d\r\n", &left, &right) != 2) continue;
      const std::string line = PlainLine({left / 255.0, right / 255.0});
      bench_.Write({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
    }
    return true;
  }
  std::vector<std::uint8_t> Read() override {
    bench_.Read();  // it says nothing
    return {};
  }
  size_t Unsent() override { return bench_.Unsent(); }

 private:
  Bench& bench_;
  std::string text_;
};

DriveRun DriveOther(Bench& bench, std::vector<std::string>& told, const PlainOptions& plain) {
  OtherRobot robot(bench);
  DriveTask task;
  task.task = test::PaperWaypoints();
  task.trial.pace = trial::Pace::kNewPose;
  task.hardware.plain = plain;
  task.hardware.line.baud = 115200;
  return Drive({.line = robot,
                .poses = bench,
                .clock = bench,
                .stoppers = {},
                .say = [&](const std::string& line) { told.push_back(line); },
                .may_arm = [] { return true; },
                .threads = false},
               task);
}

TEST_CASE("A robot with a line format of its own drives to the last waypoint and stands") {
  Bench bench;
  std::vector<std::string> told;
  const DriveRun run = DriveOther(bench, told, kWhole);
  INFO(run.trial.reason);
  CHECK(run.trial.outcome == trial::Outcome::kReached);
  CHECK(bench.listener->Motors().IsZero());
  CHECK(bench.Travelled_m() > 0.6);
}

TEST_CASE("A robot of which nobody said what stops it is not driven") {
  Bench bench;
  std::vector<std::string> told;
  PlainOptions plain = kWhole;
  plain.watchdog = Watchdog::kUnknown;
  CHECK_THROWS_WITH(DriveOther(bench, told, plain),
                    Catch::Contains("hardware.plain.watchdog") && Catch::Contains("0.3 s"));
  CHECK(bench.Travelled_m() == 0.0);

  plain.watchdog = Watchdog::kNone;
  CHECK(DriveOther(bench, told, plain).has_begun);
  CHECK(std::any_of(told.begin(), told.end(), [](const std::string& line) {
    return line.find("nothing stops this robot") != line.npos;
  }));
}

}  // namespace
}  // namespace rift::hardware
