// Small parts of a sweep: what an explanation holds, ensembles at bounds, trials of experiments,
// cells of programs that were lost.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "rift/sweep/calibrate/ensemble.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/explain/program_cells.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/falsify/sweep.hpp"
#include "rift/sweep/falsify/uncrossed_note.hpp"
#include "support/inputs/paths.hpp"
#include "support/inputs/png_bytes.hpp"

namespace rift::sweep {
namespace {

using Files = std::map<std::string, std::string>;

Inputs InputsOf(const Files& files) {
  return {[&files](const std::string& path) -> std::optional<std::string> {
            const auto found = files.find(path);
            return found == files.end() ? std::nullopt : std::optional(found->second);
          },
          [](const std::string&) {}};
}

TEST_CASE("An explanation has an answer to every question about its table") {
  SweepResult result;
  result.reference_kind = "nominal";
  result.parameters = {{.key = "simulation.terrain.surface", .levels = {{"ice", {}}, {"rock", {}}}},
                       {.key = "control.v_min", .levels = {{"0.1", 0.1}, {"0.2", 0.2}}}};
  std::uint64_t path = 1;
  for (const auto& surface : result.parameters[0].levels) {
    for (const auto& v_min : result.parameters[1].levels) {
      for (int i = 0; i < 4; ++i) {
        TrialRow row{.theta = {surface, v_min}, .trial = std::to_string(i), .is_random_draw = true};
        row.comparison.gap_m = (surface.text == "ice" ? 0.09 : 0.03) + 0.001 * i;
        row.comparison.start_aligned_gap_m = row.comparison.gap_m - 0.01;
        row.falsified = surface.text == "ice";
        row.evidence.fingerprint = path++;
        row.evidence.errors_m = {{0.01, 0.02}, {0.02, 0.04}};
        result.rows.push_back(row);
      }
    }
  }
  Summarise(result);
  const RobotTrials driven{{{"ice", {}}, {"0.1", 0.1}}, true, 3, 3};
  ExplainOptions options;
  options.suggest.least_gain = 0.0;
  options.robot = {driven};
  const Explanation found = Explain(result, options);
  CHECK(found.effects.parameters.at(0).name == "surface");
  CHECK(found.inert.size() == 2);
  CHECK(found.anatomy.start_m.mean == Approx(0.01));
  CHECK(found.clusters.at(0).rows.size() == 8);
  CHECK(found.region.cells.size() == 4);
  CHECK(found.region.x_parameter == 0);
  CHECK(found.probability.draws == 4);
  CHECK(found.probability.failures == 2);
  CHECK(found.robot.size() == 1);
  CHECK(found.suggestions.trusted == Approx(2.0 / 3.0));
  CHECK_FALSE(found.suggestions.list.empty());
}

TEST_CASE("Draws beyond a bound are folded back from it, to either side and more than once") {
  Calibration fit;
  fit.parameters = {{.parameter = {.key = "a", .min = 0.0, .max = 1.0},
                     .value = 0.95,
                     .low = 0.95 - 1.959964 * 3.0,
                     .high = 0.95 + 1.959964 * 3.0}};
  fit.correlation = Eigen::MatrixXd::Identity(1, 1);
  const experiment::Ensemble wide = EnsembleOf(fit, 0.95, 4000, 1);
  double sum = 0.0, least = 1.0, most = 0.0;
  for (const auto& draw : wide.draws) {
    sum += draw[0];
    least = std::min(least, draw[0]);
    most = std::max(most, draw[0]);
  }
  CHECK(least >= 0.0);
  CHECK(most <= 1.0);
  CHECK(sum / 4000.0 == Approx(0.5).margin(0.03));  // three ranges wide: even within it
  // The same draws where nothing is folded tell what the mirrors make of each of them.
  Calibration open = fit;
  open.parameters[0].parameter.min = -100.0;
  open.parameters[0].parameter.max = 100.0;
  const experiment::Ensemble unfolded = EnsembleOf(open, 0.95, 4000, 1);
  for (size_t i = 0; i < 200; ++i) {
    double value = unfolded.draws[i][0];
    while (value < 0.0 || value > 1.0) value = value < 0.0 ? -value : 2.0 - value;
    CHECK(wide.draws[i][0] == Approx(value).margin(1e-9));
  }
  fit.parameters[0].parameter.max = 0.0;  // without width
  CHECK(EnsembleOf(fit, 0.95, 1, 1).draws[0][0] == 0.0);
}

experiment::Experiment Way() {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "s"}, {.name = "e", .x_m = 0.3, .stop = true}};
  experiment.reference.kind = experiment::ReferenceKind::kPath;
  experiment.reference.trials.names = {"1", "2"};
  return experiment;
}

