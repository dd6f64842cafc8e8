// An identification beside its parts: the fit of the logs that it reads, and the runs that judge.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "rift/experiment/parameter.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/random.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/trajectory/frame_grid.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/memory_files.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// Two speeds on a short way, seen by a loop that stamps the frames of its camera late.
experiment::Experiment Plan() {
  experiment::Experiment plan;
  plan.seed = 3;
  plan.waypoints = {{.name = "s"}, {.name = "e", .x_m = 0.28, .y_m = 0.02}};
  plan.simulation.step_s = 0.02;  // rough, and soon done
  plan.simulation.mocap.rate_hz = 30.0;
  plan.simulation.mocap.host_period_s = 0.053;
  plan.candidate.grid_fps = 30.0;
  plan.control.heading.p *= 0.8;
  plan.reference.kind = experiment::ReferenceKind::kLogs;
  plan.reference.path.text = "{v_min}_{trial}.csv";
  plan.reference.trials.names = {"1"};
  plan.start = experiment::Start::kReference;
  plan.space.parameters = {{.key = "control.v_min", .levels = {{"0.15", 0.15}, {"0.2", 0.2}}}};
  plan.likeness.longest_run = 1.3;
  plan.likeness.shuffles = 19;
  plan.likeness.bootstrap.resamples = 20;
  plan.likeness.classifier.permutations = 19;
  CalibrationOptions& method = plan.calibrate.method;
  method.horizon.phases = 1;
  method.runs = 0;
  method.iterations = 1;
  return plan;
}

/// What a robot logs whose motors differ.
test::Files Logs(const experiment::Experiment& plan) {
  test::Files files;
  for (const experiment::Theta& theta : experiment::GridPoints(plan.space.parameters)) {
    for (const std::string& trial : plan.reference.trials.names) {
      const experiment::Experiment at = experiment::ExperimentAt(plan, theta);
      SimulatedTrial robot{.task = experiment::TaskOf(at),
                           .control = at.control,
                           .trial = {},
                           .simulation = at.simulation,
                           .seed = 900 + files.size()};
      robot.simulation.motor.mismatch = 0.05;
      files[theta[0].text + "_" + trial + ".csv"] =
          trajectory::WriteRift(Simulate(robot).result.trajectory);
    }
  }
  return files;
}

void CheckSame(const std::vector<Trajectory>& paths, const std::vector<Trajectory>& expected) {
  REQUIRE(paths.size() == expected.size());
  for (size_t run = 0; run < paths.size(); ++run) {
    const auto &poses = paths[run].poses, &others = expected[run].poses;
    CHECK(std::equal(poses.begin(), poses.end(), others.begin(), others.end(),
                     [](const auto& a, const auto& b) {
                       return a.t_s == b.t_s && a.x_m == b.x_m && a.y_m == b.y_m;
                     }));
  }
}

