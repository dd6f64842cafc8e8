// A sweep in its folder, driven by somebody who is no terminal.
#include <catch2/catch.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "rift/sessions/sweep/further_questions.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "rift/sessions/sweep/run.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

/// What a sweep told, and when it is asked to end.
struct Told {
  int most = 0;
  int trials = 0;
  int from_journal = 0;
  std::vector<std::string> ends{};
  int stops_after = 1'000'000;  ///< trials
};

class Counter final : public TrialProgress {
 public:
  explicit Counter(Told& told) : told_(told) {}

  void Seen(const sweep::TrialRow&, bool from_journal) override {
    ++told_.trials;
    told_.from_journal += from_journal;
  }
  void Warn(const std::string&) override {}
  void Tick() override {}
  void Tick(const sweep::ReferenceProgress&) override {}
  void End(const std::string& state) override { told_.ends.push_back(state); }

 private:
  Told& told_;
};

SweepObserver ObserverOf(Told& told) {
  return {.say = [](const std::string&) {},
          .begin =
              [&told](const SweepSize& size) {
                told.most = size.most;
                return std::make_unique<Counter>(told);
              },
          .shards = [](const sweep::ShardCounts&) {},
          .watch_for_stop = [&told] { return [&told] { return told.trials < told.stops_after; }; }};
}

experiment::Experiment Grid(const std::vector<std::string>& overrides = {}) {
  return experiment::LoadExperiment("grid.yaml", overrides, [](const std::string&) {
    return std::string(
        "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]\n"
        "gap: {threshold_m: 0.01}\nreference: {kind: path, trials: 10}\n"
        "space: {surface: [ground, parchment]}\n");
  });
}

/// The table of a sweep in a folder.
std::optional<std::string> Run(const experiment::Experiment& experiment, const std::string& out,
                               Told& told) {
  std::filesystem::create_directories(out);
  sweep::Evaluator evaluator(experiment, "grid.yaml",
                             {[](const std::string& path) { return files::ReadIfThere(path); },
                              [](const std::string&) {}});
  const auto result = RunSweep(evaluator, {.out = out}, ObserverOf(told));
  if (!result) return std::nullopt;
  SaveResult(out, evaluator, *result);
  return report::TableCsv(*result);
}

TEST_CASE("A sweep tells its observer every trial and how it ended") {
  const test::TemporaryFolder folder;
  Told told;
  const auto table = Run(Grid(), folder / "out", told);
  REQUIRE(table);
  CHECK(told.most == 20);
  CHECK(told.trials == 20);
  CHECK(told.from_journal == 0);
  CHECK(told.ends == std::vector<std::string>{"done"});
  CHECK(ReadStatus(folder / "out").state == "done");
  CHECK(files::ReadFile(folder / "out/table.csv") == *table);
}

TEST_CASE("A sweep that its observer stops goes on from its journal and ends the same") {
  const test::TemporaryFolder folder;
  Told whole, stopped{.stops_after = 3}, rest;
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
  const experiment::Experiment search = experiment::LoadExperiment(
      "search.yaml", {"search.max_s=1e-9", "search.batch=3", "falsify.until=budget"},
      [](const std::string&) {
        return std::string(
            "waypoints: [{x: 0, y: 0, heading: 0}, {x: 0.25, y: 0.02, stop: true}]\n"
            "goal: falsify\nreference: {kind: path, trials: 1}\n"
            "search: {strategy: random, budget: 100}\n"
            "space: {control.v_min: {min: 0.1, max: 0.2}}\n");
      });
  sweep::Evaluator evaluator(search, "search.yaml",
                             {[](const std::string& path) { return files::ReadIfThere(path); },
                              [](const std::string&) {}});
  Told told;
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
  Told told, stopped{.stops_after = 0};
  const experiment::Experiment grid = Grid({"gap.threshold_m=0.0001"});
  sweep::Evaluator evaluator(grid, "grid.yaml",
                             {[](const std::string& path) { return files::ReadIfThere(path); },
                              [](const std::string&) {}});
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