TEST_CASE("A simulated trial is made of its experiment, start and seed, and needs its picture") {
  experiment::Experiment experiment = Way();
  experiment.control.v_min = 0.17;
  experiment.trial.timeout_s = 9.0;
  Files files;
  const SimulatedTrial trial =
      SimulatedTrialOf(experiment, {1.0, 2.0, 0.5}, 77, "e.yaml", InputsOf(files));
  CHECK(trial.seed == 77);
  CHECK(trial.start == geometry::Pose2{1.0, 2.0, 0.5});
  CHECK(trial.control.v_min == 0.17);
  CHECK(trial.trial.timeout_s == 9.0);
  CHECK(trial.task.waypoints.size() == 2);
  CHECK(trial.image == nullptr);
  simulation::SurfaceOptions hills;
  hills.shape = simulation::Shape::kHeightfield;
  hills.image = "hills.png";
  experiment.simulation.terrain.surfaces["hills"] = hills;
  experiment.simulation.terrain.surface = "hills";
  const auto make = [&] { return SimulatedTrialOf(experiment, {}, 1, "e.yaml", InputsOf(files)); };
  CHECK_THROWS_WITH(make(), "cannot read hills.png: No such file or directory");
  files["hills.png"] = "no picture";
  CHECK_THROWS_WITH(make(), Catch::StartsWith("hills.png: "));
  files["hills.png"] = test::RampPng(200);
  CHECK(make().image != nullptr);
  experiment.waypoints.clear();
  CHECK_THROWS_WITH(make(), Catch::StartsWith("e.yaml: "));
}

TEST_CASE("A heightfield that the task crosses nowhere is told with where it lies") {
  SimulatedTrial trial{.task = Way().waypoints};  // from x 0 to 0.3 m, y 0
  CHECK_FALSE(UncrossedNote(trial));
  simulation::SurfaceOptions& hills = trial.simulation.terrain.surfaces["ground"];
  hills.shape = simulation::Shape::kHeightfield;
  hills.image = "hills.png";
  hills.image_width_m = 0.1;
  trial.image = std::make_shared<simulation::HeightImage>(
      simulation::HeightImage{5, 3, std::vector<double>(15, 1.0)});  // 0.1 m by 0.05 m
  for (const auto& [x_m, y_m, is_crossed] : {std::tuple{0.15, 0.0, true},
                                             {0.349, 0.0, true},
                                             {0.351, 0.0, false},
                                             {-0.051, 0.0, false},
                                             {0.15, 0.0249, true},
                                             {0.15, 0.0251, false},
                                             {0.15, -0.0251, false}}) {
    INFO(x_m << " " << y_m);
    hills.image_x_m = x_m;
    hills.image_y_m = y_m;
    CHECK(UncrossedNote(trial).has_value() == !is_crossed);
  }
  // A narrow one is not stepped over, on whichever leg it lies.
  trial.task = std::vector<control::Waypoint>{
      {.name = "s"}, {.name = "a", .x_m = 0.3}, {.name = "b", .x_m = 0.3, .y_m = 0.3}};
  hills.image_width_m = 0.01;
  hills.image_y_m = 0.0;
  for (const double x_m : {0.07, 0.22}) {
    hills.image_x_m = x_m;
    CHECK_FALSE(UncrossedNote(trial));
  }
  hills.image_width_m = 0.0025;  // on a way that is looked at every 2 mm
  hills.image_x_m = 0.07;
  CHECK_FALSE(UncrossedNote(trial));
  hills.image_width_m = 0.01;
  hills.image_x_m = 0.3;
  hills.image_y_m = 0.17;
  CHECK_FALSE(UncrossedNote(trial));
  hills.image_width_m = 0.1;
  hills.image_x_m = 150.0;
  hills.image_y_m = 0.0;
  CHECK_THAT(UncrossedNote(trial).value_or(""),
             Catch::StartsWith("note: the path of the task crosses hills.png nowhere, which covers "
                               "x from 149.95 to 150.05 m and y from -0.025 to 0.025 m"));
}

TEST_CASE("A simulated run has its true path and its wheels on one clock, each moment once") {
  SimulatedTrial trial{.task = Way().waypoints, .seed = 3};
  const SimulatedRun run = Simulate(trial);
  REQUIRE(run.truth.poses.size() > 10);
  for (size_t i = 1; i < run.truth.poses.size(); ++i) {
    CHECK(run.truth.poses[i].t_s > run.truth.poses[i - 1].t_s);
  }
  REQUIRE(run.encoders.size() > 10);
  for (size_t i = 1; i < run.encoders.size(); ++i) {
    CHECK(run.encoders[i].t_s > run.encoders[i - 1].t_s);
  }
  CHECK(run.truth.poses.front().x_m == Approx(0.0).margin(1e-6));
  CHECK(run.truth.poses.front().z_m == Approx(run.truth.poses.front().z_m));  // logged
  CHECK(run.encoders.back().counts.left > 100);
  CHECK(run.encoders.back().counts.right > 100);
  trial.simulation.encoder.reported = false;
  CHECK(Simulate(trial).encoders.empty());
}

