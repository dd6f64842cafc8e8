// Runs of a program that fell, stood still or made a detour: what a fit and a likeness make of
// them.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/paths.hpp"
#include "sweep/calibrate/fitted_simulator.hpp"
#include "sweep/calibrate/model.hpp"
#include "sweep/calibrate/program_bench.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// Runs of these seeds, by a pattern of sh, give a path and then say that the robot fell.
std::string Falling(const std::string& seeds) {
  return "case \"$3\" in " + seeds + ") trap 'exit 11' EXIT;; esac";
}
/// Those of these seeds end well and have not moved.
std::string Standing(const std::string& seeds) {
  return "case \"$3\" in " + seeds + ") set -- \"$1\" 0 0;; esac";
}

/// At k = 1.5, for each log.
std::vector<LogPrediction> PredictedByThree(const Bench& bench) {
  CalibrationOptions options = OfWholeRuns({});
  options.runs = 3;
  return BenchTwins(bench).twins.Predict(Logs(bench, 9.0), {1.5}, options);
}

TEST_CASE("Of the runs in the place of a log, one that fell is compared and no run of the log") {
  const Bench bench(Falling("8"));
  const auto predictions = PredictedByThree(bench);
  CHECK(predictions[0].runs.size() == 2);
  CHECK(predictions[1].runs.size() == 3);
  CHECK(predictions[0].motions[46] == Approx(0.008 - 0.0012).margin(1e-4));  // of all three
  CHECK(predictions[0].motions[45] == Approx(0.3).margin(1e-4));
}

TEST_CASE("A run that stood still is passed over, whichever it is") {
  for (const std::string seed : {"7", "8"}) {
    const Bench bench(Standing(seed));
    const auto predictions = PredictedByThree(bench);
    CHECK(predictions[0].runs.size() == 2);
    CHECK(predictions[0].motions[45] == Approx(0.3).margin(1e-4));
    const double mean_m = seed == "7" ? 0.0085 : 0.008;  // of 8 and 9, or of 7 and 9
    CHECK(predictions[0].motions[46] == Approx(mean_m - 0.0012).margin(1e-4));
  }
}

TEST_CASE("A run in the place of a log that fell is tried again, and stands where all of them do") {
  const std::uint64_t first = SeedInPlace(7, 0, 0);
  for (const bool always : {false, true}) {
    const Bench bench(Falling(always ? "*" : std::to_string(first)));
    BenchTwins beside(bench);
    const std::vector<Trajectory> made = beside.twins.LogsAt(Logs(bench, 9.0), {1.5}, 0);
    CHECK(bench.Asked().size() == (always ? 20 : 3));
    CHECK(made[0].poses.back().x_m == Approx(1.5));
  }
}

TEST_CASE("A log that no run of the program gives a path in the place of is named") {
  const Bench bench("case \"$3\" in *500) exit 1;; esac");
  BenchTwins beside(bench);
  CHECK_THROWS_WITH(beside.twins.LogsAt(Logs(bench, 9.0), {1.5}, 0),
                    Catch::Contains("in the place of b_1.csv gives a path: "));
}

TEST_CASE("Runs that judge count as failed when they fell, stood still, or made a detour") {
  // One of the two runs of each log: of a they fall, of b they stand.
  Bench mixed(Falling("50031|150031") + "\n" + Standing("250031|350031"));
  mixed.experiment.calibrate.method.iterations = 1;
  Evaluator of_mixed(mixed.experiment, "e.yaml", mixed.AsInputs());
  const CalibrationReport half = Identify(of_mixed, 1, kSilent);
  CHECK(half.judged.back().before.runs == 8);
  CHECK(half.judged.back().before.failed_runs == 4);
  CHECK(half.judged.back().before.circled_runs == 0);
  Bench falling(Falling("*50030|*50031"));
  falling.experiment.calibrate.method.iterations = 1;
  Evaluator none_arrives(falling.experiment, "e.yaml", falling.AsInputs());
  const CalibrationReport empty = Identify(none_arrives, 1, kSilent);
  CHECK(empty.judged.back().before.failed_runs == 8);
  CHECK(empty.shown_real.poses.empty());
  Bench bench;
  bench.experiment.calibrate.fit.list[0].start = 2.0;
  bench.experiment.calibrate.method.iterations = 1;
  bench.experiment.likeness.longest_run = 1.5;  // of 1.2 m
  Evaluator evaluator(bench.experiment, "e.yaml", bench.AsInputs());
  const CalibrationReport report = Identify(evaluator, 1, kSilent);
  CHECK(report.judged.back().before.failed_runs == 8);
  CHECK(report.judged.back().before.circled_runs == 8);
  CHECK(report.judged.back().after.failed_runs == 0);
  CHECK(std::isnan(report.trials[0].gap_before_m));  // no run is left
  CHECK(report.trials[0].gap_after_m < 0.1);
  CHECK(report.shown_before.empty());
}

TEST_CASE("Each log is judged by the runs in its own place, and shown when it has one") {
  Bench bench(Falling("350030|350031"));  // those that judge b_2
  for (const auto& [name, left_m] : {std::pair("a_1.csv", 0.05), {"a_2.csv", -0.05}}) {
    bench.logs[name] =
        trajectory::WriteRift(test::Moved(test::StraightPath(1.2, 41), {0.0, left_m, 0.0}));
  }
  bench.experiment.calibrate.fit.list[0].start = 1.2;
  bench.experiment.calibrate.method.iterations = 1;
  bench.experiment.calibrate.method.likeness_weight = 0.0;  // the logs' speeds are all but one
  bench.experiment.calibrate.holdout.names = {"2"};
  Evaluator evaluator(bench.experiment, "e.yaml", bench.AsInputs());
  const CalibrationReport report = Identify(evaluator, 1, kSilent);
  // 0.05 m to either side of the runs; taken together the mean of both is none.
  REQUIRE(report.judged[2].level == "a");
  REQUIRE(report.judged[2].side == "both");
  CHECK(report.judged[2].before.path.mean_path_gap_m == Approx(0.05).margin(0.003));
  REQUIRE(report.trials.size() == 4);
  CHECK(std::isnan(report.trials[3].gap_after_m));
  CHECK(report.shown == 1);
}

TEST_CASE(
    "A program's runs count for the likeness of a sweep as they end, with a path or without") {
  const std::string of_trial_2 = "case \"$RIFT_TRIAL\" in *'\"trial\":\"2\"'*) ";
  for (const std::string& before :
       {of_trial_2 + "trap 'exit 11' EXIT;; esac", of_trial_2 + "set -- \"$1\" 0 0;; esac",
        of_trial_2 + "exit 1;; esac"}) {
    CAPTURE(before);
    Bench bench(before);
    bench.experiment.goal = experiment::Goal::kGrid;
    bench.experiment.calibrate = {};
    bench.experiment.candidate.run.words[3] = "1.2";
    Evaluator evaluator(bench.experiment, "e.yaml", bench.AsInputs());
    const std::vector<GroupLikeness> rows = MeasureSweepLikeness(evaluator);
    REQUIRE(rows.size() == 3);
    CHECK(rows[2].likeness.runs == 4);
    CHECK(rows[2].likeness.failed_runs == 2);
    CHECK(rows[0].likeness.failed_runs == 1);
  }
}

}  // namespace
}  // namespace rift::sweep
