// Two folders of sweeps held against each other.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "rift/sessions/sweep/compare.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "sessions/sweep_folder.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

/// Four rows of the small grid with these gaps in m; below zero: a trial that timed out.
void SaveRows(const fs::path& folder, const std::vector<double>& gaps_m,
              const std::vector<std::string>& overrides = {}) {
  const experiment::Experiment experiment = SmallGrid(overrides);
  sweep::SweepResult result = sweep::EmptyResult(experiment);
  size_t i = 0;
  for (const std::string surface : {"ground", "parchment"}) {
    for (const std::string trial : {"1", "2"}) {
      sweep::TrialRow row{.theta = {{surface, {}}}, .trial = trial, .seed = 1 + i % 2};
      row.candidate = "simulation";
      row.reference = "path";
      const double gap_m = gaps_m.at(i++);
      row.falsified = gap_m < 0.0 || gap_m > experiment.gap.threshold_m;
      if (gap_m < 0.0) {
        row.status = sweep::TrialStatus::kTimedOut;
        row.reason = "not in time";
      } else {
        row.comparison.gap_m = gap_m;
      }
      row.falsified = row.falsified && gap_m != -2.0;  // one that tells nothing
      result.rows.push_back(row);
    }
  }
  sweep::Summarise(result);
  fs::create_directories(folder);
  sweep::Evaluator evaluator(experiment, "sweep.yaml", FileInputs());
  SaveResult(folder, evaluator, result);
}

TEST_CASE("Gaps, failures and verdicts of both folders stand side by side, the first before") {
  const test::TemporaryFolder folder;
  SaveRows(folder / "a", {0.004, 0.006, 0.020, 0.030});
  SaveRows(folder / "b", {0.003, 0.007, 0.008, 0.012});
  const sweep::SweepChange change = CompareFolders(folder / "a", folder / "b");
  CHECK(change.before == folder / "a");
  CHECK(change.after == folder / "b");
  CHECK(change.keys.empty());
  CHECK(change.now_hold == 1);
  CHECK(change.now_fail == 0);
  REQUIRE(change.settings.size() == 2);
  const sweep::SettingChange& parchment = change.settings[0];
  CHECK(parchment.setting == "surface parchment");
  CHECK(parchment.before.failures == 2);
  CHECK(parchment.after.failures == 1);
  CHECK(parchment.before.told == 2);
  CHECK(parchment.before.mean_gap_m == Approx(0.025));
  CHECK(parchment.after.mean_gap_m == Approx(0.010));
  CHECK(parchment.gap_change_m == Approx(-0.015));
  CHECK(parchment.pairs == 2);
  const auto summary = nlohmann::json::parse(files::ReadFile(folder / "a/summary.json"));
  CHECK(change.settings[1].before.verdict == summary["settings"][0]["verdict"]);
  CHECK(parchment.before.verdict == summary["settings"][1]["verdict"]);
  CHECK_FALSE(parchment.before.verdict.empty());
  CHECK(parchment.before.verdict != change.settings[1].before.verdict);
}

TEST_CASE("Settings of two folders that are copies of one another change sides once") {
  const test::TemporaryFolder folder;
  SaveRows(folder / "a", {0.020, 0.030, 0.020, 0.030});
  SaveRows(folder / "b", {0.008, 0.009, 0.008, 0.009});
  const sweep::SweepChange change = CompareFolders(folder / "a", folder / "b");
  CHECK(change.now_hold == 2);
  CHECK(change.copies == 2);
  CHECK(change.all.before.failures == 4);
  CHECK(change.all.pairs == 4);
}

TEST_CASE("A failure without a gap is told and one without an end that counts is not") {
  const test::TemporaryFolder folder;
  SaveRows(folder / "a", {0.004, 0.006, -1.0, 0.030});
  SaveRows(folder / "b", {0.003, 0.007, -2.0, 0.012});
  const sweep::SweepChange change = CompareFolders(folder / "a", folder / "b");
  REQUIRE(change.settings.size() == 2);
  const sweep::SettingChange& parchment = change.settings[1];  // the share did not change
  CHECK(parchment.setting == "surface parchment");
  CHECK(parchment.before.told == 2);
  CHECK(parchment.before.failures == 2);
  CHECK(parchment.before.mean_gap_m == Approx(0.030));
  CHECK(parchment.after.told == 1);
  CHECK(parchment.after.failures == 1);
  CHECK(parchment.pairs == 1);
}

TEST_CASE("Keys that may differ are listed with both values, those that say nothing are left out") {
  const test::TemporaryFolder folder;
  const std::vector<double> gaps_m{0.004, 0.006, 0.020, 0.030};
  SaveRows(folder / "a", gaps_m);
  SaveRows(
      folder / "b", gaps_m,
      {"control.w_max=0.9", "name=other", "run.timeout_s=50", "search.budget=9", "twin.fps=20"});
  const sweep::SweepChange change = CompareFolders(folder / "a", folder / "b");
  REQUIRE(change.keys.size() == 1);
  CHECK(change.keys[0].key == "control.w_max");
  CHECK(change.keys[0].after == "0.9");
  CHECK(change.keys[0].before != "0.9");
  const sweep::SweepChange back = CompareFolders(folder / "b", folder / "a");
  REQUIRE(back.keys.size() == 1);
  CHECK(back.keys[0].before == "0.9");
  CHECK(back.keys[0].after == change.keys[0].before);
}

