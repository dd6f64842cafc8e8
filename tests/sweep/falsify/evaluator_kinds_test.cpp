// Which kinds of sides go together, how they are named, and what the evaluator says of logs.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "rift/experiment/task.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/memory_files.hpp"
#include "support/inputs/paths.hpp"
#include "support/inputs/png_bytes.hpp"

namespace rift::sweep {
namespace {

using Catch::Matchers::Contains;
using experiment::CandidateKind;
using experiment::Objective;
using experiment::ReferenceKind;
using experiment::Start;
using test::Files;
using test::InputsOf;

std::string LogAside(double left_m) {
  return trajectory::WriteRift(test::Moved(test::StraightPath(0.75, 40), {0.0, left_m, 0.0}));
}

experiment::Experiment Logs() {
  experiment::Experiment experiment;
  experiment.candidate.kind = CandidateKind::kLogs;
  experiment.candidate.path.text = "sim_{s}.csv";
  experiment.reference.kind = ReferenceKind::kLogs;
  experiment.reference.path.text = "{s}_{trial}.csv";
  experiment.reference.trials.names = {"1", "2", "3"};
  experiment.space.parameters = {{.key = "s", .levels = {{"a", {}}, {"b", {}}}}};
  return experiment;
}

experiment::Experiment Simulation() {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "s"}, {.name = "e", .x_m = 0.4}};
  experiment.reference.kind = ReferenceKind::kPath;
  experiment.reference.trials.names = {"1"};
  return experiment;
}

