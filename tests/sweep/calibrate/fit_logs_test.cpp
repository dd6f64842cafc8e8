// What a fit asks of the logs that it is to be made from, before it is begun.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

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
  for (const char* began_s : {"-2", "-1.9", "0", "1.9", "2"}) {
    CHECK(refusal(10.0, began_s) == kOneIsLeft);
  }
  for (const char* began_s : {"-2.1", "2.1"}) {
    CHECK(
        refusal(10.0, began_s) ==
        std::string("1/trajectory.csv: its first row is at 0 s, and commands.csv beside it begins "
                    "at ") +
            began_s + " s: they are not of one drive");
  }
  CHECK(refusal(1.6, "1.5") == kOneIsLeft);
  CHECK(refusal(1.4, "1.5").ends_with("they are not of one drive"));
  CHECK(refusal(1.5, "1.5").ends_with("they are not of one drive"));
}

/// A fit of two logs that are held out, so that it ends once it has read them: what it said until
/// then, and why it ended as the last line.
std::vector<std::string> SaidOf(experiment::Experiment experiment, const test::Files& files) {
  experiment.goal = experiment::Goal::kCalibrate;
  experiment.reference.kind = experiment::ReferenceKind::kLogs;
  experiment.reference.trials.names = {"1", "2"};
  experiment.calibrate.holdout.names = {"1", "2"};
  experiment.calibrate.fit.list = {
      {.key = "simulation.motor.mismatch", .min = -0.1, .max = 0.1, .start = 0.0}};
  Evaluator evaluator(experiment, "fit.yaml", test::InputsOf(files));
  std::vector<std::string> said;
  try {
    Identify(evaluator, 1, [&said](const std::string& line) { said.push_back(line); });
  } catch (const std::invalid_argument& error) {
    said.emplace_back(error.what());
  }
  return said;
}

TEST_CASE(
    "Logs of a simulator are held against the task of their setting, those of a program not") {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "a"}, {.name = "b", .x_m = 1.4}};
  experiment.reference.path.text = "{reach_radius_m}_{trial}.csv";
  experiment.space.parameters = {
      {.key = "control.reach_radius_m", .levels = {{"0.1", 0.1}, {"0.25", 0.25}}}};
  test::Files files;
  for (const char* name : {"0.1_1.csv", "0.1_2.csv", "0.25_1.csv", "0.25_2.csv"}) {
    files[name] = Log(10.0 + static_cast<double>(files.size()));
  }
  const std::string none_is_left = "fit.yaml: a fit needs at least 2 logs, and there are 0";
  const std::vector<std::string> said = SaidOf(experiment, files);
  REQUIRE(said.size() == 2);
  CHECK(said[0].starts_with("warning: 0.1_1.csv (and 1 more log): it comes no nearer than 0.4"));
  CHECK(said[0].find("counts as reached within 0.1 m") != said[0].npos);
  CHECK(said[1] == none_is_left);

  experiment.candidate.kind = experiment::CandidateKind::kProgram;
  experiment.candidate.run.words = {"true", "{out}"};
  CHECK(SaidOf(experiment, files) == std::vector<std::string>{none_is_left});
  // Whole runs need no yaw.
  double duration_s = 10.0;
  for (auto& [name, text] : files) text = Log(duration_s += 1.0, false);
  CHECK(SaidOf(experiment, files).back() == none_is_left);
}

TEST_CASE("What makes logs doubtful by themselves is told once for all of them") {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "a"}, {.name = "b", .x_m = 1000.0}};
  experiment.reference.path.text = "{trial}.csv";
  const auto in_mm = [](double duration_s) {
    trajectory::Trajectory path = test::StraightPath(1000.0, 41);
    for (trajectory::StampedPose& pose : path.poses) pose.t_s *= duration_s / 1000.0;
    return trajectory::WriteRift(path);
  };
  const std::vector<std::string> said =
      SaidOf(experiment, {{"1.csv", in_mm(5.0)}, {"2.csv", in_mm(6.0)}});
  REQUIRE(said.size() == 2);
  CHECK(said[0].starts_with("warning: 1.csv: "));
}

}  // namespace
}  // namespace rift::sweep
