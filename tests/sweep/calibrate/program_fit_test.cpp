// A fit of somebody else's program, here a line of awk: which runs it asks for, and what it finds.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "rift/statistics/random.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/paths.hpp"
#include "sweep/calibrate/fitted_simulator.hpp"
#include "sweep/calibrate/model.hpp"
#include "sweep/calibrate/program_bench.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

TEST_CASE("A program's parameter is found from whole runs, and judged by others") {
  const Bench bench;
  Evaluator evaluator(bench.experiment, "e.yaml", bench.AsInputs());
  std::vector<std::string> said;
  const CalibrationReport report =
      Identify(evaluator, 1, [&](const std::string& line) { said.push_back(line); });
  REQUIRE(report.values.size() == 1);
  CHECK(report.values[0] == Approx(1.2).margin(0.02));
  CHECK(report.errors.empty());  // nobody can ask a program for the next frames
  REQUIRE(report.trials.size() == 4);
  for (const CalibrationTrial& trial : report.trials) {
    CHECK(trial.gap_after_m < 0.1 * trial.gap_before_m);
    CHECK(trial.gap_before_m == Approx(0.4).margin(0.01));
  }
  REQUIRE(said.size() >= 3);
  // A program without noise repeats itself.
  CHECK(said[0].starts_with("warning: a_2.csv (and 2 more logs): it has the rows of a_1.csv"));
  CHECK(said[1] == "fitting 1 parameters to 4 logs; 0 held out");
  CHECK(said[2].starts_with("note: a program is fitted and judged by whole runs"));
  CHECK(std::any_of(said.begin(), said.end(), [](const std::string& line) {
    return line.find(" descent by motions, step 1 of at most 3: k 1.") != line.npos;
  }));
  // Each log has seeds of its own, and those that judge are none that were fitted with.
  const std::vector<std::string> asked = bench.Asked();
  const auto has = [&](const std::string& end) {
    return std::any_of(asked.begin(), asked.end(),
                       [&](const std::string& line) { return line.ends_with(" " + end); });
  };
  for (const char* seed : {"30", "100030", "200030", "300030", "50030", "50031", "350030"}) {
    INFO(seed);
    CHECK(has(seed));
  }
  CHECK_FALSE(has("31"));
  CHECK_FALSE(has("50032"));
}

TEST_CASE("Further starts of a fit are drawn off the ends of the ranges, with seeds of their own") {
  Bench bench;
  bench.experiment.calibrate.starts = 3;
  bench.experiment.calibrate.method.iterations = 1;
  Evaluator evaluator(bench.experiment, "e.yaml", bench.AsInputs());
  const CalibrationReport report = Identify(evaluator, 1, kSilent);
  REQUIRE(report.agreement.size() == 1);
  CHECK(report.agreement[0].values.size() == 3);
  // That of the experiment's own start stands.
  CHECK(report.agreement[0].values[0] != report.agreement[0].values[2]);
  CHECK(report.values[0] == report.agreement[0].values[0]);
  CHECK(report.calibration.parameters[0].value == report.values[0]);
  const std::vector<std::string> asked = bench.Asked();
  for (const std::uint64_t start : {0, 1, 2}) {
    const double share = 0.1 + 0.8 * statistics::Random(30, 80 + start).Uniform();
    const double expected = start == 0 ? 0.8 : 0.5 + 1.5 * share;
    for (const std::uint64_t log : {0, 1, 2, 3}) {
      const std::uint64_t seed = 30 + 100'000 * log + 100 * start;
      INFO("start " << start << ", log " << log);
      CHECK(std::any_of(asked.begin(), asked.end(), [&](const std::string& line) {
        const size_t blank = line.find(' ');
        return line.substr(blank + 1) == std::to_string(seed) &&
               std::abs(std::stod(line.substr(0, blank)) - expected) < 1e-9;
      }));
    }
  }
}

/// "a fitted", "a held out", ...: which groups of logs are judged.
std::vector<std::string> GroupsOf(const CalibrationReport& report) {
  std::vector<std::string> groups;
  for (const JudgedGroup& group : report.judged) groups.push_back(group.level + " " + group.side);
  return groups;
}

