// A row of a sweep's table made again from its folder.
#include <catch2/catch.hpp>
#include <filesystem>

#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/replay.hpp"
#include "sessions/sweep_folder.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

TEST_CASE("Each row of a simulated sweep comes out again with its setting, seed and gap") {
  const test::TemporaryFolder folder;
  SweepTold told;
  const auto result = SweepInto(folder.Path(), SmallGrid({"seed=11"}), told);
  REQUIRE(result);
  REQUIRE(result->rows.size() == 4);
  for (size_t i = 0; i < 4; ++i) {
    const std::string id = std::to_string(i + 1);
    const Replay replay = ReplayRow(folder.Path(), id, FileInputs());
    INFO("row " << id);
    CHECK(replay.experiment.simulation.terrain.surface == result->rows[i].theta[0].text);
    CHECK(replay.experiment.seed == *result->rows[i].seed);
    CHECK(replay.experiment.seed == 11 + i % 2);
    CHECK(replay.trial.seed == 11 + i % 2);
    CHECK(replay.run.result.trajectory.poses.size() > 10);
    const report::TableRow row =
        report::TableRowOf(files::ReadFile(folder / "table.csv"), id, "table.csv");
    CHECK(replay.verdict == "row " + id + ": status ok, gap " + row.at("gap_m") +
                                " m, to the last bit as in the table");
    // The run is that of the row: the same gap as the library gives for it.
    const auto again = gap::Compare(replay.run.result.trajectory,
                                    sweep::IdealPath(replay.trial.task), result->gap);
    CHECK(again.gap_m == Approx(result->rows[i].comparison.gap_m).margin(1e-12));
  }
  CHECK_THROWS_WITH(ReplayRow(folder.Path(), "5", FileInputs()), Contains("table.csv"));
  CHECK_FALSE(ReplayProgramRow(folder.Path(), "1", FileInputs()));
}

TEST_CASE("A row that was changed in the table does not come out, and both gaps are told") {
  const test::TemporaryFolder folder;
  SweepTold told;
  const auto result = SweepInto(folder.Path(), SmallGrid(), told);
  REQUIRE(result);
  const std::string table = files::ReadFile(folder / "table.csv");
  const std::string gap = report::TableRows(table)[2].at("gap_m");
  std::string changed = table;
  changed.replace(changed.find(gap), gap.size(), "0.5");
  test::WriteText(folder / "table.csv", changed);
  CHECK_THROWS_WITH(ReplayRow(folder.Path(), "3", FileInputs()),
                    Contains("row 3 comes out different (gap " + gap + " m, not gap 0.5 m)"));
  CHECK_NOTHROW(ReplayRow(folder.Path(), "1", FileInputs()));
}

TEST_CASE("A row without a gap is replayed as one") {
  const test::TemporaryFolder folder;
  SweepTold told;
  REQUIRE(SweepInto(folder.Path(), SmallGrid({"trial.timeout_s=0.5"}), told));
  const Replay replay = ReplayRow(folder.Path(), "1", FileInputs());
  CHECK(replay.verdict == "row 1: status timed_out, no gap, to the last bit as in the table");
  CHECK(replay.run.result.outcome == trial::Outcome::kTimedOut);
}

TEST_CASE("A row of recorded logs has nothing to be made again from") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a.csv", "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,0.5,0,0\n2,1,0,0\n");
  test::WriteText(folder / "b.csv", "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,0.5,0.1,0\n2,1,0,0\n");
  const experiment::Experiment logs =
      LoadText("candidate: {kind: logs, path: " + (folder / "a.csv") +
               "}\nreference: {kind: logs, path: " + (folder / "b.csv") + "}\n");
  SweepTold told;
  REQUIRE(SweepInto(folder / "out", logs, told));
  CHECK(told.size.most == 1);
  CHECK(told.trials == 1);
  CHECK_FALSE(fs::exists(folder / "out/journal.sqlite"));
  CHECK_THROWS_WITH(ReplayRow(folder / "out", "1", FileInputs()),
                    (folder / "out/experiment.yaml") +
                        ": candidate.kind is logs: there is nothing to simulate again");
}

/// Programs of others: a way ahead in 101 rows, `bend` aside at its end; beyond 0.4 it did not
/// arrive.
constexpr const char* kProgram = R"(#!/bin/sh
awk -v bend="$1" -v by="$3" 'BEGIN {
  print "t_s,x_m,y_m,yaw_rad"
  for (i = 0; i <= 100; ++i) print 0.05 * i "," 0.01 * i "," by * i * i / 1e4 + bend * i / 100 ",0"
}' > "$2"
[ "${1#0.5}" = "$1" ] || exit 10
)";

TEST_CASE("A row of somebody else's program is run again and held against the table") {
  const test::TemporaryFolder folder;
  const std::string program = folder / "sim.sh";
  test::WriteText(program, kProgram);
  fs::permissions(program, fs::perms::owner_all);
  const experiment::Experiment experiment =
      LoadText("candidate: {kind: program, run: [" + program + ", \"{bend}\", \"{out}\", 0.01]}\n" +
               "reference: {kind: nominal}\nspace: {bend: [0, 0.03, 0.5]}\n");
  SweepTold told;
  const auto result = SweepInto(folder / "out", experiment, told);
  REQUIRE(result);
  REQUIRE(result->rows.size() == 3);
  INFO(result->rows[1].reason);
  CHECK(result->rows[1].comparison.gap_m == Approx(0.03).margin(1e-3));
  const auto replay = ReplayProgramRow(folder / "out", "2", FileInputs());
  REQUIRE(replay);
  CHECK(replay->has_arrived);
  REQUIRE(replay->trajectory.poses.size() == 101);
  CHECK(replay->trajectory.poses.back().y_m == Approx(0.04));
  CHECK_THAT(replay->verdict, Catch::StartsWith("row 2: status ok, gap 0.0"));
  CHECK(replay->experiment.name == experiment.name);
  const auto failed = ReplayProgramRow(folder / "out", "3", FileInputs());
  REQUIRE(failed);
  CHECK_FALSE(failed->has_arrived);
  CHECK_THAT(failed->verdict, Contains("status timed_out, no gap"));
  std::string changed = kProgram;
  changed.replace(changed.find("bend * i"), 8, "2 * bend * i");
  test::WriteText(program, changed);
  CHECK_THROWS_WITH(ReplayProgramRow(folder / "out", "2", FileInputs()),
                    Contains("row 2 comes out different"));
}

}  // namespace
}  // namespace rift::sessions
