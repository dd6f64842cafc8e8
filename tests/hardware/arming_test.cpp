#include "rift/hardware/arming.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "bench.hpp"
#include "paper_drive.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift::hardware {
namespace {

TEST_CASE("A link over its budget is not armed and the line says what to change") {
  Bench bench;
  bench.line_delay_s = 0.2;
  BenchOperator person;
  CHECK_THROWS_WITH(Drive(person.PartsOf(bench), PaperTask()),
                    Catch::Contains("not armed, the link breaks its budget: 99 %") &&
                        Catch::Contains("baud rate"));
  CHECK(bench.obeyed == std::set<std::pair<int, int>>{{0, 0}});
}

TEST_CASE("Nothing moves until the operator says yes") {
  Bench bench;
  BenchOperator person;
  person.says_yes = false;
  DriveParts parts = person.PartsOf(bench);
  int asked = 0;
  parts.may_arm = [&] {
    if (++asked == 50) person.stop = {StopReason::kOperator, "q was pressed"};
    return false;
  };
  const DriveRun run = Drive(parts, PaperTask());
  CHECK_FALSE(run.has_begun);
  CHECK(run.trial.reason == "stopped before the start: q was pressed");
  CHECK(bench.obeyed == std::set<std::pair<int, int>>{{0, 0}});
}

/// What is told before a drive that a person gives up, of a start so far from where it stands.
std::vector<std::string> ToldBefore(Bench& bench, DriveTask task, double off_m) {
  task.task.waypoints[0].x_m = bench.Pose().x_m + off_m;
  task.task.waypoints[0].y_m = bench.Pose().y_m;
  BenchOperator person;
  DriveParts parts = person.PartsOf(bench);
  parts.may_arm = [&] {
    person.stop = {StopReason::kOperator, "q was pressed"};
    return false;
  };
  Drive(parts, task);
  return person.told;
}

TEST_CASE(
    "Before the start it is told how the robot speaks, how far it may go and where it stands") {
  for (const auto& [off_m, says] : {std::pair{0.099, ""},
                                    {-0.099, ""},
                                    {0.101, ": far off, is the world frame right?"},
                                    {-0.101, ": far off, is the world frame right?"}}) {
    Bench bench;
    DriveTask task = PaperTask();
    task.control.v_max = 0.5;
    const std::vector<std::string> told = ToldBefore(bench, task, off_m);
    REQUIRE(told.size() == 3);
    CHECK(told[0] == "the robot speaks framed");
    // 1.6 m/s at full power; the link's own delay in place of the 0.1 s that are assumed:
    // 0.8 m/s x 0.434 s + 0.16 m. A camera that goes blind is noticed later than a broken link.
    CHECK_THAT(told[1], Catch::StartsWith("worst stopping distance 0.50") &&
                            Catch::Contains("m: at power 0.5, 0.80 m/s x (0.150 s an old pose is "
                                            "driven by + 0.250 s the camera may be late + 0.03") &&
                            Catch::EndsWith(" s delay) + braking"));
    CHECK(told[2] == fmt::format("the robot stands at x -0.282 m, y -0.066 m, {:.3f} m from the "
                                 "first waypoint{}",
                                 std::abs(off_m), says));
  }
}

TEST_CASE("The stopping distance is that of a slow watchdog where the camera is known sooner") {
  Bench bench;
  DriveTask task = PaperTask();
  task.control.v_max = 0.5;
  task.hardware.stopping.robot_watchdog_s = 0.5;
  CHECK_THAT(ToldBefore(bench, task, 0.0)[1],
             Catch::StartsWith("worst stopping distance 0.58") &&
                 Catch::Contains("0.80 m/s x (0.500 s watchdog + 0.03"));
}

TEST_CASE("The stopping distance of a program is that of its strongest segment") {
  Bench bench;
  DriveTask task = PaperTask();
  control::ProgramOptions program;
  program.segments = {{.straight_m = 0.2}, {.straight_m = -0.2, .power = 0.45}};
  task.task = control::Program(program, task.hardware.odometry.drive, bench.Pose());
  task.control.v_max = 0.3;
  const std::vector<std::string> told = ToldBefore(bench, task, 0.0);
  REQUIRE(told.size() == 3);
  CHECK_THAT(told[1], Catch::StartsWith("worst stopping distance 0.44") &&
                          Catch::Contains("m: at power 0.45, 0.72 m/s x ("));
}

TEST_CASE("A power that the guard would refuse is told before anything moves") {
  const auto is_told = [](const DriveTask& task, const std::string& what) {
    Bench bench;
    const std::vector<std::string> told = ToldBefore(bench, task, 0.0);
    return std::any_of(told.begin(), told.end(), [&](const std::string& line) {
      return line == what + ": a command above it is not sent and ends the drive";
    });
  };
  DriveTask task = PaperTask();
  task.control.v_max = 0.3;
  task.control.w_max = 0.25;
  const std::string by_controller =
      "the controller (control.v_max + control.w_max) can ask for the power 0.55, and the limit "
      "(hardware.guard.max_power) is 0.5";
  task.hardware.guard.max_power = 0.5;
  CHECK(is_told(task, by_controller));
  task.hardware.guard.max_power = 0.56;
  CHECK_FALSE(is_told(task, by_controller));
  task.control.v_max = 0.25;
  task.hardware.guard.max_power = 0.5;  // what it can ask for is allowed
  CHECK_FALSE(is_told(task,
                      "the controller (control.v_max + control.w_max) can ask for the power 0.5, "
                      "and the limit (hardware.guard.max_power) is 0.5"));
  // No controller asks for more than full power.
  task.control.v_max = 0.9;
  task.control.w_max = 0.7;
  const std::string by_full_power =
      "the controller (control.v_max + control.w_max) can ask for the power 1, and the limit "
      "(hardware.guard.max_power) is 0.95";
  task.hardware.guard.max_power = 0.95;
  CHECK(is_told(task, by_full_power));
  task.hardware.guard.max_power = 0.56;
  control::ProgramOptions program;
  program.power = 0.6;
  program.segments = {{.turn_deg = -90.0}, {.straight_m = 0.2, .power = 0.2}};
  task.task = control::Program(program, task.hardware.odometry.drive, {});
  CHECK(is_told(task,
                "the program can ask for the power 0.6, and the limit (hardware.guard.max_power) "
                "is 0.56"));
}

TEST_CASE("The turn before a drive is never stronger than the guard allows") {
  for (const double most : {0.12, 0.06}) {  // below the power of its last pulse, and of its first
    Bench bench;
    DriveTask task = PaperTask();
    control::ProgramOptions program;
    program.power = 0.05;
    program.segments = {{.straight_m = 0.02}};
    task.task = control::Program(program, task.hardware.odometry.drive, bench.Pose());
    task.hardware.guard.max_power = most;
    task.hardware.turn.enough_deg = 30.0;  // more than it turns by that
    BenchOperator person;
    const DriveRun run = Drive(person.PartsOf(bench), task);
    INFO(most << ": " << (run.evidence.stop ? run.evidence.stop->text : std::string("no stop")));
    CHECK(run.latency);
    int largest = 0;
    for (const auto& [left, right] : bench.written) {
      largest = std::max({largest, std::abs(left), std::abs(right)});
    }
    CHECK(largest == std::lround(1000.0 * most));
  }
}

TEST_CASE("What stops a drive before its start is a person's wish, or an error with its cause") {
  for (const StopReason reason :
       {StopReason::kOperator, StopReason::kSignal, StopReason::kCameraGone}) {
    Bench bench;
    BenchOperator person;
    DriveParts parts = person.PartsOf(bench);
    bench.tag_is_hidden = true;  // it waits for the first pose
    const double begun_s = bench.Now_s();
    parts.stoppers.push_back([&]() -> std::optional<std::pair<StopReason, std::string>> {
      if (bench.Now_s() < begun_s + 6.0) return std::nullopt;
      return std::pair(reason, "so it was");
    });
    if (reason == StopReason::kCameraGone) {
      CHECK_THROWS_WITH(Drive(parts, PaperTask()), "stopped before the start: so it was");
    } else {
      CHECK(Drive(parts, PaperTask()).trial.reason == "stopped before the start: so it was");
    }
    CHECK(bench.Now_s() < begun_s + 7.0);
    CHECK(bench.obeyed == std::set<std::pair<int, int>>{{0, 0}});
  }
}

TEST_CASE("A camera whose pictures are later than their budget is refused after the turn") {
  for (const auto& [late_s, is_taken] : {std::pair{0.2, true}, {0.3, false}}) {
    Bench bench;
    bench.camera_late_s = late_s;
    BenchOperator person;
    DriveTask task = PaperTask();
    task.trial.timeout_s = 1.0;
    if (is_taken) {
      const DriveRun run = Drive(person.PartsOf(bench), task);
      CHECK(run.has_begun);
      CHECK(*run.latency->delay.camera_s == Approx(late_s).margin(0.02));
      continue;
    }
    CHECK_THROWS_WITH(Drive(person.PartsOf(bench), task),
                      Catch::Contains("late, and the budget (hardware.evidence.max_latency_s) is "
                                      "0.250 s"));
    CHECK(bench.listener->Motors().IsZero());
  }
}

TEST_CASE("A camera that no wheels time is held to its budget with all that it may be late") {
  for (const auto& [late_s, is_taken] : {std::pair{0.1, true}, {0.35, false}}) {
    Bench bench;
    bench.camera_late_s = late_s;
    BenchOperator person;
    DriveTask task = PaperTask();
    task.trial.timeout_s = 1.0;
    task.hardware.line.protocol = Protocol::kPlain;
    task.hardware.plain.watchdog = Watchdog::kRobot;
    if (!is_taken) {
      CHECK_THROWS_WITH(
          Drive(person.PartsOf(bench), task),
          Catch::Contains("the camera's pictures may be 0.4") &&
              Catch::Contains("and the budget (hardware.evidence.max_latency_s) is 0.250 s"));
      CHECK(bench.listener->Motors().IsZero());
      continue;
    }
    const DriveRun run = Drive(person.PartsOf(bench), task);
    const LoopDelay& delay = run.latency.value().delay;
    CHECK_FALSE(delay.camera_s);
    // Of the loop, less the ten bytes of "0.00 0.00" and its end at 9600 baud.
    CHECK(*delay.camera_most_s == Approx(*delay.total_s - 10 * 10.0 / 9600.0));
    CHECK(*delay.camera_most_s > late_s);
    const std::string said = fmt::format(
        "loop delay {:.0f} ms: camera at most {:.0f} ms, host unknown, link unknown, "
        "robot unknown",
        1e3 * *delay.total_s, 1e3 * *delay.camera_most_s);
    CHECK(std::find(person.told.begin(), person.told.end(), said) != person.told.end());
    // A bound is not taken from the stamps.
    for (const PoseStages& pose : run.evidence.poses) {
      CHECK(pose.arrived_s - pose.captured_s == Approx(0.01).margin(1e-6));
    }
  }
}

TEST_CASE("The camera's delay over a whole drive is what was measured and what is left of it") {
  for (const bool is_measured : {true, false}) {
    Bench bench;
    bench.camera_late_s = 0.1;
    BenchOperator person;
    DriveTask task = PaperTask();
    task.hardware.turn.enabled = is_measured;
    const DriveRun run = Drive(person.PartsOf(bench), task);
    INFO(run.trial.reason);
    REQUIRE(run.camera_latency_s);
    CHECK(*run.camera_latency_s == Approx(0.1).margin(0.03));
    CHECK(run.latency.has_value() == is_measured);
    const LoopDelay parts = is_measured ? run.latency->delay : LoopDelay{0, 0, 0, 0, 0};
    const std::string said = fmt::format(
        "loop delay {:.0f} ms: camera {:.0f} ms, host {:.0f} ms, link {:.0f} ms, robot {:.0f} ms",
        1e3 * *parts.total_s, 1e3 * *parts.camera_s, 1e3 * *parts.host_s, 1e3 * *parts.link_s,
        1e3 * *parts.robot_s);
    CHECK((std::find(person.told.begin(), person.told.end(), said) != person.told.end()) ==
          is_measured);
    CHECK(std::any_of(person.told.begin(), person.told.end(), [](const std::string& line) {
            return line ==
                   "the robot turns a few degrees to and fro, to see how late the camera is";
          }) == is_measured);
  }
}

TEST_CASE("A dry run goes through the whole trial and no power but zero is ever written") {
  Bench bench;
  BenchOperator person;
  DriveParts parts = person.PartsOf(bench);
  parts.dry_run = true;
  DriveTask task = PaperTask();
  task.trial.timeout_s = 4.0;
  const DriveRun run = Drive(parts, task);
  CHECK(run.has_begun);
  CHECK(run.dry_run);
  CHECK(run.trial.outcome == trial::Outcome::kTimedOut);
  CHECK(std::any_of(run.trial.commands.begin(), run.trial.commands.end(),
                    [](const auto& command) { return command.power.left != 0.0; }));
  CHECK(bench.written == std::set<std::pair<int, int>>{{0, 0}});
  CHECK(bench.obeyed == std::set<std::pair<int, int>>{{0, 0}});
  CHECK(bench.Travelled_m() == 0.0);
}

TEST_CASE("A robot that is carried along the waypoints reaches the end of a dry run") {
  Bench bench;
  const std::vector<control::Waypoint> waypoints = test::PaperWaypoints();
  std::optional<double> begun_s;
  bench.bend = [&](trial::PoseMeasurement& pose) {
    constexpr double kLeg_s = 3.0;
    const double leg = begun_s ? (pose.captured_s - *begun_s) / kLeg_s : 0.0;
    const auto from = std::min(static_cast<std::size_t>(leg), waypoints.size() - 2);
    const double share = std::min(leg - static_cast<double>(from), 1.0);
    const Eigen::Vector2d at =
        waypoints[from].Position() * (1.0 - share) + waypoints[from + 1].Position() * share;
    pose.world_from_robot = {at.x(), at.y(), 0.0};
  };
  BenchOperator person;
  DriveParts parts = person.PartsOf(bench);
  parts.dry_run = true;
  parts.may_arm = [&] {
    begun_s = bench.Now_s();
    return true;
  };
  const DriveRun run = Drive(parts, PaperTask());
  INFO(run.trial.reason);
  CHECK(run.trial.outcome == trial::Outcome::kReached);
  CHECK(bench.written == std::set<std::pair<int, int>>{{0, 0}});
}

TEST_CASE("A guard in a dry run allows no power and still stops what it would stop") {
  DriveGuard guard({}, true);
  guard.SeePose({.newest = PoseSample{.measured = {.captured_s = 1.0}}, .looked_s = 1.0}, 1.0);
  guard.Arm(1.0);
  guard.Command({0.3, -0.3}, 1.0);
  CHECK(guard.state() == DriveState::kArmed);
  CHECK(guard.Allowed() == control::WheelPower{});
  guard.Tick(1.2, 0.0);
  REQUIRE(guard.stop());
  CHECK(guard.stop()->reason == StopReason::kPoseStale);
}

TEST_CASE("A robot that no camera sees is not driven") {
  const auto drive = [](std::function<std::string()> why_unseen) {
    Bench bench;
    bench.tag_is_hidden = true;
    BenchOperator person;
    DriveParts parts = person.PartsOf(bench);
    parts.why_unseen = std::move(why_unseen);
    Drive(parts, PaperTask());
  };
  const std::string unseen = "the robot was not seen within 10 s: ";
  const std::string in_doubt = unseen + "is its tag in the picture, flat and well lit?";
  CHECK_THROWS_WITH(drive({}), in_doubt);
  CHECK_THROWS_WITH(drive([] { return ""; }), in_doubt);
  CHECK_THROWS_WITH(drive([] { return "it is mirrored"; }), unseen + "it is mirrored");
}

TEST_CASE("The delay of the camera that the turn finds is taken from the stamps of the drive") {
  for (const double late_s : {0.0, 0.1}) {
    Bench bench;
    bench.camera_late_s = late_s;
    BenchOperator person;
    const DriveRun run = Drive(person.PartsOf(bench), PaperTask());
    REQUIRE(run.latency);
    REQUIRE(run.latency->delay.camera_s);
    const double found_s = std::max(0.0, *run.latency->delay.camera_s);
    CHECK(found_s == Approx(late_s).margin(0.025));
    // The bench's pictures arrive 10 ms after their stamps. Those of the turn come first.
    const std::vector<PoseStages>& poses = run.evidence.poses;
    const auto is_corrected = [&](const PoseStages& pose) {
      return std::abs(pose.arrived_s - pose.captured_s - 0.01 - found_s) < 1e-6;
    };
    const auto drive = std::find_if(poses.begin(), poses.end(), is_corrected);
    REQUIRE(poses.end() - drive > 100);
    CHECK(std::all_of(drive, poses.end(), is_corrected));
  }
}

TEST_CASE("A stop during the hello or the ping is obeyed at once") {
  for (const double after_s : {0.05, 0.5, 2.0}) {
    Bench bench;
    bench.from_robot_is_cut = after_s < 0.1;  // a hello that nobody answers
    BenchOperator person;
    DriveParts parts = person.PartsOf(bench);
    const double begun_s = bench.Now_s();
    parts.stoppers.push_back([&]() -> std::optional<std::pair<StopReason, std::string>> {
      if (bench.Now_s() < begun_s + after_s) return std::nullopt;
      return std::pair(StopReason::kSignal, "SIGINT came");
    });
    const DriveRun run = Drive(parts, PaperTask());
    CHECK_FALSE(run.has_begun);
    CHECK(run.trial.reason == "stopped before the start: SIGINT came");
    CHECK(bench.Now_s() - begun_s < after_s + 0.05);
    CHECK(bench.obeyed == std::set<std::pair<int, int>>{{0, 0}});
  }
}

TEST_CASE("A stop in the middle of a drive is told with its reason") {
  Bench bench;
  BenchOperator person;
  DriveParts parts = person.PartsOf(bench);
  const double begun_s = bench.Now_s();
  parts.stoppers.push_back([&]() -> std::optional<std::pair<StopReason, std::string>> {
    if (bench.Now_s() < begun_s + 5.0) return std::nullopt;
    return std::pair(StopReason::kSignal, "SIGTERM came");
  });
  const DriveRun run = Drive(parts, PaperTask());
  CHECK(run.trial.outcome == trial::Outcome::kFault);
  CHECK(run.trial.reason == "SIGTERM came");
  CHECK(run.evidence.stop->reason == StopReason::kSignal);
  CHECK(run.evidence.stop_acknowledged == true);
}

}  // namespace
}  // namespace rift::hardware