TEST_CASE("Logs are judged by level and side, those held out beside what the others tell") {
  Bench bench;
  bench.logs["a_2.csv"] =
      trajectory::WriteRift(test::Moved(test::StraightPath(1.2, 41), {0.0, 0.05, 0.001}));
  bench.experiment.calibrate.method.iterations = 1;
  bench.experiment.calibrate.judge_runs = 4;
  const auto report = [&bench] {
    Evaluator evaluator(bench.experiment, "e.yaml", bench.AsInputs());
    return Identify(evaluator, 1, kSilent);
  };
  CHECK(GroupsOf(report()) == std::vector<std::string>{"a fitted", "b fitted", "all fitted"});

  bench.experiment.calibrate.holdout.names = {"2"};
  const CalibrationReport held = report();
  CHECK(GroupsOf(held) == std::vector<std::string>{"a fitted", "a held out", "a both", "b fitted",
                                                   "b held out", "b both", "all fitted",
                                                   "all held out", "all both"});
  for (size_t i = 0; i < held.judged.size(); ++i) {
    const int logs = (i % 3 == 2 ? 2 : 1) * (i < 6 ? 1 : 2);
    CHECK(held.judged[i].before.runs == 4 * logs);
    CHECK(held.judged[i].after.runs == 4 * logs);
  }
  // The other log of each setting that is not among the chosen ones.
  CHECK(held.judged[1].after.prediction.other_real_m == Approx(0.05));
  CHECK(held.judged[4].after.prediction.other_real_m == Approx(0.0).margin(1e-9));
  CHECK(held.judged[1].after.prediction.simulated_m > 0.04);
  // Shown is the middle log of those held out, by how near its runs come: a_2 of two.
  REQUIRE(held.trials.size() == 4);
  CHECK(held.shown == 1);
  CHECK(held.trials[1].source == "a_2.csv");
  CHECK(held.trials[1].level == "a");
  CHECK(held.trials[1].is_held_out);
  CHECK_FALSE(held.trials[2].is_held_out);
  CHECK(held.trials[1].gap_after_m > held.trials[3].gap_after_m);
  CHECK(held.shown_real.poses.front().y_m == Approx(0.05));
  CHECK(held.shown_before.size() == 3);
  CHECK(held.shown_after.size() == 3);

  // Of b one log alone, which is held out.
  Bench few;
  few.experiment.calibrate.method.iterations = 1;
  few.experiment.reference.trials.names = {"1", "3", "2"};
  few.experiment.calibrate.holdout.names = {"2"};
  few.logs["a_3.csv"] = few.logs["a_1.csv"];
  few.logs.erase("b_1.csv");
  Evaluator of_few(few.experiment, "e.yaml", few.AsInputs());
  CHECK(GroupsOf(Identify(of_few, 1, kSilent)) ==
        std::vector<std::string>{"a fitted", "a held out", "a both", "b held out", "b both",
                                 "all fitted", "all held out", "all both"});

  bench.experiment.calibrate.holdout.names.clear();
  bench.experiment.space.parameters[0].levels.resize(1);
  CHECK(GroupsOf(report()) == std::vector<std::string>{"a fitted"});
  bench.experiment.space.parameters.clear();
  bench.experiment.reference.path.text = "a_{trial}.csv";
  CHECK(GroupsOf(report()) == std::vector<std::string>{"all fitted"});
}

TEST_CASE("Runs that predict have seeds that count up from those of their log") {
  const Bench bench;
  BenchTwins beside(bench);
  CHECK(beside.twins.HasWholeRunsOnly());
  CalibrationOptions options = OfWholeRuns({});
  CHECK(options.horizon.most_frames == 1);
  CHECK(options.horizon.phases == 0);
  CHECK(options.step == Approx(0.03));
  options.runs = 3;
  const auto predictions = beside.twins.Predict(Logs(bench, 9.0), {1.5}, options);
  CHECK(bench.Asked() ==
        std::vector<std::string>{"1.5 500", "1.5 501", "1.5 502", "1.5 7", "1.5 8", "1.5 9"});
  REQUIRE(predictions.size() == 2);
  CHECK(predictions[0].runs.size() == 3);
  REQUIRE(predictions[0].motions.size() == 48);
  CHECK(predictions[0].motions[45] == Approx(0.3).margin(1e-4));  // 1.5 of 1.2 at the end
  CHECK(predictions[0].motions[46] == Approx(0.008 - 0.0012).margin(1e-4));  // seeds 7, 8 and 9
  CHECK(predictions[1].motions[46] == Approx(0.001 - 0.0012).margin(1e-4));  // 500, 501 and 502
  CHECK(predictions[0].frames == std::vector<int>(16, 1));
  REQUIRE(predictions[0].mean_traits);
  CHECK((*predictions[0].mean_traits)[kLogSpeed] == Approx(std::log(0.75)).margin(0.02));
}

TEST_CASE("Runs in the place of logs are tried again with other seeds while they are too long") {
  const Bench bench;
  BenchTwins beside(bench);
  const auto asked_for = [](std::uint64_t first, int repeat, int attempt) {
    return fmt::format("1.5 {}", SeedInPlace(first, repeat, attempt));
  };
  for (const int repeat : {0, 2}) {
    CHECK(beside.twins.LogsAt(Logs(bench, 9.0), {1.5}, repeat).size() == 2);
    std::vector<std::string> expected{asked_for(7, repeat, 0), asked_for(500, repeat, 0)};
    std::sort(expected.begin(), expected.end());
    CHECK(bench.Asked() == expected);
  }
  const std::vector<Trajectory> last = beside.twins.LogsAt(Logs(bench, 1.0), {1.5}, 0);
  const std::vector<std::string> asked = bench.Asked();
  CHECK(asked.size() == 20);  // ten tries each
  CHECK(std::count(asked.begin(), asked.end(), asked_for(7, 0, 9)) == 1);
  CHECK(last[0].poses.back().x_m == Approx(1.5));  // the last stands
}

TEST_CASE("A program that gives no path at all where the fit starts, or none for a log, is told") {
  const Bench bench("echo 'no such friction' >&2; exit 1");
  BenchTwins beside(bench);
  CalibrationOptions options = OfWholeRuns({});
  options.runs = 1;
  CHECK_THROWS_WITH(beside.twins.Predict(Logs(bench, 9.0), {1.5}, options),
                    Catch::StartsWith("e.yaml: not one of 2 runs of the program where the fit "
                                      "starts gives a path; the first: ") &&
                        Catch::Contains("no such friction"));
  CHECK_THROWS_WITH(beside.twins.LogsAt(Logs(bench, 9.0), {1.5}, 0),
                    Catch::StartsWith("e.yaml: none of 10 runs of the program in the place of "
                                      "a_1.csv gives a path: ") &&
                        Catch::Contains("no such friction"));
}

TEST_CASE("A path is one of two poses that moves and whose length is a number") {
  Recording run{.trajectory = test::StraightPath(1.0, 2)};
  CHECK(HasPath(run));
  run.trajectory.poses[1].x_m = 0.0;
  CHECK_FALSE(HasPath(run));
  run.trajectory.poses[1].x_m = std::nan("");
  CHECK_FALSE(HasPath(run));
  run.trajectory.poses.resize(1);
  CHECK_FALSE(HasPath(run));
}

}  // namespace
}  // namespace rift::sweep
