// What a drive tells of its link and its stopping distance in whole lines, and how long it waits
// for its end.

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "bench.hpp"
#include "paper_drive.hpp"
#include "rift/hardware/arming.hpp"

namespace rift::hardware {
namespace {

struct Told {
  std::vector<std::string> lines;
  DriveRun run;
};

/// A drive that a person gives up before its start.
Told GivenUp(const DriveTask& task) {
  Bench bench;
  Told told;
  bool has_given_up = false;
  const Stopper stopper = [&]() -> std::optional<std::pair<StopReason, std::string>> {
    if (!has_given_up) return std::nullopt;
    return std::pair(StopReason::kOperator, "q was pressed");
  };
  told.run = Drive({.line = bench,
                    .poses = bench,
                    .clock = bench,
                    .stoppers = {stopper},
                    .say = [&](const std::string& line) { told.lines.push_back(line); },
                    .may_arm =
                        [&] {
                          has_given_up = true;
                          return false;
                        },
                    .threads = false},
                   task);
  CHECK_FALSE(told.run.has_begun);
  return told;
}

TEST_CASE("Of a robot that speaks plain it is told in whole what is assumed and what stops it") {
  DriveTask task = PaperTask();
  task.control.v_max = 0.5;
  task.hardware.line.protocol = Protocol::kPlain;
  task.hardware.guard.pose_stale_s = 0.2;
  task.hardware.evidence.max_latency_s = 0.3;
  task.hardware.stopping = {
      .full_power_speed_mps = 2.0, .braking_mps2 = 2.5, .robot_watchdog_s = 0.4, .delay_s = 0.07};
  const std::string plain =
      "the robot is spoken to in plain lines: its link cannot be measured, a stop cannot be "
      "acknowledged, and without rift's listener the last command holds for ever if the link "
      "breaks";
  // 1 m/s for 0.5 s and 0.07 s, and 1 m2/s2 over twice 2.5 m/s2.
  const std::string blind =
      "worst stopping distance 0.770 m: at power 0.5, 1.00 m/s x (0.200 s an old pose is driven by "
      "+ 0.300 s the camera may be late + 0.070 s delay) + braking";
  task.hardware.plain.watchdog = Watchdog::kRobot;
  const Told by_robot = GivenUp(task);
  REQUIRE(by_robot.lines.size() == 4);
  CHECK(by_robot.lines[0] == "the robot speaks plain");
  CHECK(by_robot.lines[1] == blind);
  CHECK(by_robot.lines[2] == plain);
  CHECK(by_robot.run.stopping_distance_m == Approx(0.77));
  CHECK_FALSE(by_robot.run.ping.IsMeasured());

  task.hardware.plain.watchdog = Watchdog::kNone;
  const Told by_nothing = GivenUp(task);
  REQUIRE(by_nothing.lines.size() == 5);
  CHECK(by_nothing.lines[1] ==
        "nothing stops this robot when the link breaks (hardware.plain.watchdog: none): keep a "
        "hand at its switch");
  CHECK(by_nothing.lines[2] == blind);

  task.hardware.stopping.robot_watchdog_s = 0.6;  // it stops later than the guard does
  CHECK(GivenUp(task).lines[2] ==
        "worst stopping distance 0.870 m: at power 0.5, 1.00 m/s x (0.600 s watchdog + 0.070 s "
        "delay) + braking");

  task.hardware.plain.watchdog = Watchdog::kUnknown;
  CHECK_THROWS_WITH(
      GivenUp(task),
      "the robot speaks plain, and nobody said what stops it when the link breaks: copy "
      "src/firmware to a 3pi+, or set hardware.plain.watchdog to robot where the robot stops by "
      "itself within hardware.stopping.robot_watchdog_s (0.6 s) of the last command, to none where "
      "nothing does and you drive it all the same");
}

TEST_CASE("A link over its budget is told with all that it breaks") {
  DriveTask task = PaperTask();
  task.hardware.ping = {.max_p99_s = 0.001, .max_loss = 0.0, .max_burst = 0};
  try {
    GivenUp(task);
    FAIL("it was armed");
  } catch (const std::runtime_error& error) {
    CHECK_THAT(error.what(),
               Catch::StartsWith("not armed, the link breaks its budget: 99 % of the round trips "
                                 "take up to 0.0") &&
                   Catch::EndsWith(
                       ", and the budget is 0.001 s: bring the robot nearer, ask for a shorter BLE "
                       "connection interval, or raise the baud rate"));
  }
}

TEST_CASE("A stop that nothing confirms is waited for a second, and zeros go on for 0.3 s more") {
  Bench bench;
  DriveTask task = PaperTask();
  task.hardware.turn.enabled = false;
  std::optional<double> stopped_s;
  const double begun_s = bench.Now_s();
  const Stopper stopper = [&]() -> std::optional<std::pair<StopReason, std::string>> {
    if (bench.Now_s() < begun_s + 5.0) return std::nullopt;
    if (!stopped_s) stopped_s = bench.Now_s();
    bench.from_robot_is_cut = true;
    return std::pair(StopReason::kSignal, "SIGTERM came");
  };
  BenchOperator person;
  DriveParts parts = person.PartsOf(bench);
  parts.stoppers = {stopper};
  const DriveRun run = Drive(parts, task);
  CHECK(run.has_begun);
  CHECK(run.trial.reason == "SIGTERM came");
  CHECK(run.evidence.stop_acknowledged == false);
  REQUIRE(stopped_s);
  CHECK(bench.Now_s() - *stopped_s == Approx(1.3).margin(0.06));
  CHECK(bench.listener->Motors().IsZero());
}

TEST_CASE("A camera that may be too late for all that is known is told with what to do") {
  Bench bench;
  bench.camera_late_s = 0.35;
  DriveTask task = PaperTask();
  task.hardware.line.protocol = Protocol::kPlain;
  task.hardware.plain.watchdog = Watchdog::kRobot;
  task.hardware.evidence.max_latency_s = 0.26;
  BenchOperator person;
  std::string why;
  try {
    Drive(person.PartsOf(bench), task);
  } catch (const std::runtime_error& error) {
    why = error.what();
  }
  const std::string before = "the camera's pictures may be ";
  REQUIRE_THAT(why, Catch::StartsWith(before));
  const double most_s = std::stod(why.substr(before.size()));
  CHECK(why ==
        fmt::format("the camera's pictures may be {:.3f} s late (the loop delay less what the line "
                    "takes; this robot tells its wheels too seldom, or not at all, to know more "
                    "by), and the budget (hardware.evidence.max_latency_s) is 0.260 s: ask it for "
                    "fewer pixels or a shorter exposure, read it without a server between, have a "
                    "3pi+ run src/firmware at its line's full speed, or raise the budget by what "
                    "the robot itself is known to take",
                    most_s));
  // The lag of the picture, of the line's 0.02 s and 10 bytes, and of the motors.
  CHECK(most_s == Approx(0.35 + 0.09).margin(0.05));
  CHECK(std::find(person.told.begin(), person.told.end(),
                  "the robot turns a few degrees to and fro, to see how late the camera is") !=
        person.told.end());
}

TEST_CASE("A stop may be confirmed within a second of it, and later it counts no more") {
  for (const auto& [silent_s, is_confirmed] : {std::pair{0.6, true}, {1.1, false}}) {
    Bench bench;
    DriveTask task = PaperTask();
    task.hardware.turn.enabled = false;
    std::optional<double> stopped_s;
    const double begun_s = bench.Now_s();
    const Stopper stopper =
        [&, silent_s = silent_s]() -> std::optional<std::pair<StopReason, std::string>> {
      if (bench.Now_s() < begun_s + 5.0) return std::nullopt;
      if (!stopped_s) stopped_s = bench.Now_s();
      bench.from_robot_is_cut = bench.Now_s() < *stopped_s + silent_s;
      return std::pair(StopReason::kSignal, "SIGTERM came");
    };
    BenchOperator person;
    DriveParts parts = person.PartsOf(bench);
    parts.stoppers = {stopper};
    const DriveRun run = Drive(parts, task);
    CHECK(run.has_begun);
    CHECK(run.evidence.stop_acknowledged == is_confirmed);
  }
}

TEST_CASE("A camera that is later in the drive than in the turn is as late as both say together") {
  Bench bench;
  bench.camera_late_s = 0.06;
  BenchOperator person;
  DriveParts parts = person.PartsOf(bench);
  parts.say = [&](const std::string& line) {
    if (line.starts_with("loop delay")) bench.camera_late_s = 0.16;
  };
  const DriveRun run = Drive(parts, PaperTask());
  INFO(run.trial.reason);
  REQUIRE(run.latency);
  CHECK(*run.latency->delay.camera_s == Approx(0.06).margin(0.02));
  REQUIRE(run.camera_latency_s);
  CHECK(*run.camera_latency_s == Approx(0.16).margin(0.03));
}

TEST_CASE("A camera that is too late is told by how much, beside its budget") {
  Bench bench;
  bench.camera_late_s = 0.32;
  DriveTask task = PaperTask();
  task.hardware.evidence.max_latency_s = 0.28;
  BenchOperator person;
  std::string why;
  try {
    Drive(person.PartsOf(bench), task);
  } catch (const std::runtime_error& error) {
    why = error.what();
  }
  const std::string before = "the camera's pictures are ";
  REQUIRE_THAT(why, Catch::StartsWith(before));
  CHECK(std::stod(why.substr(before.size())) == Approx(0.32).margin(0.02));
  CHECK_THAT(why, Catch::EndsWith(" s late, and the budget (hardware.evidence.max_latency_s) is "
                                  "0.280 s: ask it for fewer pixels or a shorter exposure, or read "
                                  "it without a server between"));
  CHECK(bench.listener->Motors().IsZero());
}

}  // namespace
}  // namespace rift::hardware
