// A sweep in its folder, driven by somebody who is no terminal.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/further_questions.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "sessions/sweep_folder.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

experiment::Experiment Grid(const std::vector<std::string>& overrides = {}) {
  return LoadText(kShortWay +
                      "gap: {threshold_m: 0.01}\nreference: {kind: path, trials: 10}\n"
                      "space: {surface: [ground, parchment]}\n",
                  overrides);
}

/// The table of a sweep in a folder.
std::optional<std::string> Run(const experiment::Experiment& experiment, const std::string& out,
                               SweepTold& told) {
  const auto result = SweepInto(out, experiment, told);
  if (!result) return std::nullopt;
  return report::TableCsv(*result);
}

TEST_CASE("A sweep tells its observer every trial and how it ended, and removes a live page") {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "out");
  test::WriteText(folder / "out/live.html", "left by one that was killed: Running");
  SweepTold told;
  const auto table = Run(Grid(), folder / "out", told);
  REQUIRE(table);
  CHECK_FALSE(std::filesystem::exists(folder / "out/live.html"));
  CHECK(told.size.most == 20);
  CHECK(told.trials == 20);
  CHECK(told.from_journal == 0);
  CHECK(told.ends == std::vector<std::string>{"done"});
  CHECK(ReadStatus(folder / "out").state == "done");
  CHECK(files::ReadFile(folder / "out/table.csv") == *table);
}

TEST_CASE("A sweep that its observer stops goes on from its journal and ends the same") {
  const test::TemporaryFolder folder;
  SweepTold whole, stopped{.stops_after = 3}, rest;
  const auto table = Run(Grid(), folder / "whole", whole);
  CHECK_FALSE(Run(Grid(), folder / "out", stopped));
  CHECK(stopped.ends == std::vector<std::string>{"stopped"});
  CHECK(stopped.trials < 20);
  CHECK(ReadStatus(folder / "out").state == "stopped");
  CHECK_FALSE(std::filesystem::exists(folder / "out/table.csv"));
  CHECK(Run(Grid(), folder / "out", rest) == table);
  CHECK(rest.from_journal >= 3);
  CHECK(rest.from_journal == stopped.trials);
}

TEST_CASE("A search whose time has passed before its first trial tries its first settings") {
  const test::TemporaryFolder folder;
  const experiment::Experiment search =
      LoadText(kShortWay +
                   "goal: falsify\nreference: {kind: path, trials: 1}\n"
                   "search: {strategy: random, budget: 100}\n"
                   "space: {control.v_min: {min: 0.1, max: 0.2}}\n",
               {"search.max_s=1e-9", "search.batch=3", "falsify.until=budget"});
  sweep::Evaluator evaluator(search, "search.yaml", FileInputs());
  SweepTold told;
  const auto result = RunSweep(evaluator, {.out = folder.Path()}, ObserverOf(told));
  REQUIRE(result);
  CHECK(result->rows.size() == 3);
  CHECK(told.trials == 3);
  REQUIRE(result->falsification);
  CHECK(result->falsification->evaluations == 3);
  CHECK(result->falsification->ended == "the time");
  CHECK(result->falsification->worst_setting);
  CHECK(told.ends == std::vector<std::string>{"done"});
}

TEST_CASE("A folder holds another experiment where no journal says so by itself") {
  const test::TemporaryFolder folder;
  const experiment::Experiment grid = Grid(), other = Grid({"gap.threshold_m=0.02"});
  CHECK_FALSE(HoldsOtherExperiment(folder.Path(), grid));
  files::WriteFile(folder.Path() / "experiment.yaml", experiment::WriteExperiment(grid));
  CHECK_FALSE(HoldsOtherExperiment(folder.Path(), grid));
  CHECK(HoldsOtherExperiment(folder.Path(), other));
  files::WriteFile(folder.Path() / kJournalName, "");
  CHECK_FALSE(HoldsOtherExperiment(folder.Path(), other));
}

TEST_CASE("Questions that cost trials are answered into the folder, and not at all when stopped") {
  const test::TemporaryFolder folder;
  SweepTold told, stopped{.stops_after = 0};
  const experiment::Experiment grid = Grid({"gap.threshold_m=0.0001"});
  sweep::Evaluator evaluator(grid, "grid.yaml", FileInputs());
  const auto result = RunSweep(evaluator, {.out = folder.Path()}, ObserverOf(told));
  REQUIRE(result);
  CHECK_FALSE(Answer({}, folder.Path(), *result, evaluator, {}, ObserverOf(told))->shrunk);
  const FurtherQuestions questions{.shrink = "worst"};
  CHECK_FALSE(Answer(questions, folder.Path(), *result, evaluator, {}, ObserverOf(stopped)));
  CHECK_FALSE(std::filesystem::exists(folder / "shrunk.json"));
  const auto answers = Answer(questions, folder.Path(), *result, evaluator, {}, ObserverOf(told));
  REQUIRE(answers);
  REQUIRE(answers->shrunk);
  CHECK(answers->shrunk->shrunk.changed.empty());  // nothing has to be changed for so small a gap
  CHECK(std::filesystem::exists(folder / "shrunk/table.csv"));
  CHECK_THROWS_WITH(
      Answer({.shrink = "99"}, folder.Path(), *result, evaluator, {}, ObserverOf(told)),
      Catch::Matchers::Contains("rows 1 to 20"));
}

}  // namespace
}  // namespace rift::sessions
