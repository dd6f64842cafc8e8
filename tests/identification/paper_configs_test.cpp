#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "identification/trial_grid.hpp"
#include "rift/statistics/descriptive.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

const std::string kConfigs = test::SourceDir() + "/configs/";

/// A file that a sweep of the config leaves.
std::string Swept(const std::string& config, const std::string& file, int seed = 1) {
  const test::QuickGnuplot gnuplot;
  test::TemporaryFolder folder;
  const test::ProcessResult result = test::RunRift(
      {"sweep", kConfigs + config, "--out", folder / "out", "--set", "seed=" + std::to_string(seed),
       "--set", "likeness.classifier.permutations=0"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  return test::ReadFile(folder / ("out/" + file));
}

/// A number of each row of a table by its column's name, NAN where the cell is empty.
std::vector<double> Column(const std::string& table, const std::string& name) {
  std::istringstream lines(table);
  std::vector<double> numbers;
  std::ptrdiff_t column = -1;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    if (column < 0) {
      column = std::find(row.begin(), row.end(), name) - row.begin();
      REQUIRE(column < std::ssize(row));
    } else {
      numbers.push_back(row.at(column).empty() ? NAN : std::stod(row[column]));
    }
  }
  return numbers;
}

std::vector<test::GridPair> Drive(const test::GridStudy& study, int seeds) {
  std::vector<test::GridPair> pairs = test::LoadGrid(study);
  test::Simulate(study, seeds, pairs);
  return pairs;
}

TEST_CASE("The Webots twin follows the authors' Webots logs") {
  RIFT_SKIP_WITHOUT_TRIALS();
  const auto summary = nlohmann::json::parse(Swept("webots_twin.yaml", "summary.json"));
  const nlohmann::json& by = summary["by"]["surface"];
  CHECK(summary["n"] == 18);
  CHECK(by["ground"]["mean_gap_m"].get<double>() < 0.005);
  CHECK(by["cardboard"]["mean_gap_m"].get<double>() < 0.005);
  CHECK(by["parchment"]["mean_gap_m"].get<double>() < 0.015);
}

// The delayed loop is chaotic: which of the runs pass a waypoint and circle, until they meet it or
// the time is up, changes with a tenth of a millimetre at the start, how many does not: 10 % (92 of
// 960).
TEST_CASE("The paper grid on the simulator finishes nearly every trial close to the robot") {
  RIFT_SKIP_WITHOUT_TRIALS();
  int unfinished = 0;
  std::vector<double> gaps_m;
  for (const int seed : {1, 2, 3}) {
    const std::string table = Swept("paper.yaml", "table.csv", seed);
    const std::vector<double> gap_m = Column(table, "gap_m"),
                              length_ratio = Column(table, "length_ratio");
    for (size_t i = 0; i < gap_m.size(); ++i) {
      const bool arrived = length_ratio[i] < 1.3;  // not where it is NAN
      unfinished += !arrived;
      if (arrived) gaps_m.push_back(gap_m[i]);
    }
  }
  CHECK(gaps_m.size() + unfinished == 3 * 48);
  CHECK(unfinished <= 23);  // beyond the mean of 15 in one of a hundred
  CHECK(statistics::Mean(gaps_m) < 0.047);
}

TEST_CASE("The simulated robot drives and answers and weaves like the real one over many seeds") {
  RIFT_SKIP_WITHOUT_TRIALS();
  const test::GridStudy study = test::LoadGridStudy();
  std::vector<test::GridTrial> trials = test::LoadTrialGrid(study, 0);
  std::erase_if(trials, [](const test::GridTrial& trial) { return trial.surface == "bump"; });
  REQUIRE(trials.size() == 48);
  gap::GapOptions gap;
  gap.skip_start = 0.1;
  std::mt19937_64 generator(1);
  const sweep::DriveLikeness found =
      sweep::MeasureDriveLikeness(test::DriveGrid(study, trials, 6), true, gap,
                                  {.shuffles = 99, .longest_run = 1.3}, generator);
  const gap::Likeness& path = found.path;
  INFO("gap " << path.mean_gap_m << " m, mean path " << path.mean_path_gap_m << " m, delay "
              << found.loop_delay_s.sim << " s, missed " << found.failed_runs << ", told apart "
              << found.told_apart.all.accuracy << ", p " << found.told_apart.all.p);
  CHECK(path.mean_gap_m < 1.2 * path.spread_m.real);
  CHECK(path.mean_path_gap_m < path.spread_m.real);
  CHECK(found.loop_delay_s.sim == Approx(found.loop_delay_s.real).margin(0.02));
  CHECK(found.loop_r2.sim == Approx(found.loop_r2.real).margin(0.08));
  CHECK(path.speed_mps.Ratio() == Approx(1.0).margin(0.03));
  CHECK(path.weave_m.Ratio() == Approx(1.0).margin(0.1));
  CHECK(path.spread_m.Ratio() == Approx(1.0).margin(0.17));  // 1.02 to 1.10 by seeds of 20 runs
  // 0.54 to 0.61 by five seeds of 20 runs; six scatter more.
  CHECK(found.told_apart.all.accuracy < 0.67);
  CHECK(found.told_apart.all.accuracy_interval.low < 0.6);
  CHECK(found.failed_runs < 41);  // of 288: beyond the mean of 30 in two of a hundred
}

/// When a log first has this x; by the rows about it.
double TimeAt_s(const trajectory::Trajectory& log, double x_m) {
  const auto beyond =
      std::find_if(log.poses.begin(), log.poses.end(),
                   [&](const trajectory::StampedPose& pose) { return pose.x_m >= x_m; });
  REQUIRE((beyond != log.poses.begin() && beyond != log.poses.end()));
  const trajectory::StampedPose &before = *std::prev(beyond), &after = *beyond;
  return before.t_s + (after.t_s - before.t_s) * (x_m - before.x_m) / (after.x_m - before.x_m);
}

TEST_CASE("Downhill the simulated robot climbs to the edge as slowly and leaves it as fast") {
  RIFT_SKIP_WITHOUT_TRIALS();
  const test::GridStudy study = test::LoadGridStudy();
  std::vector<test::GridTrial> trials = test::LoadTrialGrid(study, 0);
  std::erase_if(trials, [](const test::GridTrial& trial) { return trial.surface != "downhill"; });
  for (const auto& [from_m, to_m] : {std::pair{-0.24, -0.16}, {-0.04, 0.08}}) {
    std::vector<double> real_mps, simulated_mps;
    const auto speed_mps = [from = from_m, to = to_m](const trajectory::Trajectory& log) {
      return (to - from) / (TimeAt_s(log, to) - TimeAt_s(log, from));
    };
    for (const sweep::RepeatedTrial& trial : test::DriveGrid(study, trials, 10)) {
      real_mps.push_back(speed_mps(trial.real));
      for (const auto& run : trial.runs) simulated_mps.push_back(speed_mps(run));
    }
    CAPTURE(from_m, to_m);
    CHECK(statistics::Mean(simulated_mps) == Approx(statistics::Mean(real_mps)).margin(0.025));
  }
}

TEST_CASE("Without the delays of link and listener the robot hardly weaves") {
  RIFT_SKIP_WITHOUT_TRIALS();
  const test::GridSummary all = test::Summarise(
      Drive(test::LoadGridStudy(test::kAuthorsRobot, {"simulation.link={delay_s: 0, poll_s: 0}"}),
            3),
      "");
  CHECK(all.weave_m < 0.55 * all.real_weave_m);
  // The two turns of the host that a pose is old remain.
  CHECK(all.spread_m < 0.6 * all.real_spread_m);
}

}  // namespace
}  // namespace rift