TEST_CASE("A key that makes rows incomparable is refused with its two values in their order") {
  const test::TemporaryFolder folder;
  const std::vector<double> gaps_m{0.004, 0.006, 0.020, 0.030};
  SaveRows(folder / "a", gaps_m);
  struct Other {
    std::string setting, key;
  };
  const Other other =
      GENERATE(values<Other>({{"gap.samples=500", "gap.samples is 2000"},
                              {"reference.kind=nominal", "reference.kind is path"},
                              {"program.power=0.5", "program.power is 0.25"},
                              {"objective=odometry", "objective is gap"},
                              {"falsify.count.fell=false", "falsify.count.fell is true"}}));
  SaveRows(folder / "b", gaps_m, {other.setting});
  INFO(other.setting);
  CHECK_THROWS_WITH(
      CompareFolders(folder / "a", folder / "b"),
      Contains((folder / "a") + " and " + (folder / "b") + " hold different experiments: ") &&
          Contains(other.key));
}

TEST_CASE("Sweeps of another way or another space are not compared") {
  const test::TemporaryFolder folder;
  const std::vector<double> gaps_m{0.004, 0.006, 0.020, 0.030};
  SaveRows(folder / "a", gaps_m);
  struct Change {
    std::string from, to, key;
  };
  const Change change = GENERATE(values<Change>(
      {{"0.25", "0.26", "waypoints"}, {"parchment", "parchment, cardboard", "space"}}));
  SaveRows(folder / "b", gaps_m);
  std::string saved = files::ReadFile(folder / "b/experiment.yaml");
  const size_t at = saved.find(change.from);
  REQUIRE(at != saved.npos);
  saved.replace(at, change.from.size(), change.to);
  test::WriteText(folder / "b/experiment.yaml", saved);
  CHECK_THROWS_WITH(CompareFolders(folder / "a", folder / "b"),
                    Contains("hold different experiments: " + change.key));
}

TEST_CASE("A folder without one of the three files is no finished sweep, and the file is named") {
  const std::vector<double> gaps_m{0.004, 0.006, 0.020, 0.030};
  for (const char* name : {"experiment.yaml", "table.csv", "summary.json"}) {
    const test::TemporaryFolder folder;
    SaveRows(folder / "a", gaps_m);
    SaveRows(folder / "b", gaps_m);
    fs::remove(folder.Path() / "b" / name);
    INFO(name);
    CHECK_THROWS_WITH(CompareFolders(folder / "a", folder / "b"),
                      "--compare " + (folder / "b") +
                          ": it is not the folder of a finished sweep: there is no " + name);
    CHECK_THROWS_WITH(CompareFolders(folder / "b", folder / "a"), Contains(folder / "b"));
  }
}

TEST_CASE("A table that does not go with the space and the summary beside it is refused") {
  const test::TemporaryFolder folder;
  SaveRows(folder / "a", {0.004, 0.006, 0.020, 0.030});
  struct Damage {
    std::string file, from, to, says;
  };
  const auto whole = [&](const char* name) { return files::ReadFile(folder / "a/" + name); };
  const std::string table = whole("table.csv");
  const size_t last = table.rfind('\n', table.size() - 2) + 1;
  const Damage damage = GENERATE_REF(values<Damage>(
      {{"table.csv", table.substr(last), "", "b/table.csv has 3 rows, and summary.json tells of 4"},
       {"table.csv", "\nparchment", "\npaper", "b/table.csv has the surface 'paper'"},
       {"summary.json", "\"parchment\"", "\"paper\"", "summary.json no verdict on it"},
       {"summary.json", "\"verdict\": \"", "\"verdict\": \"X\\n", "b/summary.json: it is damaged"},
       {"summary.json", "\"not_ok\": 0", "\"not_ok\": 1", "tells of 5"}}));
  INFO(damage.says);
  SaveRows(folder / "b", {0.004, 0.006, 0.020, 0.030});
  std::string text = whole(damage.file.c_str());
  const size_t at = damage.file == "summary.json" && damage.from == "\"parchment\""
                        ? text.rfind(damage.from)
                        : text.find(damage.from);
  REQUIRE(at != text.npos);
  test::WriteText(folder / ("b/" + damage.file), text.replace(at, damage.from.size(), damage.to));
  CHECK_THROWS_WITH(CompareFolders(folder / "a", folder / "b"),
                    Contains(damage.says) && Contains("give the command of the sweep again"));
}

TEST_CASE("A damaged table or summary is named by its path") {
  const test::TemporaryFolder folder;
  SaveRows(folder / "a", {0.004, 0.006, 0.020, 0.030});
  SaveRows(folder / "b", {0.004, 0.006, 0.020, 0.030});
  test::WriteText(folder / "b/summary.json", "{\"settings\": [{}]}");
  CHECK_THROWS_WITH(CompareFolders(folder / "a", folder / "b"),
                    Contains((folder / "b/summary.json") + ": it is damaged"));
  SaveRows(folder / "b", {0.004, 0.006, 0.020, 0.030});
  test::WriteText(folder / "b/table.csv", "surface,trial\nground");
  CHECK_THROWS_WITH(CompareFolders(folder / "a", folder / "b"), Contains(folder / "b/table.csv"));
}

}  // namespace
}  // namespace rift::sessions
