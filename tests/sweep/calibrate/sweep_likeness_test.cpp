// Likeness of the sides of a sweep, and a calibration from its logs to its judgement.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <memory>

#include "rift/experiment/path_template.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/trial/loop_delay.hpp"
#include "support/inputs/memory_files.hpp"
#include "support/inputs/paths.hpp"

namespace rift::sweep {
namespace {

using experiment::CandidateKind;
using experiment::ReferenceKind;
using test::Files;
using test::InputsOf;

std::string Aside(double left_m, double length_m = 1.0) {
  return trajectory::WriteRift(test::Moved(test::StraightPath(length_m, 101), {0.0, left_m, 0.0}));
}

experiment::Experiment Logs() {
  experiment::Experiment experiment;
  experiment.candidate.kind = CandidateKind::kLogs;
  experiment.candidate.path.text = "sim_{s}_{v}_{trial}.csv";
  experiment.reference.kind = ReferenceKind::kLogs;
  experiment.reference.path.text = "{s}_{v}_{trial}.csv";
  experiment.reference.trials.names = {"1", "2"};
  experiment.space.parameters = {{.key = "v", .levels = {{"1", 1.0}, {"2", 2.0}}},
                                 {.key = "s", .levels = {{"a", {}}, {"b", {}}}}};
  experiment.waypoints = {{.name = "s"}, {.name = "e", .x_m = 1.0}};
  experiment.likeness.shuffles = 19;
  experiment.likeness.bootstrap.resamples = 50;
  return experiment;
}

Files AllLogs() {
  Files files;
  for (const std::string s : {"a", "b"}) {
    for (const std::string v : {"1", "2"}) {
      const double at_m = (s == "a" ? 0.0 : 0.1) + (v == "1" ? 0.0 : 0.02);
      files[s + "_" + v + "_1.csv"] = Aside(at_m);
      files[s + "_" + v + "_2.csv"] = Aside(at_m + 0.01);
      files["sim_" + s + "_" + v + "_1.csv"] = Aside(at_m + 0.003);
      files["sim_" + s + "_" + v + "_2.csv"] = Aside(at_m + 0.013);
    }
  }
  return files;
}

TEST_CASE("Likeness stands by the values of the main parameter and over all") {
  Files files = AllLogs();
  const experiment::Experiment experiment = Logs();
  Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
  const std::vector<GroupLikeness> rows = MeasureSweepLikeness(evaluator);
  REQUIRE(rows.size() == 3);
  CHECK(rows[0].level == "a");  // words stand alone, though they are the second parameter
  CHECK(rows[1].level == "b");
  CHECK(rows[2].level == "all");
  CHECK(rows[0].likeness.runs == 4);
  CHECK(rows[1].likeness.runs == 4);
  CHECK(rows[2].likeness.runs == 8);
  CHECK(rows[2].likeness.path.reals == 8);
  for (const GroupLikeness& row : rows) {
    CHECK(row.likeness.failed_runs == 0);
    CHECK(row.likeness.path.spread_m.real == Approx(0.01));
    CHECK(row.likeness.path.spread_m.sim == Approx(0.01));
    CHECK(row.likeness.prediction.simulated_m == Approx(0.003));
    CHECK(row.likeness.prediction.other_real_m == Approx(0.01));
  }
}

TEST_CASE("A candidate log for all repeats is one run, and one that is not there a failed one") {
  Files files = AllLogs();
  experiment::Experiment experiment = Logs();
  experiment.candidate.path.text = "sim_{s}_{v}_1.csv";
  Evaluator shared(experiment, "e.yaml", InputsOf(files));
  CHECK(MeasureSweepLikeness(shared).back().likeness.runs == 4);
  files.erase("sim_a_1_1.csv");
  Evaluator without(experiment, "e.yaml", InputsOf(files));
  const std::vector<GroupLikeness> rows = MeasureSweepLikeness(without);
  CHECK(rows[0].likeness.failed_runs == 2);  // of both repeats
  CHECK(rows[1].likeness.failed_runs == 0);
  files.erase("b_1_1.csv");  // a real one: its trial is no part
  Evaluator fewer(experiment, "e.yaml", InputsOf(files));
  CHECK(MeasureSweepLikeness(fewer).back().likeness.path.reals == 7);
}

TEST_CASE("Without repeated logs, or in space, there is nothing to be like") {
  Files files = AllLogs();
  experiment::Experiment experiment = Logs();
  experiment.gap.dimension = gap::Dimension::kXyz;
  CHECK(
      MeasureSweepLikeness(*std::make_unique<Evaluator>(experiment, "e", InputsOf(files))).empty());
  experiment = Logs();
  experiment.reference.trials.names = {"1"};
  CHECK(
      MeasureSweepLikeness(*std::make_unique<Evaluator>(experiment, "e", InputsOf(files))).empty());
  experiment = Logs();
  experiment.reference.kind = ReferenceKind::kPath;
  CHECK(
      MeasureSweepLikeness(*std::make_unique<Evaluator>(experiment, "e", InputsOf(files))).empty());
}

TEST_CASE("A search has no likeness, whose lists can make more settings than were tried") {
  Files files = AllLogs();
  experiment::Experiment experiment = Logs();
  experiment.goal = experiment::Goal::kFalsify;
  CHECK(
      MeasureSweepLikeness(*std::make_unique<Evaluator>(experiment, "e", InputsOf(files))).empty());
  experiment.candidate.kind = CandidateKind::kSimulation;
  experiment.reference.path.text = "a_1_{trial}.csv";
  for (const std::string key : {"p", "q", "r"}) {  // no grid: more than a million settings
    experiment.space.parameters.push_back({.key = key});
    for (int i = 0; i < 200; ++i) {
      experiment.space.parameters.back().levels.push_back(experiment::NumberValue(i));
    }
  }
  CHECK(
      MeasureSweepLikeness(*std::make_unique<Evaluator>(experiment, "e", InputsOf(files))).empty());
}

TEST_CASE("A setting of a grid that no trial can be made at is no part of the likeness") {
  Files files;
  experiment::Experiment experiment = Logs();
  experiment.likeness.runs = 1;
  const auto runs = [&](const std::vector<experiment::Parameter>& space) {
    std::string name;
    for (const experiment::Parameter& parameter : space) name += "{" + parameter.Name() + "}_";
    experiment.candidate.path.text = "sim_" + name + "{trial}.csv";
    experiment.reference.path.text = name + "{trial}.csv";
    experiment.space.parameters = space;
    for (const TrialRequest& at : GridTrials(space, experiment.reference.trials.names)) {
      for (const auto& path : {experiment.candidate.path.text, experiment.reference.path.text}) {
        files[experiment::FillTemplate(path, space, at.theta, at.trial)] =
            Aside(at.trial == "1" ? 0.0 : 0.01);
      }
    }
    Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
    const DriveLikeness likeness = MeasureSweepLikeness(evaluator).back().likeness;
    CHECK(likeness.path.reals == static_cast<size_t>(likeness.runs));  // one run beside each
    return likeness.runs;
  };
  const experiment::Theta v_min{{"0.15", 0.15}, {"0.45", 0.45}}, v_max{{"0.3", 0.3}, {"0.5", 0.5}};
  // 0.45 beside 0.3 is refused: three of the four settings are left, two trials of each.
  CHECK(runs({{.key = "v_min", .levels = v_min}, {.key = "v_max", .levels = v_max}}) == 6);
  experiment.candidate.kind = CandidateKind::kSimulation;
  experiment.waypoints.back().x_m = 0.2;
  CHECK(runs({{.key = "control.v_min", .levels = v_min},
              {.key = "control.v_max", .levels = v_max}}) == 6);
  // A program that is too fast for the motors is refused where it is made.
  experiment.waypoints.clear();
  experiment.program.segments = {{.straight_m = 0.1}};
  CHECK(runs({{.key = "program.speed_mps", .levels = {{"5", 5.0}, {"0.1", 0.1}}}}) == 2);
}

/// Logs that the simulator made itself with this mismatch, two settings of three trials.
Files SimulatedLogs(const experiment::Experiment& plan, double mismatch) {
  Files files;
  experiment::Experiment made = plan;
  made.simulation.motor.mismatch = mismatch;
  std::uint64_t seed = 900;
  for (const std::string v : {"0.15", "0.2"}) {
    made.control.v_min = std::stod(v);
    for (const std::string trial : {"1", "2", "3"}) {
      SimulatedTrial run{.task = experiment::TaskOf(made),
                         .control = made.control,
                         .trial = made.trial,
                         .simulation = made.simulation,
                         .seed = seed++};
      files[v + "_" + trial + ".csv"] = trajectory::WriteRift(Simulate(run).result.trajectory);
    }
  }
  return files;
}

experiment::Experiment Calibration(int starts = 1) {
  experiment::Experiment plan;
  plan.goal = experiment::Goal::kCalibrate;
  plan.seed = 3;
  plan.waypoints = {
      {.name = "s"}, {.name = "m", .x_m = 0.3}, {.name = "e", .x_m = 0.4, .y_m = 0.3}};
  plan.reference.kind = ReferenceKind::kLogs;
  plan.reference.path.text = "{v_min}_{trial}.csv";
  plan.reference.trials.names = {"1", "2", "3"};
  plan.start = experiment::Start::kReference;
  plan.space.parameters = {{.key = "control.v_min", .levels = {{"0.15", 0.15}, {"0.2", 0.2}}}};
  plan.calibrate.fit.list = {
      {.key = "simulation.motor.mismatch", .min = -0.2, .max = 0.2, .start = 0.0}};
  plan.calibrate.holdout.names = {"3"};
  plan.calibrate.starts = starts;
  plan.calibrate.judge_runs = 2;
  plan.calibrate.method.horizon.phases = 1;
  plan.calibrate.method.runs = 0;
  plan.calibrate.method.iterations = 3;
  plan.calibrate.method.corrections = 0;
  plan.calibrate.method.resamples = 50;
  plan.likeness.shuffles = 19;
  plan.likeness.bootstrap.resamples = 50;
  return plan;
}

TEST_CASE("Logs answer to the controller that their setting names") {
  experiment::Experiment plan = Calibration();
  plan.goal = experiment::Goal::kGrid;
  plan.candidate.kind = CandidateKind::kLogs;
  plan.candidate.path.text = plan.reference.path.text = "{p}_{trial}.csv";
  plan.reference.trials.names = {"1", "2"};
  plan.space.parameters = {
      {.key = "control.heading.p", .levels = {{"0.03", 0.03}, {"0.036", 0.036}}}};
  Files files;
  std::vector<double> lags_s, gains_rad_s;  // of each level the mean of its two logs
  for (const experiment::ParameterValue& level : plan.space.parameters[0].levels) {
    lags_s.push_back(0.0);
    gains_rad_s.push_back(0.0);
    experiment::Experiment made = plan;
    made.control.heading.p = *level.number;
    for (const std::string trial : {"1", "2"}) {
      SimulatedTrial run{.task = experiment::TaskOf(made),
                         .control = made.control,
                         .trial = made.trial,
                         .simulation = made.simulation,
                         .seed = 900 + files.size()};
      const std::string name = level.text + "_" + trial + ".csv";
      files[name] = trajectory::WriteRift(Simulate(run).result.trajectory);
      const trial::LoopDelay delay = trial::EstimateLoopDelay(
          trajectory::ReadLog(files[name], name).trajectory, made.waypoints, made.control);
      REQUIRE(delay.lag_s >= 0.0);
      lags_s.back() += 0.5 * delay.lag_s;
      gains_rad_s.back() += 0.5 * delay.gain_rad_s;
    }
  }
  Evaluator evaluator(plan, "e.yaml", InputsOf(files));
  const std::vector<GroupLikeness> rows = MeasureSweepLikeness(evaluator);
  REQUIRE(rows.size() == 3);
  for (const size_t i : {0, 1}) {
    CHECK(rows[i].likeness.loop_delay_s.real == Approx(lags_s[i]));
    CHECK(rows[i].likeness.loop_delay_s.sim == Approx(lags_s[i]));
    CHECK(rows[i].likeness.steering_gain_rad_s.real == Approx(gains_rad_s[i]));
  }
}

TEST_CASE("Each simulated run beside a real one takes a draw of the ensemble of its own") {
  experiment::Experiment plan = Calibration();
  plan.goal = experiment::Goal::kGrid;
  plan.waypoints = {{.name = "s"}, {.name = "e", .x_m = 0.3}};
  plan.likeness.runs = 10;
  plan.ensemble.keys = {"trial.timeout_s"};  // every second draw lets no run arrive
  plan.ensemble.draws = {{plan.trial.timeout_s}, {1.0}};
  Files files = SimulatedLogs(plan, 0.0);
  Evaluator evaluator(plan, "e.yaml", InputsOf(files));
  const DriveLikeness all = MeasureSweepLikeness(evaluator).back().likeness;
  CHECK(all.runs == 60);
  CHECK(all.failed_runs > 15);
  CHECK(all.failed_runs < 45);
  CHECK(all.failed_runs % 10 != 0);  // with one draw for the runs of a trial all ten fail, or none
}

TEST_CASE("A run beside a real one stands on the frames that its row in the table stands on") {
  experiment::Experiment plan = Calibration();
  plan.goal = experiment::Goal::kGrid;
  plan.likeness.runs = 1;
  plan.candidate.grid_fps = 30.0;
  plan.simulation.mocap.rate_hz = 30.0;
  plan.simulation.mocap.host_period_s = 0.053;  // stamps the frames late, now and then by one more
  plan.reference.tag_offset_m = 0.2;            // a point whose speed is another than the tag's
  Files files = SimulatedLogs(plan, 0.0);
  plan.space.parameters.front().levels = {{"0.15", 0.15}};
  Evaluator evaluator(plan, "e.yaml", InputsOf(files));
  double sum_mps = 0.0, runs = 0.0;
  for (const TrialRequest& request : TrialsAt(plan, {{"0.15", 0.15}})) {
    const Recording run = evaluator.Candidate(request, evaluator.Reference(request));
    if (run.status != TrialStatus::kOk) continue;
    sum_mps += gap::TraitsOf(run.trajectory, plan.likeness).speed_mps;
    runs += 1.0;
  }
  REQUIRE(runs > 0.0);
  CHECK(MeasureSweepLikeness(evaluator).back().likeness.path.speed_mps.sim ==
        Approx(sum_mps / runs).epsilon(1e-9));
}

TEST_CASE("A fit to logs finds their mismatch, holds the rest out, and judges before and after") {
  const experiment::Experiment plan = Calibration(2);
  Files files = SimulatedLogs(plan, 0.1);
  Evaluator evaluator(plan, "e.yaml", InputsOf(files));
  std::vector<std::string> said;
  const CalibrationReport report =
      Identify(evaluator, 1, [&](const std::string& line) { said.push_back(line); });
  REQUIRE(report.values.size() == 1);
  CHECK(report.values[0] == Approx(0.1).margin(0.03));
  CHECK(report.calibration.parameters[0].value == report.values[0]);
  CHECK(report.agreement.size() == 1);
  CHECK(report.agreement[0].values.size() == 2);
  CHECK(report.missing.empty());
  REQUIRE(report.trials.size() == 6);
  int held_out = 0;
  for (const CalibrationTrial& trial : report.trials) {
    CHECK(trial.is_held_out == (trial.trial == "3"));
    CHECK(trial.source == trial.level + "_" + trial.trial + ".csv");
    held_out += trial.is_held_out;
    CHECK((std::isnan(trial.gap_after_m) || trial.gap_after_m > 0.0));  // NaN: no run arrived
  }
  CHECK(held_out == 2);
  REQUIRE(report.errors.size() == 2);
  CHECK(report.errors[0].side == "fitted");
  CHECK(report.errors[1].side == "held out");
  for (const CalibrationReport::Errors& errors : report.errors) {
    CHECK(std::abs(errors.after.turned_bias_rad) < std::abs(errors.before.turned_bias_rad));
  }
  std::map<std::string, int> sides;
  for (const JudgedGroup& group : report.judged) ++sides[group.side];
  CHECK(sides["fitted"] > 0);
  CHECK(sides["held out"] > 0);
  CHECK(report.trials[report.shown].is_held_out);
  CHECK(report.shown_real.poses.size() > 5);
  CHECK(report.shown_before.size() == 2);
  CHECK(report.shown_after.size() == 2);
  REQUIRE(said.size() >= 3);
  // A timeout of the test's keeps two of its runs from the last waypoint.
  CHECK(said[0].starts_with("warning: 0.2_2.csv (and 1 more log): it comes no nearer than"));
  CHECK(said[1] == "fitting 1 parameters to 4 logs; 2 held out");
  const auto has = [&](const std::string& text) {
    return std::any_of(said.begin(), said.end(),
                       [&](const std::string& line) { return line.find(text) != line.npos; });
  };
  CHECK(has("start 2 of 2"));
  CHECK_FALSE(has("start 1 of 2"));
  CHECK(has("judging with 2 runs of each log"));
  CHECK(has(" descent, step 1 of at most 3: mismatch "));
}

TEST_CASE("A log that is not there is left out and told, and one left is too few to fit") {
  const experiment::Experiment plan = Calibration();
  Files files = SimulatedLogs(plan, 0.0);
  files.erase("0.2_1.csv");
  std::vector<std::string> said;
  const auto say = [&](const std::string& line) { said.push_back(line); };
  Evaluator evaluator(plan, "e.yaml", InputsOf(files));
  const CalibrationReport report = Identify(evaluator, 1, say);
  CHECK(report.trials.size() == 5);
  REQUIRE(report.missing.size() == 1);
  CHECK(report.missing[0].find("0.2_1.csv") != std::string::npos);
  CHECK(said[0] == "note: left out: " + report.missing[0]);
  CHECK(said[1] == "fitting 1 parameters to 3 logs; 2 held out");
  files.erase("0.2_2.csv");
  files.erase("0.15_1.csv");
  Evaluator few(plan, "e.yaml", InputsOf(files));
  CHECK_THROWS_AS(Identify(few, 1, say), std::invalid_argument);
}

}  // namespace
}  // namespace rift::sweep
