// Runs of a program that fell, stood still or made a detour: what a fit and a likeness make of
// them.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

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

}  // namespace
}  // namespace rift::sweep
