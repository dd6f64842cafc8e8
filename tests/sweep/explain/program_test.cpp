#include "rift/sweep/explain/program_cells.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "rift/odometry/odometry.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/memory_files.hpp"
#include "support/inputs/paths.hpp"

namespace rift::sweep {
namespace {

const Inputs kNoFiles{[](const std::string&) { return std::nullopt; }, [](const std::string&) {}};

experiment::Experiment Lap(double power) {
  experiment::Experiment experiment;
  experiment.program.power = power;
  experiment.program.laps = 2;
  experiment.program.segments = {{.straight_m = 0.5}, {.turn_deg = 180.0, .radius_m = 0.16}};
  experiment.trial.settle_s = 1.0;
  experiment.trial.timeout_s = 60.0;
  experiment.reference.trials.names = {"1", "2", "3"};
  return experiment;
}

/// No noise, no slip, and encoders of a thousandth of a degree.
void MakeExact(simulation::SimulationOptions& simulation) {
  simulation.mocap.rate_hz = 0.0;
  simulation.mocap.noise_across_m = simulation.mocap.noise_along_m = 0.0;
  simulation.mocap.blur_across_s = simulation.mocap.stamp_jitter_s = 0.0;
  simulation.mocap.noise_yaw_rad = simulation.mocap.blur_yaw_rad_per_mps = 0.0;
  simulation.encoder.counts_per_rev = 100'000.0;
  simulation.terrain.surfaces["ground"].slip = 0.0;
  simulation.terrain.surfaces["ground"].mu = 5.0;
}

TEST_CASE("Without slip the odometry of fine encoders is the true path") {
  experiment::Experiment experiment = Lap(0.1);
  experiment.program.laps = 3;
  experiment.trial.control_period_s = 0.004;  // between readings the wheels turn evenly
  experiment.simulation.link.baud = 0.0;      // takes so many commands
  MakeExact(experiment.simulation);
  const SimulatedTrial trial = SimulatedTrialOf(experiment, {}, 1, "lap.yaml", kNoFiles);
  SimulatedTrial started = trial;
  started.start = trial.task.Start();
  const SimulatedRun run = Simulate(started);
  REQUIRE(run.result.outcome == trial::Outcome::kReached);
  odometry::OdometryOptions wheels = experiment.hardware.odometry;
  wheels.counts_per_wheel_turn = 100'000.0;
  const trajectory::Trajectory path =
      odometry::OdometryPath(run.encoders, wheels, run.truth.poses.front().Planar());
  CHECK(path.ArcLength_m() > 2.0);
  double largest_m = 0.0, turned_rad = 0.0;
  for (size_t i = 1; i < path.poses.size(); ++i) {
    turned_rad += geometry::WrapToPi(path.poses[i].yaw_rad - path.poses[i - 1].yaw_rad);
  }
  CHECK(turned_rad > 2.5 * geometry::kPi);
  for (size_t i = 0; i < path.poses.size(); ++i) {
    REQUIRE(path.poses[i].t_s == Approx(run.truth.poses[i].t_s).margin(1e-9));
    largest_m =
        std::max(largest_m, (path.poses[i].Position() - run.truth.poses[i].Position()).norm());
  }
  CHECK(largest_m < 3e-4);
}

TEST_CASE("A program is what a run of it is held against and every run of a seed is the same") {
  const experiment::Experiment experiment = Lap(0.2);
  Evaluator evaluator(experiment, "lap.yaml", kNoFiles);
  const TrialRequest request = TrialsAt(experiment, {}).front();
  const trajectory::Trajectory ideal = evaluator.IdealPathAt({});
  CHECK((ideal.poses.back().Position() - ideal.poses.front().Position()).norm() < 1e-9);
  CHECK(ideal.ArcLength_m() == Approx(2.0 * (0.5 + geometry::kPi * 0.16)).epsilon(1e-4));
  const TrialRow row = evaluator.Evaluate(request);
  CHECK(row.status == TrialStatus::kOk);
  CHECK(row.reference == "program path");
  CHECK(row.comparison.gap_m > 0.0);
  CHECK(evaluator.Evaluate(request).comparison.gap_m == row.comparison.gap_m);
}

TEST_CASE("Judged by odometry a slippery floor is worse and the gap is that of wheels to camera") {
  experiment::Experiment experiment = Lap(0.6);
  experiment.objective = experiment::Objective::kOdometry;
  const auto gap_m = [&](double slip) {
    experiment.simulation.terrain.surfaces["ground"].slip = slip;
    experiment.simulation.terrain.surfaces["ground"].mu = slip > 0.0 ? 0.3 : 2.0;
    Evaluator evaluator(experiment, "lap.yaml", kNoFiles);
    return evaluator.Evaluate(TrialsAt(experiment, {}).front()).comparison.gap_m;
  };
  const double grips_m = gap_m(0.0), slips_m = gap_m(0.05);
  CHECK(grips_m < 0.1);
  CHECK(slips_m > 2.0 * grips_m);
}

TEST_CASE("Odometry of exact wheels is the camera's path, wherever the tag is") {
  experiment::Experiment experiment = Lap(0.2);
  experiment.objective = experiment::Objective::kOdometry;
  experiment.program.laps = 1;
  experiment.trial.control_period_s = 0.004;  // between readings the wheels turn evenly
  experiment.simulation.link.baud = 0.0;      // takes so many commands
  experiment.hardware.odometry.counts_per_wheel_turn = 100'000.0;
  MakeExact(experiment.simulation);
  const double tag_ahead_m = GENERATE(0.0, 0.08, -0.08);
  INFO(tag_ahead_m);
  experiment.simulation.mocap.tag_ahead_m = tag_ahead_m;
  Evaluator evaluator(experiment, "lap.yaml", kNoFiles);
  const TrialRow row = evaluator.Evaluate(TrialsAt(experiment, {}).front());
  REQUIRE(row.IsOk());
  CHECK(row.comparison.sim_length_m > 0.9);
  CHECK(row.comparison.gap_m < 0.005);
}

TEST_CASE("Odometry as the objective needs encoders, and logs of its own") {
  experiment::Experiment experiment = Lap(0.2);
  experiment.objective = experiment::Objective::kOdometry;
  experiment.simulation.encoder.reported = false;
  Evaluator evaluator(experiment, "lap.yaml", kNoFiles);
  const TrialRow row = evaluator.Evaluate(TrialsAt(experiment, {}).front());
  CHECK(row.status == TrialStatus::kUnreadable);
  CHECK(row.reason ==
        "simulation with seed " + std::to_string(*row.seed) +
            ", its encoders: objective: odometry needs encoders (encoders.csv beside the log)");
  experiment.reference.kind = experiment::ReferenceKind::kLogs;
  experiment.reference.path.text = "{trial}.csv";
  CHECK_THROWS_WITH(Evaluator(experiment, "lap.yaml", kNoFiles), Catch::Contains("candidate.path"));
}

TEST_CASE("A recorded run is judged by the encoders beside its log, from where it stood") {
  experiment::Experiment experiment = Lap(0.2);
  experiment.objective = experiment::Objective::kOdometry;
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  experiment.candidate.path.text = "{trial}/run.csv";
  const double metres = odometry::MetresPerCount(experiment.hardware.odometry);
  std::vector<odometry::EncoderReading> wheels;
  trajectory::Trajectory log = test::Moved(test::StraightPath(0.5, 51), {0.3, -0.2, 0.7});
  for (const trajectory::StampedPose& pose : log.poses) {
    const double share = (pose.t_s - log.poses.front().t_s) / log.Duration_s();
    const auto counts = static_cast<std::int64_t>(std::lround(0.4 * share / metres));
    wheels.push_back({pose.t_s, {counts, counts}});
  }
  test::Files files{{"1/run.csv", trajectory::WriteRift(log)},
                    {"1/encoders.csv", odometry::EncodersCsv(wheels)}};
  const auto row = [&] {
    return Evaluator(experiment, "lap.yaml", test::InputsOf(files)).Evaluate({.trial = "1"});
  };
  const TrialRow told = row();
  REQUIRE(told.IsOk());
  // Both set out from one place, in one direction: the wheels fall back by a fifth of the way.
  CHECK(told.comparison.gap_m == Approx(0.1 * told.comparison.gap_u).margin(0.01));
  CHECK(told.comparison.gap_u > 0.9);
  CHECK(told.candidate == "1/run.csv, its encoders");
  // Before its log the robot turned on the spot and was pushed.
  std::vector<odometry::EncoderReading> earlier;
  for (int i = 1; i <= 20; ++i) earlier.push_back({log.poses.front().t_s - 0.1 * i, {500, -900}});
  std::reverse(earlier.begin(), earlier.end());
  std::vector<odometry::EncoderReading> all = earlier;
  all.insert(all.end(), wheels.begin(), wheels.end());
  files["1/encoders.csv"] = odometry::EncodersCsv(all);
  CHECK(row().comparison.gap_m == told.comparison.gap_m);
  files["1/encoders.csv"] = odometry::EncodersCsv(earlier);
  CHECK(row().status == TrialStatus::kUnreadable);
  CHECK(row().reason ==
        "1/run.csv, its encoders: objective: odometry needs encoders on the clock of the log, and "
        "they share no time");
  CHECK(told.reference == "1/run.csv");
  for (trajectory::StampedPose& pose : log.poses) pose.yaw_rad = NAN;
  files["1/run.csv"] = trajectory::WriteRift(log);
  CHECK(row().status == TrialStatus::kUnreadable);
  CHECK_THAT(row().reason, Catch::Contains("objective: odometry needs the yaw of the log"));
  files.erase("1/encoders.csv");
  CHECK_THAT(row().reason, Catch::Contains("objective: odometry needs encoders (encoders.csv"));
}

TEST_CASE("A row of encoders that was cut short is left out and noted once, however many trials") {
  experiment::Experiment experiment = Lap(0.2);
  experiment.objective = experiment::Objective::kOdometry;
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  experiment.candidate.path.text = "run.csv";
  const trajectory::Trajectory log = test::StraightPath(0.5, 51);
  const double from_s = log.poses.front().t_s;
  test::Files files{
      {"run.csv", trajectory::WriteRift(log)},
      {"encoders.csv", odometry::EncodersCsv({{from_s, {0, 0}}, {from_s + 1.0, {9, 9}}})}};
  std::vector<std::string> notes;
  const auto gap_m = [&] {
    Inputs inputs = test::InputsOf(files);
    inputs.note = [&notes](const std::string& line) { notes.push_back(line); };
    Evaluator evaluator(experiment, "lap.yaml", inputs);
    const double first_m = evaluator.Evaluate({.trial = "1"}).comparison.gap_m;
    CHECK(evaluator.Evaluate({.trial = "2"}).comparison.gap_m == first_m);
    return first_m;
  };
  const double whole_m = gap_m();
  CHECK(notes.empty());
  files["encoders.csv"] += "9,1";
  CHECK(gap_m() == whole_m);
  CHECK(notes ==
        std::vector<std::string>{
            "encoders.csv: the last row was cut short while it was written: it is left out"});
}

TEST_CASE("The cells of a grid over a program tell its repeats apart from a robot that is stuck") {
  experiment::Experiment experiment = Lap(0.25);
  experiment.space.parameters = {
      {.key = "program.power",
       .levels = {experiment::NumberValue(0.25), experiment::NumberValue(0.02)}}};
  Evaluator evaluator(experiment, "lap.yaml", kNoFiles);
  experiment.trial.timeout_s = 200.0;
  const std::vector<ProgramCell> cells = MeasurePrograms(evaluator);
  REQUIRE(cells.size() == 2);
  CHECK(cells[0].measures.moved == 3);
  CHECK(cells[0].measures.spread_m > 0.0);
  CHECK(cells[0].measures.drift_per_m > 0.0);
  CHECK(cells[0].runs.size() == 3);
  CHECK_FALSE(cells[1].measures.DidMove());  // the gear's friction is stronger than 2 % of power
  experiment.program.segments.clear();
  CHECK(MeasurePrograms(evaluator).empty());
}

TEST_CASE("A setting whose program cannot be driven is a cell whose repeats are all lost") {
  experiment::Experiment experiment = Lap(0.25);
  experiment.reference.trials.names = {"1", "2"};
  experiment.space.parameters = {
      {.key = "program.power",
       .levels = {experiment::NumberValue(0.25), experiment::NumberValue(0.001)}}};
  Evaluator evaluator(experiment, "lap.yaml", kNoFiles);
  const std::vector<ProgramCell> cells = MeasurePrograms(evaluator);
  REQUIRE(cells.size() == 2);
  CHECK(cells[0].runs.size() == 2);
  CHECK(cells[0].lost.empty());
  CHECK(cells[1].runs.empty());
  CHECK(cells[1].measures.runs == 0);
  REQUIRE(cells[1].lost.size() == 2);
  CHECK_THAT(cells[1].lost[0], Catch::StartsWith("trial 1: "));
  CHECK_THAT(cells[1].lost[1],
             Catch::StartsWith("trial 2: ") && Catch::Contains("timeout_s is 60"));
}

TEST_CASE("A log beside encoders of another clock is a lost repeat, and the others are measured") {
  experiment::Experiment experiment = Lap(0.2);
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  experiment.candidate.path.text = "{trial}/run.csv";
  const std::string log = trajectory::WriteRift(test::StraightPath(0.5, 51));
  const double from_s = test::StraightPath(0.5, 51).poses.front().t_s;
  test::Files files;
  for (const std::string trial : {"1", "2", "3"}) {
    files[trial + "/run.csv"] = log;
    const double late_s = trial == "2" ? 1e6 : 0.0;
    files[trial + "/encoders.csv"] =
        odometry::EncodersCsv({{from_s + late_s, {0, 0}}, {from_s + late_s + 100.0, {500, 500}}});
  }
  files["3/encoders.csv"] = "nothing\n";
  Evaluator evaluator(experiment, "lap.yaml", test::InputsOf(files));
  const std::vector<ProgramCell> cells = MeasurePrograms(evaluator);
  REQUIRE(cells.size() == 1);
  CHECK(cells[0].runs.size() == 1);
  REQUIRE(cells[0].lost.size() == 2);
  CHECK_THAT(cells[0].lost[0],
             Catch::StartsWith("trial 2: 2/run.csv: ") && Catch::Contains("on one clock"));
  CHECK_THAT(cells[0].lost[1], Catch::StartsWith("trial 3: 3/encoders.csv"));
}

TEST_CASE("A run of somebody else's program that hangs again is given up again, and lost") {
  experiment::Experiment experiment = Lap(0.2);
  experiment.candidate.kind = experiment::CandidateKind::kProgram;
  experiment.candidate.run.words = {"sh", "-c", "sleep 2"};
  experiment.reference.kind = experiment::ReferenceKind::kPath;
  experiment.reference.trials.names = {"1"};
  experiment.run.timeout_s = 0.1;
  experiment.run.retries = 0;
  Evaluator evaluator(experiment, "lap.yaml", kNoFiles);
  const std::vector<ProgramCell> cells = MeasurePrograms(evaluator);
  REQUIRE(cells.size() == 1);
  REQUIRE(cells[0].lost.size() == 1);
  CHECK_THAT(cells[0].lost[0], Catch::Contains("0.1 s"));
}

TEST_CASE("Of a simulated robot the axle is held against its program, wherever its tag is") {
  experiment::Experiment experiment = Lap(0.3);
  experiment.program.laps = 1;
  experiment.program.segments = {{.straight_m = 0.2}, {.turn_deg = 90.0, .radius_m = 0.16}};
  experiment.reference.trials.names = {"1"};
  MakeExact(experiment.simulation);
  const auto end_error_m = [&](double tag_ahead_m) {
    experiment.simulation.mocap.tag_ahead_m = tag_ahead_m;
    Evaluator evaluator(experiment, "lap.yaml", kNoFiles);
    const std::vector<ProgramCell> cells = MeasurePrograms(evaluator);
    REQUIRE(cells.size() == 1);
    REQUIRE(cells[0].runs.size() == 1);
    return cells[0].runs[0].end_error_m;
  };
  CHECK(end_error_m(0.08) == Approx(end_error_m(0.0)).margin(0.005));
  const double known_m = end_error_m(0.0);
  experiment.space.parameters = {
      {.key = "simulation.mocap.tag_ahead_m", .levels = {experiment::NumberValue(0.08)}}};
  CHECK(end_error_m(0.0) == Approx(known_m).margin(0.005));
  experiment.space.parameters.clear();
  experiment.ensemble.keys = {"simulation.mocap.tag_ahead_m"};
  experiment.ensemble.draws = {{0.08}};
  CHECK(end_error_m(0.0) == Approx(known_m).margin(0.005));
}

TEST_CASE("The gap to a program is the robot's alone, wherever its tag is") {
  experiment::Experiment experiment = Lap(0.3);
  experiment.program.laps = 1;
  experiment.program.segments = {{.straight_m = 0.2}, {.turn_deg = 180.0, .radius_m = 0.16}};
  experiment.gap.trim_standstill = true;
  MakeExact(experiment.simulation);
  const auto gap_m = [&](double tag_ahead_m) {
    experiment.simulation.mocap.tag_ahead_m = tag_ahead_m;
    Evaluator evaluator(experiment, "lap.yaml", kNoFiles);
    const TrialRow row = evaluator.Evaluate(TrialsAt(experiment, {}).front());
    REQUIRE(row.IsOk());
    return row.comparison.gap_m;
  };
  CHECK(gap_m(0.08) == Approx(gap_m(0.0)).margin(0.005));
  CHECK(gap_m(-0.08) == Approx(gap_m(0.0)).margin(0.005));
  experiment.space.parameters = {
      {.key = "simulation.mocap.tag_ahead_m", .levels = {experiment::NumberValue(0.08)}}};
  experiment.simulation.mocap.tag_ahead_m = 0.0;
  Evaluator evaluator(experiment, "lap.yaml", kNoFiles);
  const TrialRow row =
      evaluator.Evaluate(TrialsAt(experiment, {experiment::NumberValue(0.08)}).front());
  CHECK(row.comparison.gap_m == Approx(gap_m(0.08)).margin(1e-9));
}

TEST_CASE("A program and waypoints after its start exclude each other") {
  experiment::Experiment experiment = Lap(0.2);
  experiment.waypoints = {{.name = "a", .x_m = 0.3, .y_m = 0.1, .heading_deg = 90.0}};
  CHECK(experiment::TaskOf(experiment).Start().x_m == 0.3);
  CHECK(experiment::TaskOf(experiment).Start().yaw_rad == Approx(geometry::kPi / 2.0));
  experiment.waypoints.push_back({.name = "b"});
  CHECK_THROWS_WITH(experiment::TaskOf(experiment), Catch::Contains("beside a program"));
  experiment.waypoints.clear();
  experiment.trial.timeout_s = 2.0;
  CHECK_THROWS_WITH(experiment::TaskOf(experiment), Catch::Contains("trial.timeout_s is 2"));
}

}  // namespace
}  // namespace rift::sweep
