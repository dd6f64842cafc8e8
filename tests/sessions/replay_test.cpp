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

}  // namespace
}  // namespace rift::sessions