TEST_CASE("The ideal path of a task is its waypoints, or its program's way at its pace") {
  const trajectory::Trajectory way = IdealPath(Way().waypoints);
  REQUIRE(way.poses.size() == 2);
  CHECK(way.poses[1].x_m == 0.3);
  CHECK(way.poses[1].t_s == 1.0);
  experiment::Experiment lap;
  lap.program.power = 0.2;
  lap.program.laps = 1;
  lap.program.segments = {{.straight_m = 0.4}, {.turn_deg = -90.0}};
  lap.trial.timeout_s = 60.0;
  const trajectory::Trajectory path = IdealPath(experiment::TaskOf(lap));
  CHECK(path.poses.back().x_m == Approx(0.4));
  CHECK(path.poses.back().yaw_rad == Approx(-geometry::kPi / 2.0));
  CHECK(path.poses.front().yaw_rad == 0.0);
  CHECK(path.poses[1].t_s == Approx(0.02).margin(1e-4));
}

TEST_CASE("A run of a program that left no path is lost with its reason, and the others count") {
  experiment::Experiment experiment;
  experiment.program.power = 0.2;
  experiment.program.laps = 1;
  experiment.program.segments = {{.straight_m = 0.7}};
  experiment.trial.timeout_s = 60.0;
  experiment.simulation.mocap.tag_ahead_m = 0.1;  // on no robot that left a log
  experiment.candidate.kind = experiment::CandidateKind::kLogs;
  experiment.candidate.path.text = "{trial}/run.csv";
  experiment.reference.kind = experiment::ReferenceKind::kPath;
  experiment.reference.trials.names = {"1", "2", "3"};
  Files files{{"1/run.csv", trajectory::WriteRift(test::StraightPath(0.7, 40))},
              {"3/run.csv", trajectory::WriteRift(test::StraightPath(0.6, 40))}};
  Evaluator evaluator(experiment, "e.yaml", InputsOf(files));
  const std::vector<ProgramCell> cells = MeasurePrograms(evaluator);
  REQUIRE(cells.size() == 1);
  CHECK(cells[0].lost == std::vector<std::string>{"trial 2: no such file"});
  CHECK(cells[0].runs.size() == 2);
  CHECK(cells[0].measures.runs == 2);
  CHECK(cells[0].measures.deviation_m == Approx(0.025).epsilon(0.12));  // 0.1 u of one of two
  experiment.goal = experiment::Goal::kFalsify;
  CHECK(MeasurePrograms(evaluator).empty());
}

TEST_CASE("A grid asks for further trials until its settings are decided, where it is to") {
  experiment::Experiment plan = Way();
  plan.seed = 40;
  plan.space.parameters = {{.key = "x", .levels = {{"1", 1.0}, {"2", 2.0}}}};
  std::map<std::string, int> trials;
  const RunTrials run = RunHere(
      [&](const TrialRequest& request) {
        ++trials[request.theta[0].text];
        TrialRow row = RowFor(request);
        row.falsified = request.theta[0].text == "1";
        row.comparison.gap_m = row.falsified ? 0.08 : 0.02;
        row.evidence.fingerprint = *request.seed + (row.falsified ? 0 : 1000);
        return row;
      },
      {});
  SweepResult result = *SweepGrid(plan, run);
  CHECK(trials == std::map<std::string, int>{{"1", 2}, {"2", 2}});
  plan.falsify.repeat = Repeat::kEvery;
  trials.clear();
  result = *SweepGrid(plan, run);
  CHECK(trials["1"] < 10);
  CHECK(trials["2"] > 20);
  CHECK(result.settings[0].verdict.verdict == gap::Verdict::kFalsified);
  CHECK(result.settings[1].verdict.verdict == gap::Verdict::kPassed);
  CHECK(result.settings[0].rows.size() == static_cast<size_t>(trials["1"]));
  // Rows stand setting by setting, each with the next seed.
  for (size_t i = 0; i < result.settings[0].rows.size(); ++i) {
    CHECK(result.settings[0].rows[i] == static_cast<int>(i));
    CHECK(result.rows[i].seed == 40 + i);
  }
  CHECK(result.rows[static_cast<size_t>(trials["1"])].seed == 40u);
  plan.candidate.kind = experiment::CandidateKind::kLogs;  // no seeds: nothing to repeat
  int asked = 0;
  SweepGrid(plan, RunHere(
                      [&](const TrialRequest& request) {
                        ++asked;
                        return RowFor(request);
                      },
                      {}));
  CHECK(asked == 4);
  CHECK_FALSE(SweepGrid(plan, [](const auto&) { return std::nullopt; }));
}

}  // namespace
}  // namespace rift::sweep