TEST_CASE("An identification is the fit of its logs, each with its group, and its own judgement") {
  experiment::Experiment plan = Plan();
  plan.goal = experiment::Goal::kCalibrate;
  plan.calibrate.fit.list = {
      {.key = "simulation.motor.mismatch", .min = -0.2, .max = 0.2, .start = 0.0}};
  plan.calibrate.judge_runs = 2;
  CalibrationOptions& method = plan.calibrate.method;
  method.corrections = 1;
  method.simulated_logs = 1;
  method.resamples = 50;
  method.features = {.rounds = 1, .draws = 6};
  plan.trial.timeout_s = 1.47;  // some runs do not arrive in time
  const test::Files files = Logs(plan);
  Evaluator evaluator(plan, "e.yaml", test::InputsOf(files));
  std::vector<std::string> said;
  const CalibrationReport report =
      Identify(evaluator, 1, [&said](const std::string& line) { said.push_back(line); });

  const std::vector<experiment::Theta> thetas = experiment::GridPoints(plan.space.parameters);
  std::vector<CalibrationLog> logs;
  for (const experiment::Theta& theta : thetas) {
    const std::string name = theta[0].text + "_1.csv";
    CalibrationLog& log = logs.emplace_back();
    log.name = log.setting = name;
    log.log = trajectory::ReadLog(files.at(name), name, trajectory::Format::kRift).trajectory;
    log.longest_m = 1.3 * LengthByStrides_m(log.log);
    log.group = theta[0].text;
    log.drives_grid_fps = 30.0;
  }
  const TwinAt twin = [&](size_t log, const std::vector<double>& values) {
    const experiment::Experiment at =
        experiment::ExperimentAt(experiment::CalibratedAt(plan, values), thetas[log]);
    return evaluator.TrialOf(at, StartFromLog(logs[log].log, 0.0, at.simulation.mocap),
                             3 + 100'000 * log);
  };
  std::mt19937_64 generator(3);
  const Calibration expected = Calibrate(plan.calibrate.fit.list, logs, twin, method, generator);
  const CalibratedParameter &one = report.calibration.parameters[0],
                            &other = expected.parameters[0];
  CHECK(one.value == other.value);
  CHECK(one.low == other.low);
  CHECK(one.high == other.high);
  CHECK(report.calibration.loss_before == expected.loss_before);
  CHECK(report.calibration.loss_after == expected.loss_after);
  CHECK(report.calibration.trials_simulated == expected.trials_simulated);

  // Judged by runs that are none of the fit's, on the frames of the camera as well.
  int failed = 0;
  std::vector<double> gains_rad_s;
  const auto runs = [&](size_t log, const std::vector<double>& values) {
    std::vector<Trajectory> paths;
    for (const std::uint64_t run : {50'000, 50'001}) {
      SimulatedTrial trial = twin(log, values);
      trial.seed += run;
      const SimulatedRun driven = Simulate(trial);
      if (driven.result.outcome == trial::Outcome::kReached) {
        paths.push_back(trajectory::OnFramesOf(driven.result.trajectory, 30.0));
        const trial::LoopDelay delay =
            trial::EstimateLoopDelay(paths.back(), trial.task.waypoints, trial.control);
        if (delay.lag_s >= 0.0) gains_rad_s.push_back(delay.gain_rad_s);
      } else {
        ++failed;
      }
    }
    return paths;
  };
  CheckSame(report.shown_before, runs(report.shown, {0.0}));
  CheckSame(report.shown_after, runs(report.shown, report.values));
  REQUIRE_FALSE(report.shown_before.empty());
  REQUIRE_FALSE(report.shown_after.empty());
  failed = 0;
  gains_rad_s.clear();
  for (const size_t log : {0, 1}) runs(log, {0.0});
  CHECK(failed == 2);
  CHECK(report.judged.back().before.failed_runs == failed);
  REQUIRE(report.judged.size() == 3);
  REQUIRE(report.errors.size() == 1);
  const ErrorStructure before = StructureOfErrors(logs, twin, {0.0}, method.horizon);
  CHECK(report.errors[0].before.ahead_m == before.ahead_m);
  REQUIRE_FALSE(gains_rad_s.empty());
  CHECK(report.judged[2].before.steering_gain_rad_s.sim == statistics::Median(gains_rad_s));
  CHECK(report.judged[2].before.runs == 4);

  const auto has = [&said](const std::string& text) {
    return std::any_of(said.begin(), said.end(),
                       [&](const std::string& line) { return line.find(text) != line.npos; });
  };
  CHECK(has(" correction by simulated logs 1 of 1: mismatch "));
  CHECK(has(" features of whole drives, round 1 of 1: mismatch "));
}

TEST_CASE("The first four parameters are told with their values, and that there are more") {
  experiment::Experiment plan = Plan();
  plan.goal = experiment::Goal::kCalibrate;
  plan.calibrate.judge_runs = 1;
  plan.likeness.longest_run = 0.5;
  CalibrationOptions& method = plan.calibrate.method;
  method.corrections = 0;
  method.resamples = 20;
  const test::Files files = Logs(plan);
  for (const char* key :
       {"simulation.motor.mismatch", "simulation.link.delay_s", "simulation.link.poll_s",
        "simulation.mocap.processing_s", "simulation.mocap.exposure_s"}) {
    plan.calibrate.fit.list.push_back({.key = key, .min = 0.0, .max = 0.1, .start = 0.02});
  }
  std::vector<std::string> told;
  const auto report_of = [&] {
    Evaluator evaluator(plan, "e.yaml", test::InputsOf(files));
    told.clear();
    return Identify(evaluator, 1, [&told](const std::string& line) {
      if (line.find(" descent, step 1 of at most 1: ") != line.npos) told.push_back(line);
    });
  };
  const CalibrationReport report = report_of();
  // Runs of more than half of the way are detours here.
  CHECK(report.judged.back().before.circled_runs == 2);
  CHECK(report.judged.back().before.failed_runs == 2);
  CHECK(std::isnan(report.trials[0].gap_before_m));
  REQUIRE(told.size() == 1);
  CHECK(told[0].starts_with("0:"));  // less than a minute
  std::vector<std::string> parts{""};
  for (const char c : told[0].substr(told[0].find(": mismatch") + 2)) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  REQUIRE(parts.size() == 5);
  CHECK(parts[0].starts_with("mismatch 0"));
  CHECK(parts[1].starts_with(" delay_s 0"));
  CHECK(parts[2].starts_with(" poll_s 0"));
  CHECK(parts[3].starts_with(" processing_s 0"));
  CHECK(parts[4] == " ...");
  plan.calibrate.fit.list.pop_back();
  report_of();
  REQUIRE(told.size() == 1);
  CHECK(told[0].find("processing_s 0") != told[0].npos);
  CHECK(told[0].find("...") == told[0].npos);
}

/// What the runs of a sweep without parameters are like, by hand.
DriveLikeness LikenessOf(const experiment::Experiment& plan, Evaluator& evaluator) {
  std::vector<RepeatedTrial> trials;
  for (const TrialRequest& request : TrialsAt(plan, {})) {
    const Recording real = evaluator.Reference(request);
    const size_t place = trials.size();
    RepeatedTrial& trial = trials.emplace_back();
    trial.real = real.trajectory;
    trial.waypoints = plan.waypoints;
    trial.control = plan.control;
    if (!real.trajectory.HasYaw()) {
      trial.failed_runs = 1;  // nobody knows how it set out
      continue;
    }
    SimulatedTrial run = evaluator.TrialFor(request, real);
    for (const std::uint64_t i : {0, 1}) {
      if (i > 0) run.seed = statistics::SeedOfStream(plan.seed, 1'000'000 + place);
      const trial::TrialResult driven = Simulate(run).result;
      if (driven.outcome != trial::Outcome::kReached) {
        ++trial.failed_runs;
        continue;
      }
      trial.runs.push_back(trajectory::OnFramesOf(
          trajectory::OffsetAlongHeading(driven.trajectory, plan.reference.tag_offset_m), 30.0));
    }
  }
  std::mt19937_64 generator(plan.seed);
  return MeasureDriveLikeness(trials, true, plan.gap, plan.likeness, generator);
}

TEST_CASE("Runs for the likeness of a sweep set out as the real ones, seen at the same point") {
  experiment::Experiment of_logs = Plan();
  of_logs.reference.trials.names = {"1", "2", "3"};
  of_logs.space.parameters[0].levels.resize(1);
  test::Files files = Logs(of_logs);
  experiment::Experiment plan = of_logs;
  plan.space.parameters.clear();
  plan.reference.path.text = "0.15_{trial}.csv";
  plan.likeness.runs = 2;
  plan.likeness.longest_run = 2.0;
  for (const bool has_yaw : {true, false}) {
    CAPTURE(has_yaw);
    if (has_yaw) {
      plan.reference.tag_offset_m = 0.02;
      plan.trial.timeout_s = 1.51;
    } else {
      plan.reference.tag_offset_m = 0.0;
      plan.trial.timeout_s = 60.0;
      Trajectory log =
          trajectory::ReadLog(files.at("0.15_3.csv"), "3", trajectory::Format::kRift).trajectory;
      for (auto& pose : log.poses) pose.yaw_rad = trajectory::StampedPose::kNotLogged;
      files["0.15_3.csv"] = trajectory::WriteRift(log);
    }
    Evaluator evaluator(plan, "e.yaml", test::InputsOf(files));
    const std::vector<GroupLikeness> rows = MeasureSweepLikeness(evaluator);
    REQUIRE_FALSE(rows.empty());
    const DriveLikeness &found = rows.back().likeness, expected = LikenessOf(plan, evaluator);
    CHECK(found.runs == (has_yaw ? 6 : 5));
    CHECK(found.failed_runs == expected.failed_runs);
    CHECK(found.failed_runs > 0);
    CHECK(found.failed_runs < 5);
    CHECK(found.path.spread_m.sim == expected.path.spread_m.sim);
    CHECK(found.path.mean_path_gap_m == expected.path.mean_path_gap_m);
    CHECK(found.prediction.simulated_m == expected.prediction.simulated_m);
    CHECK(found.loop_delay_s.sim == expected.loop_delay_s.sim);
    CHECK(found.steering_gain_rad_s.sim == expected.steering_gain_rad_s.sim);
    CHECK(found.steering_gain_rad_s.real == expected.steering_gain_rad_s.real);
    for (size_t i = 0; i < found.told_apart.features.size(); ++i) {
      const double sim = found.told_apart.features[i].mean.sim;
      CHECK((std::isnan(sim) || sim == expected.told_apart.features[i].mean.sim));
    }
  }
}

TEST_CASE("Two keys bound by a rule are fitted without a look at values that break it") {
  experiment::Experiment plan = Plan();
  plan.goal = experiment::Goal::kCalibrate;
  plan.simulation.motor.model = simulation::MotorModel::kDc;
  constexpr double kTorque_nm = 0.0008;  // of both: the start is at the end of what is allowed
  plan.simulation.motor.friction_torque_nm = kTorque_nm;
  plan.simulation.motor.breakaway_torque_nm = kTorque_nm;
  plan.calibrate.judge_runs = 1;
  plan.calibrate.fit.list = {
      {.key = "simulation.motor.friction_torque_nm", .max = 0.0015, .start = kTorque_nm},
      {.key = "simulation.motor.breakaway_torque_nm",
       .min = 0.0005,
       .max = 0.0015,
       .start = kTorque_nm}};
  plan.calibrate.starts = 2;
  plan.calibrate.method.features = {.rounds = 1, .draws = 12};
  const test::Files files = Logs(plan);
  Evaluator evaluator(plan, "e.yaml", test::InputsOf(files));
  const CalibrationReport report = Identify(evaluator, 1, [](const std::string&) {});
  REQUIRE(report.values.size() == 2);
  CHECK(report.values[0] <= report.values[1]);
  CHECK(experiment::KeepsRules(plan, report.values));
}

}  // namespace
}  // namespace rift::sweep
