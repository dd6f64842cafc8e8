// What a fit asks of the logs that it is to be made from, before it is begun.
#include <catch2/catch.hpp>
#include <string>

#include "rift/sweep/calibrate/identification.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/memory_files.hpp"
#include "support/inputs/paths.hpp"

namespace rift::sweep {
namespace {

/// A metre ahead in `duration_s`, from 0 s on.
std::string Log(double duration_s, bool has_yaw = true) {
  trajectory::Trajectory path = test::StraightPath(1.0, 41);
  for (trajectory::StampedPose& pose : path.poses) {
    pose.t_s *= duration_s;
    if (!has_yaw) pose.yaw_rad = trajectory::StampedPose::kNotLogged;
  }
  return trajectory::WriteRift(path);
}

/// Of a program that drives ahead, fitted to two logs of which the second has no yaw.
std::string Refusal(const test::Files& files) {
  experiment::Experiment experiment;
  experiment.goal = experiment::Goal::kCalibrate;
  experiment.program.segments = {{.straight_m = 1.0, .power = 0.3}};
  experiment.reference.kind = experiment::ReferenceKind::kLogs;
  experiment.reference.path.text = "{trial}/trajectory.csv";
  experiment.reference.trials.names = {"1", "2"};
  experiment.calibrate.fit.list = {
      {.key = "simulation.motor.mismatch", .min = -0.1, .max = 0.1, .start = 0.0}};
  test::Files all = files;
  all["2/trajectory.csv"] = Log(10.0, false);
  Evaluator evaluator(experiment, "fit.yaml", test::InputsOf(all));
  try {
    Identify(evaluator, 1, [](const std::string&) {});
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "fitted";
}

const std::string kOneIsLeft =
    "fit.yaml: a fit needs at least 2 logs, and there are 1; 2/trajectory.csv: its yaw is needed: "
    "set reference.format";

TEST_CASE("A log without a yaw is none of a fit's, and one log alone is too few") {
  CHECK(Refusal({{"1/trajectory.csv", Log(10.0)}}) == kOneIsLeft);
}

TEST_CASE(
    "Commands beside a log are its own when they begin within 2 s of it, and before its end") {
  const auto refusal = [](double duration_s, const std::string& began_s) {
    return Refusal({{"1/trajectory.csv", Log(duration_s)},
                    {"1/commands.csv", "t_s,power_left,power_right\n" + began_s + ",0,0\n"}});
  };
  for (const char* began_s : {"-1.9", "0", "1.9"}) CHECK(refusal(10.0, began_s) == kOneIsLeft);
  for (const char* began_s : {"-2.1", "2.1"}) {
    CHECK(
        refusal(10.0, began_s) ==
        std::string("1/trajectory.csv: its first row is at 0 s, and commands.csv beside it begins "
                    "at ") +
            began_s + " s: they are not of one drive");
  }
  CHECK(refusal(1.6, "1.5") == kOneIsLeft);
  CHECK(refusal(1.4, "1.5").ends_with("they are not of one drive"));
}

}  // namespace
}  // namespace rift::sweep
