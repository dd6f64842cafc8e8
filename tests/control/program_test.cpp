#include "rift/control/program.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <stdexcept>

#include "rift/control/program_controller.hpp"

namespace rift::control {
namespace {

ProgramOptions Square(double side_m, double turn_deg) {
  ProgramOptions options{.power = 0.25, .laps = 4};
  options.segments = {{.straight_m = side_m}, {.turn_deg = turn_deg}};
  return options;
}

TEST_CASE("A square of four sides and turns ends where it began, either way round") {
  for (const double turn_deg : {90.0, -90.0}) {
    const Program square(Square(0.7, turn_deg), {}, {0.3, -0.2, 0.5});
    const geometry::Pose2 end = square.PoseAt(square.Duration_s());
    CHECK(end.x_m == Approx(0.3));
    CHECK(end.y_m == Approx(-0.2));
    CHECK(geometry::WrapToPi(end.yaw_rad - 0.5) == Approx(0.0).margin(1e-12));
    CHECK(square.Length_m() == Approx(2.8));
    CHECK(square.waypoints().size() == 1 + 8);
    CHECK(square.waypoints()[1].name == "straight 0.7 m");
  }
}

TEST_CASE("A segment lasts as long as its wheels need at their power") {
  const DiffDriveOptions drive;
  const double full_mps = drive.full_power_speed_rad_s * drive.wheel_radius_m;
  ProgramOptions options{.power = 0.5};
  options.segments = {{.straight_m = -1.0}, {.turn_deg = 180.0, .power = 0.25}, {.hold_s = 0.7}};
  const Program program(options, drive, {});
  const double back_s = 1.0 / (0.5 * full_mps);
  const double turn_s = geometry::kPi * 0.5 * drive.track_m / (0.25 * full_mps);
  CHECK(program.Duration_s() == Approx(back_s + turn_s + 0.7));
  CHECK(program.MeanPower(0.0, 0.1) == WheelPower{-0.5, -0.5});
  CHECK(program.MeanPower(back_s + 0.01, back_s + 0.02) == WheelPower{-0.25, 0.25});
  CHECK(program.MeanPower(back_s + turn_s + 0.1, back_s + turn_s + 0.2) == WheelPower{});
  CHECK(program.PoseAt(back_s).x_m == Approx(-1.0));
  CHECK(program.Length_m() == Approx(1.0));
  CHECK(program.MostPower() == 0.5);  // backwards counts as well
}

TEST_CASE("A speed asks for the power that the ideal robot needs, and a segment's own power wins") {
  ProgramOptions options{.power = 0.9, .speed_mps = 0.3};
  options.segments = {{.straight_m = 0.6}, {.straight_m = 0.6, .power = 0.5}};
  const Program program(options, {}, {});
  const double full_mps = 75.4 * 0.016;
  CHECK(program.MeanPower(0.0, 0.1).left == Approx(0.3 / full_mps));
  CHECK(program.MeanPower(2.1, 2.2).right == 0.5);
  CHECK(program.Duration_s() == Approx(2.0 + 0.6 / (0.5 * full_mps)));
}

TEST_CASE("The ideal path is what the ideal robot drives with the program's powers") {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const DiffDriveOptions drive{.track_m = 0.05 + 0.1 * share(generator)};
    ProgramOptions options{.power = 0.1 + 0.8 * share(generator)};
    for (int i = 0; i < 5; ++i) {
      const double turn_deg = 400.0 * (share(generator) - 0.5);
      if (i % 3 == 0) options.segments.push_back({.straight_m = share(generator) - 0.5});
      if (i % 3 == 1) options.segments.push_back({.turn_deg = turn_deg});
      if (i % 3 == 2) {
        options.segments.push_back({.turn_deg = turn_deg, .radius_m = 0.01 + share(generator)});
      }
    }
    const Program program(options, drive, {});
    const DiffDrive robot(drive);
    geometry::Pose2 driven;
    // Periods that end where segments do: over an end both segments are mixed, and their order
    // lost.
    const std::vector<double> times = program.Times(0.02);
    for (size_t i = 1; i < times.size(); ++i) {
      driven =
          robot.Drive(driven, program.MeanPower(times[i - 1], times[i]), times[i] - times[i - 1]);
      const geometry::Pose2 ideal = program.PoseAt(times[i]);
      REQUIRE((driven.Position() - ideal.Position()).norm() < 1e-9);
      REQUIRE(std::abs(geometry::WrapToPi(driven.yaw_rad - ideal.yaw_rad)) < 1e-9);
    }
  }
}

TEST_CASE("Over any periods the wheels are asked for exactly as much as the segments need") {
  const Program program(Square(0.31, 77.0), {}, {});
  for (const double period_s : {0.02, 0.013, 0.37}) {
    double left_s = 0.0, right_s = 0.0;
    for (double t_s = 0.0; t_s < program.Duration_s() + 1.0; t_s += period_s) {
      left_s += period_s * program.MeanPower(t_s, t_s + period_s).left;
      right_s += period_s * program.MeanPower(t_s, t_s + period_s).right;
    }
    const double straight_s = 4 * 0.31 / (75.4 * 0.016);
    const double turn_s = 4 * geometry::RadFromDeg(77.0) * 0.5 * 0.083 / (75.4 * 0.016);
    CHECK(left_s == Approx(straight_s - turn_s));
    CHECK(right_s == Approx(straight_s + turn_s));
  }
}

TEST_CASE("A program that is none is refused with the rule that it breaks") {
  const auto refused = [](const ProgramOptions& options, const char* words) {
    CHECK_THROWS_WITH(Program(options, DiffDriveOptions{}, geometry::Pose2{}),
                      Catch::Contains(words));
  };
  refused({}, "program.segments is empty");
  ProgramOptions options;
  options.segments = {{.straight_m = 1.0, .turn_deg = 90.0}};
  refused(options, "2 of them are set");
  options.segments = {{}};
  refused(options, "0 of them are set");
  options.segments = {{.radius_m = 0.2, .hold_s = 1.0}};
  refused(options, "without turn_deg");
  options.segments = {{.hold_s = 1.0, .power = 0.2}};
  refused(options, "beside hold_s");
  options.segments = {{.hold_s = 1.0}};
  refused(options, "none of them moves the robot");
  options.segments = {{.straight_m = 1.0}};
  options.speed_mps = 1.3;
  refused(options, "program.speed_mps is 1.3");
}

struct Driven {
  double driven_s = 0.0;  ///< in which the power was not zero
  double ended_s = 0.0;
  bool is_finished = false;
};

/// Lets a program run over control steps of these lengths, a guard sending zero in every step of
/// `held`.
Driven RunOver(ProgramController& controller, double step_s, int steps, int held_from,
               int held_to) {
  Driven driven;
  for (int i = 0; i < steps && !driven.is_finished; ++i) {
    const double now_s = i * step_s;
    controller.Observe({now_s, 0.0, now_s, {}});
    if (i >= held_from && i < held_to) {
      controller.NoteSent(now_s, {});
      continue;
    }
    const Decision decision = controller.Step({now_s, step_s, now_s, {}});
    controller.NoteSent(now_s, decision.power);
    driven.driven_s += decision.power.left * step_s / 0.25;
    driven.is_finished = decision.finished;
    driven.ended_s = now_s;
  }
  return driven;
}

TEST_CASE("What a guard holds back is driven later") {
  ProgramOptions options{.power = 0.25, .rest_s = 0.2};
  options.segments = {{.straight_m = 0.5}};
  const Program program(options, {}, {});
  for (const int held : {0, 1, 30}) {
    ProgramController controller(program, {});
    const Driven driven = RunOver(controller, 0.02, 200, 10, 10 + held);
    CHECK(driven.is_finished);
    CHECK(driven.driven_s == Approx(program.Duration_s()));
    CHECK(driven.ended_s == Approx(program.Duration_s() + 0.2 + 0.02 * held).margin(0.021));
  }
}

TEST_CASE("Without a believable pose a program sends nothing") {
  ProgramOptions options;
  options.segments = {{.straight_m = 0.5}};
  ProgramController controller(Program(options, {}, {}), {});
  const double nowhere = std::nan("");
  const Decision decision = controller.Step({0.0, 0.02, 0.0, {nowhere, 0.0, 0.0}});
  CHECK(decision.pose_refused);
  CHECK(decision.power == WheelPower{});
}

TEST_CASE("A program's target runs along its ideal path") {
  ProgramOptions options{.power = 0.25, .rest_s = 0.0};
  options.segments = {{.straight_m = 0.5}};
  const Program program(options, {}, {});
  ProgramController controller(program, {});
  RunOver(controller, 0.02, 11, 0, 0);
  CHECK(controller.Target_m().x() == Approx(0.25 * 75.4 * 0.016 * 0.2));
  CHECK(controller.active() == 1);
}

}  // namespace
}  // namespace rift::control
