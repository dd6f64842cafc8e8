#include "rift/sessions/drive/identification.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "rift/files/files.hpp"
#include "rift/sessions/drive/plan.hpp"
#include "support/inputs/paper_task.hpp"
#include "support/processes/process.hpp"
#include "support/processes/until_done.hpp"
#include "support/tree.hpp"

namespace rift::sessions {
namespace {

TEST_CASE("The program of an identification turns and drives both ways within half a metre") {
  const experiment::Experiment drive = IdentificationDrive(test::PaperTask());
  REQUIRE(drive.waypoints.size() == 1);
  CHECK(drive.waypoints[0].name == "start");
  const control::Program program(drive.program, {}, {0.0, 0.0, 0.0});
  CHECK(program.Duration_s() < 45.0);
  CHECK(drive.trial.timeout_s > drive.trial.settle_s + program.Duration_s() + drive.program.rest_s);
  double ahead_s = 0.0, back_s = 0.0, left_s = 0.0, right_s = 0.0, rest_s = 0.0;
  for (double t_s = 0.0; t_s < program.Duration_s(); t_s += 0.01) {
    CHECK(program.PoseAt(t_s).Position().norm() < 0.5);
    const control::WheelPower power = program.MeanPower(t_s, t_s + 0.01);
    const double sum = power.left + power.right, turn = power.right - power.left;
    ahead_s += 0.01 * (sum > 0.05);
    back_s += 0.01 * (sum < -0.05);
    left_s += 0.01 * (turn > 0.01);
    right_s += 0.01 * (turn < -0.01);
    rest_s += 0.01 * (power == control::WheelPower{});
  }
  CHECK(ahead_s > 3.0);
  CHECK(back_s > 3.0);
  CHECK(left_s == Approx(right_s).margin(0.3));
  CHECK(rest_s > 8.0);
}

TEST_CASE("The fit of an identification is to all its logs and keeps what an experiment fits") {
  experiment::Experiment logs = test::PaperTask();
  logs.calibrate.holdout.names = {"2"};
  const experiment::Experiment fit = IdentificationFit(logs);
  CHECK(fit.goal == experiment::Goal::kCalibrate);
  CHECK(fit.calibrate.holdout.names.empty());
  CHECK(fit.calibrate.method.runs == 0);
  REQUIRE(fit.calibrate.fit.list.size() == 5);
  for (const experiment::FreeParameter& free : fit.calibrate.fit.list) {
    INFO(free.key);
    CHECK(free.min < free.prior_mean);
    CHECK(free.prior_mean < free.max);
    CHECK(free.prior_sd > 0.0);
  }
  logs.calibrate.fit.list = {{.key = "simulation.motor.lag_s"}};
  REQUIRE(IdentificationFit(logs).calibrate.fit.list.size() == 1);
}

/// The sweep that an identification of this robot leaves, as `rift sweep` reads it.
experiment::Experiment SweptAfter(const experiment::Experiment& robot) {
  const experiment::Experiment sweep =
      PlanSeries({.identify = true}, IdentificationDrive(robot), "/out").sweep;
  return experiment::LoadExperiment("/out/sweep.yaml", {}, [&](const std::string&) {
    return experiment::WriteExperiment(sweep);
  });
}

experiment::FreeParameter FrictionFitted(const experiment::Experiment& robot) {
  for (const experiment::FreeParameter& free : SweptAfter(robot).calibrate.fit.list) {
    if (free.key == "simulation.motor.friction_torque_nm") return free;
  }
  return {};
}

TEST_CASE("The fit of an identification can be made for every robot file") {
  int robots = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(test::SourceDir() + "/configs/robots")) {
    INFO(file.path());
    ++robots;
    const experiment::Experiment robot =
        experiment::LoadExperiment(file.path().string(), {}, files::ReadFile);
    experiment::Experiment fit;
    REQUIRE_NOTHROW(fit = SweptAfter(robot));
    REQUIRE(fit.calibrate.fit.list.size() == 5);
    const experiment::FreeParameter& friction = fit.calibrate.fit.list[2];
    CHECK(friction.start == robot.simulation.motor.friction_torque_nm);
    CHECK(friction.start < friction.max);  // it may turn out to be more
  }
  CHECK(robots >= 4);
}

TEST_CASE("The friction that an identification fits is that of the motor and ends at breakaway") {
  experiment::Experiment robot = test::PaperTask();
  simulation::MotorOptions& motor = robot.simulation.motor;
  motor.stall_torque_nm = 10.0 * motor.StallTorque_nm();  // of the 3pi+
  CHECK(FrictionFitted(robot).max == Approx(0.03));
  CHECK(FrictionFitted(robot).prior_mean == Approx(0.019));
  CHECK(FrictionFitted(robot).prior_sd == Approx(0.008));
  motor.friction_torque_nm = 0.04;
  CHECK(FrictionFitted(robot).max == Approx(0.06));
  motor.breakaway_torque_nm = 0.05;
  CHECK(FrictionFitted(robot).max == 0.05);
  motor.friction_torque_nm = 0.01;
  motor.breakaway_torque_nm = 0.01;
  CHECK(FrictionFitted(robot).max == 0.01);
  CHECK(FrictionFitted(robot).prior_mean == 0.01);  // what is known must lie in the range
  motor.friction_torque_nm = 0.0;
  motor.breakaway_torque_nm = 0.0;  // none at all
  CHECK(FrictionFitted(robot).key.empty());
}

TEST_CASE("The ranges of an identification hold the values that the robot has already") {
  experiment::Experiment robot = test::PaperTask();
  robot.simulation.link.delay_s = 0.3;
  robot.simulation.motor.supply_ratio = 0.5;
  robot.simulation.motor.mismatch = -0.12;
  robot.simulation.body.caster_mu = 0.7;
  const auto fit = SweptAfter(robot).calibrate.fit.list;
  REQUIRE(fit.size() == 5);
  CHECK(fit[0].max == 0.3);
  CHECK(fit[1].min == 0.5);
  CHECK(fit[3].min == -0.12);
  CHECK(fit[4].max == 0.7);
}

TEST_CASE("An identification whose fit could not be made is refused before its first drive") {
  experiment::Experiment robot = test::PaperTask();
  robot.calibrate.fit.list = {{.key = "simulation.motor.mismatch", .min = 0.01, .max = 0.1}};
  CHECK_THROWS_WITH(PlanSeries({.identify = true}, robot, "/out"),
                    Catch::Contains("simulation.motor.mismatch starts at 0"));
  CHECK_NOTHROW(PlanSeries({.repeat = 2}, robot, "/out"));
}

TEST_CASE("An identification on the twin leaves a fit that the next command makes") {
  const test::TemporaryFolder folder;
  // Limits that a loaded machine keeps as well.
  test::WriteText(folder / "task.yaml", "include: " + test::SourceDir() + R"(/configs/twin.yaml
twin: {fps: 5, still_s: 60, camera: {grain_grey: 0, jpeg_colour: false}}
track: {tag: {acquire_decimate: 2, lost_after_s: 5}, capture: {silent_s: 20, same_s: 20, open_timeout_s: 60}}
trial: {pose_stale_s: 5, lost_after_s: 20}
hardware:
  line: {hello_s: 20}
  guard: {pose_stale_s: 2, control_stale_s: 2, link_lag_s: 2, host_stall_s: 2, jump_m: 10, jump_deg: 180}
  ping: {duration_s: 0.5, max_p99_s: 10, max_loss: 1, max_burst: 1000}
  start: {countdown_s: 0}
  turn: {enabled: false}
  evidence: {max_latency_s: 2, agree_m: 10, blind_m: 10, pushed_m: 10, pushed_deg: 180}
)");
  const std::vector<std::string> command{"drive",
                                         folder / "task.yaml",
                                         "--yes",
                                         "--identify",
                                         "--repeat",
                                         "2",
                                         "--out",
                                         folder / "run",
                                         "--before-each",
                                         test::BuildDir() + "/rift simulate " +
                                             (folder / "task.yaml") + " --twin --force --out " +
                                             (folder / "twin{trial}")};
  const test::ProcessResult result = test::RunUntilDone(command);
  INFO(result.out << result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.err, Catch::Contains("fit the simulated robot: rift sweep"));

  // What the twin's listener is, not the authors'.
  const simulation::LinkOptions link =
      experiment::LoadExperiment(folder / "run/sweep.yaml", {}, files::ReadFile).simulation.link;
  CHECK(link.poll_s == 0.0);
  CHECK(link.uart_bytes == 512);

  const test::ProcessResult fit = test::RunRift(
      {"sweep", folder / "run/sweep.yaml", "--out", folder / "fit", "--write-robot",
       folder / "robot.yaml", "--set", "calibrate.judge_runs=2", "--set",
       "calibrate.method.iterations=1", "--set", "calibrate.method.horizon.phases=1", "--set",
       "calibrate.method.corrections=0", "--set", "calibrate.method.simulated_logs=2"});
  INFO(fit.out << fit.err);
  // A fit that is not better than its start, the robot's own values, is refused in words.
  const bool is_refused = fit.err.find("worse than") != std::string::npos;
  CHECK((fit.exit_code == 0 || is_refused));
  const auto calibration = nlohmann::json::parse(files::ReadFile(folder / "fit/calibration.json"));
  CHECK(calibration.dump().find("simulation.motor.supply_ratio") != std::string::npos);
}

}  // namespace
}  // namespace rift::sessions