std::string Refusal(const experiment::Experiment& experiment) {
  const Files none;
  try {
    Evaluator(experiment, "e.yaml", InputsOf(none));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST_CASE(
    "When a trial began is the first row of the commands beside its log, where there are any") {
  const Files files{{"1/commands.csv", "t_s,power_left,power_right\n2.5,0,0\n2.6,0.1,0.1\n"},
                    {"2/commands.csv", ""},
                    {"3/commands.csv", "t_s,power_left,power_right\n"},
                    {"4/commands.csv", "left,t_s\n1,2\n"},
                    {"6/commands.csv", "t_s,power_left,power_right\n,0,0\n"}};
  const experiment::Experiment experiment = Simulation();
  const Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
  CHECK(evaluator.TrialBegan_s("1/trajectory.csv") == 2.5);
  for (const char* log :
       {"2/trajectory.csv", "3/trajectory.csv", "5/trajectory.csv", "6/trajectory.csv"}) {
    CHECK_FALSE(evaluator.TrialBegan_s(log));
  }
  CHECK_THROWS_WITH(evaluator.TrialBegan_s("4/trajectory.csv"),
                    "4/commands.csv: its first column is 'left', and that of commands.csv is t_s");
}

TEST_CASE("Paths of logs that are missing, or name what there is not, are refused with their key") {
  CHECK(Refusal(Logs()) == "accepted");
  experiment::Experiment without = Logs();
  without.candidate.path.text.clear();
  CHECK(Refusal(without) ==
        "e.yaml: candidate.path is missing: name the logs, such as candidate.path: "
        "logs/{surface}_{trial}.csv");
  without = Logs();
  without.reference.path.text.clear();
  CHECK(Refusal(without).starts_with("e.yaml: reference.path is missing: "));
  without = Logs();
  without.candidate.path.text = "{t}.csv";
  CHECK(Refusal(without).starts_with("e.yaml: candidate.path: path '{t}.csv' names {t}"));
  without = Logs();
  without.reference.path.text = "{t}.csv";
  CHECK(Refusal(without).starts_with("e.yaml: reference.path: path '{t}.csv' names {t}"));
  without = Logs();
  without.candidate.path.text = "sim.csv";
  without.reference.path.text = "{trial}.csv";
  CHECK(Refusal(without) ==
        "e.yaml: space.s is in neither candidate.path nor reference.path as {s}: they name "
        "{trial}");
  without.candidate.path.text = without.reference.path.text = "x.csv";
  CHECK_THAT(Refusal(without), Contains("they name nothing"));
  without.space.parameters[0].origin = "e.yaml:4:9";  // the file is named once
  CHECK(Refusal(without).starts_with("e.yaml:4:9: space.s is in neither "));
}

TEST_CASE("A start at the reference needs logs to start from, and a robot that rift places") {
  experiment::Experiment experiment = Simulation();
  experiment.start = Start::kReference;
  CHECK(Refusal(experiment) ==
        "e.yaml: start is reference, and reference.kind is path: only logs tell where the robot "
        "stood");
  experiment.reference.kind = ReferenceKind::kNominal;
  CHECK_THAT(Refusal(experiment), Contains("reference.kind is nominal"));
  experiment.reference.kind = ReferenceKind::kLogs;
  experiment.reference.path.text = "x.csv";
  CHECK(Refusal(experiment) == "accepted");
  experiment.candidate.kind = CandidateKind::kProgram;
  experiment.candidate.run.words = {"sim"};
  CHECK(Refusal(experiment) ==
        "e.yaml: start is reference, and candidate.kind is program: rift does not place somebody "
        "else's robot; leave start out");
}

TEST_CASE("Odometry as the objective is of one's own runs, and no program has encoders") {
  experiment::Experiment experiment = Simulation();
  experiment.objective = Objective::kOdometry;
  CHECK(Refusal(experiment) == "accepted");
  experiment.reference.kind = ReferenceKind::kLogs;
  experiment.reference.path.text = "x.csv";
  CHECK_THAT(Refusal(experiment), Contains("and reference.kind is logs: name logs as candidate"));
  experiment.reference.kind = ReferenceKind::kPath;
  experiment.candidate.kind = CandidateKind::kProgram;
  experiment.candidate.run.words = {"sim"};
  CHECK(Refusal(experiment) ==
        "e.yaml: objective is odometry, and a program (candidate.kind) has no encoders for rift");
}

TEST_CASE("A gap in space is refused for whatever has no height") {
  experiment::Experiment logs = Logs();
  logs.gap.dimension = gap::Dimension::kXyz;
  CHECK(Refusal(logs) == "accepted");
  experiment::Experiment experiment = Simulation();
  experiment.gap.dimension = gap::Dimension::kXyz;
  CHECK_THAT(Refusal(experiment),
             Contains("gap.dimension is xyz, and candidate.kind is simulation"));
  logs.reference.tag_offset_m = 0.03;
  CHECK_THAT(Refusal(logs), Contains("and reference.tag_offset_m is 0.03"));
  logs = Logs();
  logs.gap.dimension = gap::Dimension::kXyz;
  logs.waypoints = Simulation().waypoints;
  logs.reference.kind = ReferenceKind::kPath;
  CHECK_THAT(Refusal(logs), Contains("and reference.kind is path"));
  logs.reference.kind = ReferenceKind::kNominal;
  logs.objective = Objective::kOdometry;
  CHECK_THAT(Refusal(logs), Contains("and objective is odometry"));
}

TEST_CASE("A task that is none is said before the first trial, where there is to be one") {
  experiment::Experiment experiment = Simulation();
  experiment.waypoints.clear();
  CHECK(Refusal(experiment).starts_with("e.yaml: "));
  experiment.candidate.kind = CandidateKind::kLogs;
  experiment.candidate.path.text = "x.csv";
  CHECK(Refusal(experiment).starts_with("e.yaml: "));  // against its path
  experiment.reference.kind = ReferenceKind::kNominal;
  CHECK(Refusal(experiment).starts_with("e.yaml: "));
  experiment.reference.kind = ReferenceKind::kLogs;
  experiment.reference.path.text = "y.csv";
  CHECK(Refusal(experiment) == "accepted");  // logs against logs need none
}

TEST_CASE("Both sides are named by what they are") {
  const Files none;
  TrialRow row{.theta = {{"a", {}}}, .trial = "2", .seed = 5};
  const experiment::Experiment logs = Logs();
  Evaluator(logs, "e.yaml", InputsOf(none)).NameSides(row);
  CHECK(row.candidate == "sim_a.csv");
  CHECK(row.reference == "a_2.csv");
  experiment::Experiment simulation = Simulation();
  row.theta.clear();
  Evaluator(simulation, "e.yaml", InputsOf(none)).NameSides(row);
  CHECK(row.candidate == "simulation with seed 5");
  CHECK(row.reference == "waypoint path");
  row.seed.reset();
  simulation.seed = 8;
  simulation.reference.kind = ReferenceKind::kNominal;
  Evaluator(simulation, "e.yaml", InputsOf(none)).NameSides(row);
  CHECK(row.candidate == "simulation with seed 8");
  CHECK(row.reference == "simulation with seed 8");
  experiment::Experiment program = Simulation();
  program.waypoints.clear();
  program.program.segments = {{.straight_m = 0.3}};
  program.program.power = 0.3;
  Evaluator(program, "e.yaml", InputsOf(none)).NameSides(row);
  CHECK(row.reference == "program path");
  program = Simulation();
  program.reference.kind = ReferenceKind::kProgram;
  program.reference.run.words = {"sim"};
  row.seed = 3;
  Evaluator(program, "e.yaml", InputsOf(none)).NameSides(row);
  CHECK(row.candidate == "simulation with seed 3");
  CHECK(row.reference == "program with seed 3");
}

TEST_CASE("The noise floor is the mean gap of the logs that are there, each once") {
  const Files files{{"a_1.csv", LogAside(0.0)},
                    {"a_2.csv", LogAside(0.02)},
                    {"a_3.csv", LogAside(0.06)},
                    {"b_1.csv", LogAside(0.0)}};
  experiment::Experiment experiment = Logs();
  Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
  CHECK(evaluator.NoiseFloor_m({{"a", {}}}) == Approx((0.02 + 0.06 + 0.04) / 3.0));
  CHECK(std::isnan(evaluator.NoiseFloor_m({{"b", {}}})));  // one log is there
  experiment.reference.trials.names = {"1"};
  CHECK(std::isnan(Evaluator(experiment, "e.yaml", InputsOf(files)).NoiseFloor_m({{"a", {}}})));
  experiment::Experiment shared = Logs();
  shared.candidate.path.text = "{s}_{trial}_sim.csv";
  shared.reference.path.text = "{s}_1.csv";  // the same for all trials
  CHECK(std::isnan(Evaluator(shared, "e.yaml", InputsOf(files)).NoiseFloor_m({{"a", {}}})));
  experiment::Experiment path = Simulation();
  path.reference.trials.names = {"1", "2"};
  CHECK(std::isnan(Evaluator(path, "e.yaml", InputsOf(files)).NoiseFloor_m({})));
}

TEST_CASE(
    "The noise floor of nominal runs is the mean gap of their seeds, the same for all settings") {
  experiment::Experiment experiment = Simulation();
  experiment.reference.kind = ReferenceKind::kNominal;
  experiment.reference.trials.names = {"1", "2"};
  experiment.seed = 11;
  const Files none;
  Evaluator evaluator(experiment, "e.yaml", InputsOf(none));
  std::vector<trajectory::Trajectory> runs;
  for (const std::uint64_t seed : {11, 12}) {
    runs.push_back(Simulate(evaluator.TrialFor({.seed = seed}, {})).result.trajectory);
  }
  const double floor_m = gap::Gap(runs[0], runs[1], experiment.gap);
  CHECK(floor_m > 0.0);
  CHECK(evaluator.NoiseFloor_m({}) ==
        Approx(0.5 * (floor_m + gap::Gap(runs[1], runs[0], experiment.gap))));
}

TEST_CASE("Copies of a log give no noise floor, and none is known of one nominal run") {
  // To the last bit, and as one that was written anew with fewer digits.
  const Files files{{"a_1.csv", LogAside(0.0)},   {"a_2.csv", LogAside(0.0)},
                    {"a_3.csv", LogAside(4e-6)},  {"b_1.csv", LogAside(0.0)},
                    {"b_2.csv", LogAside(-4e-6)}, {"b_3.csv", LogAside(0.03)}};
  experiment::Experiment experiment = Logs();
  Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
  CHECK(std::isnan(evaluator.NoiseFloor_m({{"a", {}}})));
  CHECK(evaluator.NoiseFloor_m({{"b", {}}}) == Approx(0.03));
  // Recorded candidates have no seeds, so that all of them have the same nominal run.
  experiment.waypoints = Simulation().waypoints;
  experiment.reference.kind = ReferenceKind::kNominal;
  CHECK(std::isnan(Evaluator(experiment, "e.yaml", InputsOf(files)).NoiseFloor_m({{"a", {}}})));
}

TEST_CASE("A copied log of the robot beside runs with seeds of their own is noted once") {
  experiment::Experiment experiment = Simulation();
  experiment.reference.kind = ReferenceKind::kLogs;
  experiment.reference.path.text = "{trial}.csv";
  experiment.reference.trials.names = {"1", "2", "3", "4", "5"};
  Files files{{"1.csv", LogAside(0.0)}, {"2.csv", LogAside(0.01)}, {"4.csv", LogAside(0.01)}};
  files["3.csv"] = files["1.csv"];
  std::vector<std::string> notes;
  const auto inputs = [&] {
    Inputs noting = InputsOf(files);
    noting.note = [&notes](const std::string& line) { notes.push_back(line); };
    return noting;
  };
  Evaluator evaluator(experiment, "e.yaml", inputs());
  evaluator.LoadLogs();
  evaluator.LoadLogs();
  const std::string why = ": a log that was copied is no further drive of the robot";
  CHECK(notes == std::vector<std::string>{"3.csv: it has the positions of 1.csv" + why,
                                          "4.csv: it has the positions of 2.csv" + why});
  // One that is not there, before all others, is none of them and hides none.
  experiment.reference.trials.names.insert(experiment.reference.trials.names.begin(), "0");
  notes.clear();
  Evaluator(experiment, "e.yaml", inputs()).LoadLogs();
  CHECK(notes.size() == 2);
  notes.clear();
  // One log for all repeats is no copy, and of recorded candidates the rows are one run.
  experiment.reference.path.text = "1.csv";
  Evaluator(experiment, "e.yaml", inputs()).LoadLogs();
  experiment.reference.path.text = "{trial}.csv";
  experiment.candidate.kind = CandidateKind::kLogs;
  experiment.candidate.path.text = "2.csv";
  Evaluator(experiment, "e.yaml", inputs()).LoadLogs();
  CHECK(notes.empty());
}

TEST_CASE("Logs of a range are refused, and others read once, before the first trial") {
  experiment::Experiment experiment = Logs();
  experiment.candidate.kind = CandidateKind::kSimulation;
  experiment.waypoints = Simulation().waypoints;
  experiment.space.parameters = {{.key = "control.v_min", .min = 0.1, .max = 0.2, .origin = "e:3"}};
  experiment.reference.path.text = "{trial}.csv";
  std::map<std::string, int> read;
  const Inputs inputs{[&](const std::string& path) -> std::optional<std::string> {
                        ++read[path];
                        return LogAside(0.0);
                      },
                      [](const std::string&) {}};
  Evaluator evaluator(experiment, "e.yaml", inputs);
  evaluator.LoadLogs();
  evaluator.LoadLogs();
  CHECK(read == std::map<std::string, int>{{"1.csv", 1}, {"2.csv", 1}, {"3.csv", 1}});
  experiment.reference.path.text = "{v_min}.csv";
  CHECK_THROWS_WITH(Evaluator(experiment, "e.yaml", inputs).LoadLogs(),
                    "e:3: space.control.v_min is a range, and reference.path names a log for each "
                    "value of it: write a list of those there are");
}

TEST_CASE("Whoever reads logs is asked before each of them whether to go on") {
  const experiment::Experiment experiment = Logs();
  int read = 0;
  const Inputs inputs{[&](const std::string&) -> std::optional<std::string> {
                        ++read;
                        return LogAside(0.0);
                      },
                      [](const std::string&) {}};
  const auto stops_after = [&](int most) {
    read = 0;
    return !Evaluator(experiment, "e.yaml", inputs).LoadLogs([&] { return read < most; });
  };
  CHECK_FALSE(stops_after(1000));
  CHECK(read == 8);  // six of the reference, two of the candidate
  for (const int most : {0, 2, 6, 7}) {
    CHECK(stops_after(most));
    CHECK(read == most);
  }
}

TEST_CASE("A log of a robot that stands is a row that says so where standstill is trimmed") {
  experiment::Experiment experiment = Logs();
  experiment.reference.trials.names = {"1"};
  trajectory::Trajectory jitter = test::StraightPath(0.75, 40);
  for (size_t i = 0; i < jitter.poses.size(); ++i) jitter.poses[i].x_m = i % 2 == 0 ? 0.0 : 0.004;
  const Files files{{"sim_a.csv", trajectory::WriteRift(jitter)},
                    {"a_1.csv", LogAside(0.0)},
                    {"sim_b.csv", LogAside(0.0)},
                    {"b_1.csv", trajectory::WriteRift(jitter)}};
  const auto row_of = [&](size_t level) {
    Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
    return evaluator.Evaluate({{experiment.space.parameters[0].levels[level]}, "1"});
  };
  CHECK(row_of(0).IsOk());
  experiment.gap.trim_standstill = true;
  for (const size_t level : {0, 1}) {
    const TrialRow row = row_of(level);
    CHECK(row.status == TrialStatus::kUnreadable);
    CHECK_FALSE(row.Tells());
    CHECK(row.reason == std::string(level == 0 ? "sim_a.csv" : "b_1.csv") +
                            ": never leaves gap.standstill_radius_m, 0.01 m, so that all of it is "
                            "standstill");
  }
  experiment.gap.standstill_radius_m = 0.0035;
  CHECK(row_of(0).IsOk());
}

TEST_CASE("A trial's key holds the bytes of both logs") {
  Files files{{"a_1.csv", LogAside(0.0)}, {"sim_a.csv", LogAside(0.02)}};
  const experiment::Experiment experiment = Logs();
  const TrialRequest request{.theta = {{"a", {}}}, .trial = "1"};
  const auto key = [&] {
    Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
    evaluator.LoadLogs();
    return evaluator.KeyOf(request);
  };
  const std::string before = key();
  CHECK_THAT(before, Contains(" log=") && Contains(" candidate="));
  files["sim_a.csv"] = LogAside(0.03);
  const std::string of_candidate = key();
  CHECK(of_candidate != before);
  files["a_1.csv"] = LogAside(0.01);
  CHECK(key() != of_candidate);
}

TEST_CASE("A heightfield's picture is part of a trial's key at the settings that drive on it") {
  experiment::Experiment experiment = Simulation();
  simulation::SurfaceOptions hills;
  hills.shape = simulation::Shape::kHeightfield;
  hills.image = "hills.png";
  experiment.simulation.terrain.surfaces["hills"] = hills;
  experiment.space.parameters = {
      {.key = "simulation.terrain.surface", .levels = {{"ground", {}}, {"hills", {}}}}};
  Files files{{"hills.png", test::RampPng(100)}};
  const auto key = [&](const char* surface) {
    Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
    const std::string text = evaluator.KeyOf({.theta = {{surface, {}}}, .trial = "1", .seed = 1});
    const bool has_picture = evaluator.InputsText().ends_with("  hills.png\n");
    CHECK(has_picture == (text.find(" picture=") != text.npos));
    return text;
  };
  CHECK(key("ground").find("picture") == std::string::npos);
  const std::string before = key("hills");
  CHECK_THAT(before, Contains(" picture="));
  files["hills.png"] = test::RampPng(200);
  CHECK(key("hills") != before);
  experiment.reference.kind = ReferenceKind::kNominal;  // driven on the ground at every setting
  CHECK(key("ground").find("picture") == std::string::npos);
  experiment.simulation.terrain.surface = "hills";
  CHECK_THAT(key("ground"), Contains(" picture="));
  // Recorded runs drive on none, whatever their experiment has.
  experiment.candidate.kind = CandidateKind::kLogs;
  experiment.candidate.path.text = "{surface}.csv";
  experiment.reference.kind = ReferenceKind::kPath;
  CHECK(key("hills").find("picture") == std::string::npos);
}

TEST_CASE("A drive of the robot is a row with how it ended, against the reference of its trial") {
  experiment::Experiment experiment = Simulation();
  Files files{{"drive.csv",
               trajectory::WriteRift(test::Moved(test::StraightPath(0.4, 40), {0.0, 0.07, 0.0}))}};
  Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
  const TrialRequest request{.trial = "1", .seed = 3};
  const TrialRow arrived = evaluator.EvaluateDriven(request, "drive.csv", trial::Outcome::kReached);
  CHECK(arrived.IsOk());
  CHECK(arrived.comparison.gap_m == Approx(0.07));
  CHECK(arrived.falsified);
  CHECK(arrived.candidate == "drive.csv");
  CHECK(arrived.reference == "waypoint path");
  CHECK(arrived.seed == 3u);
  const TrialRow fell = evaluator.EvaluateDriven(request, "drive.csv", trial::Outcome::kFell);
  CHECK(fell.status == TrialStatus::kFell);
  CHECK(fell.reason == "drive.csv: the robot did not reach the end");
  CHECK(fell.falsified);
  CHECK(evaluator.EvaluateDriven(request, "gone.csv", trial::Outcome::kFell).status ==
        TrialStatus::kMissing);
  experiment.objective = Objective::kOdometry;
  CHECK_THROWS_WITH(evaluator.EvaluateDriven(request, "drive.csv", trial::Outcome::kReached),
                    "e.yaml: objective is odometry, and suggested drives are judged by the gap of "
                    "their poses");
}

TEST_CASE("Where references are logs, a drive takes their place beside a simulated run") {
  experiment::Experiment experiment = Simulation();
  experiment.reference.kind = ReferenceKind::kLogs;
  experiment.reference.path.text = "x.csv";
  Files files;
  Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
  const TrialRequest request{.trial = "1", .seed = 3};
  const SimulatedRun run = Simulate(evaluator.TrialFor(request, {}));
  files["drive.csv"] = trajectory::WriteRift(run.result.trajectory);
  const TrialRow row = evaluator.EvaluateDriven(request, "drive.csv", trial::Outcome::kReached);
  CHECK(row.IsOk());
  CHECK(row.candidate == "simulation with seed 3");
  CHECK(row.reference == "drive.csv");
  CHECK(row.comparison.gap_m < 1e-6);
}

TEST_CASE("A drive in the place of reference logs is moved by the tag's offset as they are") {
  experiment::Experiment experiment = Simulation();
  experiment.reference.kind = ReferenceKind::kLogs;
  experiment.reference.path.text = "x.csv";
  experiment.reference.tag_offset_m = 0.03;
  Files files;
  for (const Start start : {Start::kWaypoint, Start::kReference}) {
    experiment.start = start;
    Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
    const TrialRequest request{.trial = "1", .seed = 3};
    const SimulatedTrial driven =
        evaluator.TrialOf(experiment, experiment::AxleAtStart(experiment), 3);
    files["drive.csv"] = trajectory::WriteRift(Simulate(driven).result.trajectory);
    const TrialRow row = evaluator.EvaluateDriven(request, "drive.csv", trial::Outcome::kReached);
    INFO((start == Start::kReference ? "from where it stood" : "from the waypoint"));
    CHECK(row.IsOk());
    CHECK(row.comparison.gap_m < 0.005);
  }
}

TEST_CASE("A drive of another task or controller than the setting's is noted and does not count") {
  experiment::Experiment experiment = Simulation();
  experiment.space.parameters = {
      {.key = "control.v_max",
       .levels = {experiment::NumberValue(0.3), experiment::NumberValue(0.4)}}};
  const TrialRequest request{.theta = {experiment::NumberValue(0.4)}, .trial = "1", .seed = 3};
  experiment::Experiment driven = experiment;
  driven.control.v_max = 0.4;
  std::vector<std::string> notes;
  const auto tells = [&](const std::function<void(experiment::Experiment&)>& change) {
    experiment::Experiment changed = driven;
    change(changed);
    const Files files{{"drive.csv", trajectory::WriteRift(test::StraightPath(0.4, 40))},
                      {"experiment.yaml", experiment::WriteExperiment(changed)}};
    notes.clear();
    Evaluator evaluator(experiment, "e.yaml", {InputsOf(files).read, [&](const std::string& line) {
                                                 notes.push_back(line);
                                               }});
    const TrialRow row = evaluator.EvaluateDriven(request, "drive.csv", trial::Outcome::kReached);
    CHECK(notes.empty() == row.Tells());
    return row.Tells();
  };
  CHECK(tells([](experiment::Experiment&) {}));
  CHECK(tells([](experiment::Experiment& drive) {
    drive.hardware.line.baud = 115200;
    drive.simulation.motor.mismatch = 0.1;
    drive.gap.threshold_m = 0.5;
  }));
  CHECK_FALSE(tells([](experiment::Experiment& drive) { drive.control.v_max = 0.3; }));
  REQUIRE(notes.size() == 1);
  CHECK(notes[0] ==
        "experiment.yaml: control.v_max is 0.3, and 0.4 in this sweep: this drive does not count");
  CHECK_FALSE(tells([](experiment::Experiment& drive) { drive.waypoints.back().y_m = 0.1; }));
  CHECK_FALSE(
      tells([](experiment::Experiment& drive) { drive.trial.pace = trial::Pace::kNewPose; }));
}

TEST_CASE("A drive that tells nothing is noted with what came of it") {
  experiment::Experiment experiment = Simulation();
  experiment.reference.kind = ReferenceKind::kLogs;
  experiment.reference.path.text = "x.csv";
  Files files{{"drive.csv", trajectory::WriteRift(test::StraightPath(0.4, 40))}};
  std::vector<std::string> notes;
  Evaluator evaluator(experiment, "e.yaml", {InputsOf(files).read, [&](const std::string& line) {
                                               notes.push_back(line);
                                             }});
  const TrialRequest request{.trial = "1", .seed = 3};
  CHECK(evaluator.EvaluateDriven(request, "drive.csv", trial::Outcome::kReached).IsOk());
  CHECK(notes.empty());
  CHECK_FALSE(evaluator.EvaluateDriven(request, "drive.csv", trial::Outcome::kFell).Tells());
  REQUIRE(notes.size() == 1);
  CHECK(notes[0] == "drive.csv: the robot did not reach the end: this drive does not count");
  experiment.trial.timeout_s = 1.0;  // no simulated run arrives, and that is no failure
  experiment.falsify.count.timed_out = false;
  CHECK_FALSE(evaluator.EvaluateDriven(request, "drive.csv", trial::Outcome::kReached).Tells());
  REQUIRE(notes.size() == 2);
  CHECK_THAT(notes[1], Catch::StartsWith("drive.csv: simulation with seed 3: ") &&
                           Catch::EndsWith(": this drive does not count"));

  // An experiment beside the log that no one can read ends no sweep.
  files["experiment.yaml"] = std::string(2 * 1024 * 1024, ' ');
  Evaluator beside(experiment, "e.yaml",
                   {InputsOf(files).read, [&](const std::string& line) { notes.push_back(line); }});
  CHECK_FALSE(beside.EvaluateDriven(request, "drive.csv", trial::Outcome::kReached).Tells());
  REQUIRE(notes.size() == 3);
  CHECK(notes[2] ==
        "experiment.yaml: 2097152 bytes of YAML: at most 1048576 are taken; --large-inputs lifts "
        "this limit: this drive does not count");
}

TEST_CASE("A setting that breaks a rule, and a start without a yaw, are rows that say so") {
  experiment::Experiment experiment = Simulation();
  experiment.space.parameters = {{.key = "trial.pose_stale_s", .min = 0.1, .max = 9.0}};
  const Files none;
  for (const ReferenceKind kind : {ReferenceKind::kPath, ReferenceKind::kNominal}) {
    experiment.reference.kind = kind;
    const TrialRow broken = Evaluator(experiment, "e.yaml", InputsOf(none))
                                .Evaluate({.theta = {{"5", 5.0}}, .trial = "1", .seed = 1});
    CHECK(broken.status == TrialStatus::kInvalid);
    CHECK_THAT(broken.reason, Contains("pose_stale_s is 5, and it must not exceed lost_after_s"));
    CHECK(broken.candidate == "experiment");
    CHECK(broken.reference ==
          (kind == ReferenceKind::kPath ? "waypoint path" : "simulation with seed 1"));
    CHECK_FALSE(broken.falsified);
  }
  experiment = Simulation();
  experiment.start = Start::kReference;
  experiment.reference.kind = ReferenceKind::kLogs;
  experiment.reference.path.text = "x.csv";
  trajectory::Trajectory log = test::StraightPath(0.4, 40);
  for (auto& pose : log.poses) pose.yaw_rad = NAN;
  const Files files{{"x.csv", trajectory::WriteRift(log)}};
  const TrialRow row =
      Evaluator(experiment, "e.yaml", InputsOf(files)).Evaluate({.trial = "1", .seed = 1});
  CHECK(row.status == TrialStatus::kUnreadable);
  CHECK(row.reason == "x.csv: start: reference needs its yaw: set reference.format");
}

TEST_CASE("A robot that starts at its reference stands where the tag was, behind it") {
  const trajectory::Trajectory log = test::Moved(test::StraightPath(0.4, 200), {1.0, 2.0, 0.5});
  simulation::MocapOptions mocap;
  mocap.tag_ahead_m = 0.04;
  const geometry::Pose2 stood = trajectory::StandingPose(log);
  const geometry::Pose2 start = StartFromLog(log, 0.03, mocap);
  CHECK(start.yaw_rad == Approx(stood.yaw_rad));
  CHECK(start.x_m == Approx(stood.x_m - 0.07 * std::cos(stood.yaw_rad)));
  CHECK(start.y_m == Approx(stood.y_m - 0.07 * std::sin(stood.yaw_rad)));
}

TEST_CASE("Candidate and nominal run begin with the tag on the first waypoint") {
  for (const double tag_ahead_m : {-0.03, 0.04}) {
    experiment::Experiment experiment = Simulation();
    experiment.waypoints = {{.name = "s", .x_m = 0.1, .y_m = -0.2, .heading_deg = 30.0},
                            {.name = "e", .x_m = 0.5}};
    experiment.simulation.mocap.tag_ahead_m = tag_ahead_m;
    experiment.reference.kind = ReferenceKind::kNominal;
    const Files none;
    Evaluator evaluator(experiment, "e.yaml", InputsOf(none));
    const TrialRequest request{.trial = "1", .seed = 1};
    const Recording nominal = evaluator.Reference(request);
    for (const Recording& run : {nominal, evaluator.Candidate(request, nominal)}) {
      REQUIRE(!run.trajectory.poses.empty());
      const trajectory::StampedPose& first = run.trajectory.poses.front();
      INFO(tag_ahead_m << ": " << first.x_m << " " << first.y_m);
      CHECK(std::hypot(first.x_m - 0.1, first.y_m + 0.2) < 0.005);  // the camera's noise
    }
  }
}

TEST_CASE("A log is moved along its yaw by the tag's offset, and refused where it has none") {
  const std::string text =
      trajectory::WriteRift(test::Moved(test::StraightPath(0.4, 5), {0, 0, 1}));
  const trajectory::Log moved = ReadMovedLog(text, "x.csv", {.tag_offset_m = 0.1});
  CHECK(moved.trajectory.poses[0].x_m == Approx(0.1 * std::cos(1.0)));
  CHECK(moved.trajectory.poses[0].y_m == Approx(0.1 * std::sin(1.0)));
  CHECK(ReadMovedLog("t_s,x_m,y_m\n0,0,0\n1,1,0\n", "x.csv", {}).trajectory.poses.size() == 2);
  CHECK_THROWS_WITH(
      ReadMovedLog("t_s,x_m,y_m\n0,0,0\n1,1,0\n", "x.csv", {.tag_offset_m = -0.02}),
      "x.csv: a tag offset of -0.02 m needs the yaw, and it logs none: leave the tag offset at 0");
  CHECK_THROWS_WITH(
      ReadMovedLog("t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,1,0,\n", "x.csv", {.tag_offset_m = 0.02}),
      "x.csv: a tag offset of 0.02 m needs the yaw, and line 3 has none");
  LogOptions of_reference;
  of_reference.tag_offset_m = 0.02;
  of_reference.format_key = "reference.format";
  CHECK_THROWS_WITH(
      ReadMovedLog("t,x,y,z,roll,pitch,yaw,desired_x,desired_y\n0,1,2,0.8,0,-33,1,5,6\n"
                   "1,2,2,0.8,0,0,3,5,6\n",
                   "x.csv", of_reference),
      Catch::StartsWith("x.csv: a tag offset of 0.02 m needs the yaw, and ") &&
          Catch::EndsWith(": set reference.format"));
}

}  // namespace
}  // namespace rift::sweep
