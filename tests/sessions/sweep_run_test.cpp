// How a sweep is run: what it is said to take, when it ends, what it goes on with.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "rift/files/folder_lock.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/further_questions.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "sessions/sweep_folder.hpp"
#include "support/processes/process.hpp"
#include "support/until.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

experiment::Experiment Search(const std::vector<std::string>& overrides = {}) {
  return LoadText(kShortWay +
                      "gap: {threshold_m: 0.01}\nreference: {kind: path, trials: 1}\n"
                      "goal: falsify\nspace: {control.v_min: {min: 0.12, max: 0.2}}\n"
                      "search: {budget: 5}\nfalsify: {until: budget, repeat: none}\n",
                  overrides);
}

TEST_CASE("A grid says its trials and a search its settings, to who watches and in the journal") {
  const test::TemporaryFolder folder;
  SweepTold grid, search;
  REQUIRE(SweepInto(
      folder / "grid",
      LoadText(kShortWay + "reference: {kind: path, trials: 3}\nspace: {surface: [ground, "
                           "parchment], control.v_min: [0.15, 0.2]}\n"),
      grid));
  CHECK(grid.size.most == 12);
  CHECK_FALSE(grid.size.is_settings);
  CHECK(grid.trials == 12);
  REQUIRE(SweepInto(folder / "search", Search(), search));
  CHECK(search.size.most == 5);
  CHECK(search.size.is_settings);
  CHECK(search.trials == 5);
  const auto notes = ReadStatus(folder / "grid").summary.notes;
  CHECK(notes.at("most_trials") == "12");
  CHECK(notes.count("most_settings") == 0);
  CHECK(notes.at("name") == LoadText(kShortWay).name);
  CHECK(std::stod(notes.at("elapsed_s")) > 0.0);
  CHECK(ReadStatus(folder / "search").summary.notes.at("most_settings") == "5");
  CHECK_FALSE(ReadStatus(folder / "grid").shards);
}

TEST_CASE("A grid that is repeated until it is decided says its settings") {
  const test::TemporaryFolder folder;
  SweepTold repeated;
  REQUIRE(SweepInto(
      folder / "grid",
      LoadText(kShortWay + "reference: {kind: path, trials: 3}\nspace: {surface: [ground, "
                           "parchment], control.v_min: [0.15, 0.2]}\n"
                           "falsify: {repeat: every, most_repeats: 5}\n"),
      repeated));
  CHECK(repeated.size.most == 4);
  CHECK(repeated.size.is_settings);
  CHECK(repeated.trials >= 12);
  CHECK(repeated.trials <= 20);
  CHECK(ReadStatus(folder / "grid").summary.notes.at("most_settings") == "4");
}

TEST_CASE("A search without time left tries its first settings and no others") {
  const test::TemporaryFolder folder;
  SweepTold told, more;
  const auto limited = [](const char* max_s) {
    return Search({"search.budget=30", std::string("search.max_s=") + max_s});
  };
  const auto result = SweepInto(folder.Path(), limited("0.000001"), told);
  REQUIRE(result);
  const int first = told.trials;  // those that it asks for at once
  CHECK(first >= 1);
  CHECK(first < 30);
  // The time of the runs before counts: with a little more of it nothing else is tried.
  SweepTold again;
  REQUIRE(SweepInto(folder.Path(), limited("0.000002"), again));
  CHECK(again.from_journal == first);
  CHECK(again.trials == first);
  // What is in the journal is free, whatever the time.
  REQUIRE(SweepInto(folder.Path(), limited("0"), more)->settings.size() == 30);
  SweepTold late;
  CHECK(SweepInto(folder.Path(), limited("0.000001"), late)->settings.size() == 30);
  CHECK(late.from_journal == 30);
}

TEST_CASE("The time that a sweep took before counts against its limit, and is added up") {
  const test::TemporaryFolder folder;
  SweepTold told, again;
  REQUIRE(SweepInto(folder.Path(), Search({"search.max_s=0.000001", "search.budget=30"}), told));
  const int first = told.trials;
  REQUIRE(first < 30);
  const experiment::Experiment more = Search({"search.max_s=5000", "search.budget=30"});
  {
    sweep::Journal journal(folder / kJournalName, FactsOf(more));
    journal.SetNote("elapsed_s", "7000.5");
    journal.Close();
  }
  REQUIRE(SweepInto(folder.Path(), more, again));
  CHECK(again.trials == first);
  const double elapsed_s = std::stod(ReadStatus(folder.Path()).summary.notes.at("elapsed_s"));
  CHECK(elapsed_s >= 7000.5);
}

TEST_CASE("A sweep goes on with its journal unless it is to be fresh, and ticks meanwhile") {
  const test::TemporaryFolder folder;
  const experiment::Experiment grid = SmallGrid();
  SweepTold first, second, fresh;
  REQUIRE(SweepInto(folder.Path(), grid, first));
  CHECK(first.from_journal == 0);
  REQUIRE(SweepInto(folder.Path(), grid, second));
  CHECK(second.from_journal == 4);
  sweep::Evaluator evaluator(grid, "sweep.yaml", FileInputs());
  int ticks = 0;
  SweepRunRequest request{.out = folder.Path(), .fresh = true};
  request.tick = [&ticks](sweep::Journal& journal) {
    ++ticks;
    CHECK(journal.Note("state") == "running");
  };
  REQUIRE(RunSweep(evaluator, request, ObserverOf(fresh)));
  CHECK(fresh.from_journal == 0);
  CHECK(fresh.trials == 4);
  CHECK(ticks > 0);
  CHECK(fresh.ticks > 0);
}

TEST_CASE("Another version of the experiment has no part in a journal, with the key that differs") {
  const test::TemporaryFolder folder;
  SweepTold told;
  REQUIRE(SweepInto(folder.Path(), SmallGrid(), told));
  CHECK_THROWS_WITH(SweepInto(folder.Path(), SmallGrid({"seed=3"}), told), Contains("seed"));
  CHECK_NOTHROW(SweepInto(folder.Path(), SmallGrid({"name=other"}), told));
  CHECK(files::ReadFile(folder / "experiment.yaml").find("other") != std::string::npos);
}

TEST_CASE("A damaged row is said with its file and run again") {
  const test::TemporaryFolder folder;
  SweepTold told, again;
  const auto before = SweepInto(folder.Path(), SmallGrid(), told);
  REQUIRE(before);
  CHECK_THAT(told.Text(), !Contains("damaged"));
  const std::string file = folder / kJournalName;
  std::string bytes = files::ReadFile(file);
  // In one row's findings, the name of its reference.
  const size_t at = bytes.find("waypoint path");
  REQUIRE(at != bytes.npos);
  bytes[at] = 'W';
  CHECK(ReadStatus(folder.Path()).state == "done");
  test::WriteText(file, bytes);
  const SweepStatus status = ReadStatus(folder.Path());
  CHECK(status.state == "stopped");  // a trial is to be run again
  CHECK(status.summary.damaged > 0);
  const auto after = SweepInto(folder.Path(), SmallGrid(), again);
  REQUIRE(after);
  CHECK_THAT(again.Text(), Contains("note: " + file + ": ") &&
                               Contains("of its entries were damaged and are left out"));
  CHECK(again.from_journal < 4);
  CHECK(report::TableCsv(*after) == report::TableCsv(*before));
}

TEST_CASE(
    "Logs are compared in this process: no journal, each row told once, and it can be stopped") {
  const test::TemporaryFolder folder;
  for (const char* name : {"a1.csv", "a2.csv", "b1.csv", "b2.csv"}) {
    test::WriteText(folder / name, "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,0.5,0.01,0\n2,1,0,0\n");
  }
  const experiment::Experiment logs =
      LoadText("candidate: {kind: logs, path: \"" + (folder / "a{trial}.csv") +
               "\"}\nreference: {kind: logs, path: \"" + (folder / "b{trial}.csv") +
               "\", trials: [1, 2]}\n");
  SweepTold told, stopped{.stops_after = 0};
  const auto result = SweepInto(folder / "out", logs, told);
  REQUIRE(result);
  CHECK(told.size.most == 2);
  CHECK(told.trials == 2);
  CHECK(told.from_journal == 0);
  CHECK(told.ends == std::vector<std::string>{"done"});
  CHECK_FALSE(fs::exists(folder / "out/journal.sqlite"));
  // The same path on both sides is doubted at the end.
  CHECK_THAT(told.Text(), Contains("are the same log"));
  CHECK_FALSE(SweepInto(folder / "out", logs, stopped));
  CHECK(stopped.ends == std::vector<std::string>{"stopped"});
  CHECK(stopped.lines.empty());
}

TEST_CASE("The state of a folder is what its journal notes, and running while it is held") {
  const test::TemporaryFolder folder;
  CHECK_THROWS_AS(ReadStatus(folder.Path()), std::invalid_argument);
  SweepTold told;
  REQUIRE(SweepInto(folder.Path(), SmallGrid(), told));
  CHECK(ReadStatus(folder.Path()).state == "done");
  CHECK(ReadStatus(folder.Path()).summary.trials_by_status.at("ok") == 4);
  {
    sweep::Journal journal(folder / kJournalName, FactsOf(SmallGrid()));
    journal.SetNote("state", "running");  // as one that was killed leaves it
    journal.Close();
  }
  CHECK(ReadStatus(folder.Path()).state == "stopped");
  const files::FolderLock lock(folder.Path());
  CHECK(ReadStatus(folder.Path()).state == "running");
}

TEST_CASE("A rare event announces the most trials it may take and can be stopped") {
  const test::TemporaryFolder folder;
  SweepTold told, stopped{.stops_after = 20};
  const experiment::Experiment search = Search();
  sweep::Evaluator evaluator(search, "sweep.yaml", FileInputs());
  const auto result = RunSweep(evaluator, {.out = folder.Path()}, ObserverOf(told));
  REQUIRE(result);
  CHECK_FALSE(
      Answer({.rare_event = true}, folder.Path(), *result, evaluator, {}, ObserverOf(stopped)));
  CHECK(stopped.size.most == 8 * 300 * 10);  // replicas x samples x levels
  CHECK_FALSE(stopped.size.is_settings);
  CHECK_FALSE(fs::exists(folder / "rare_event.json"));
  // Its trials are kept apart from those of the table, and the next call goes on with them.
  CHECK(ReadStatus(folder.Path()).summary.trials_by_status.at("ok") == 5);
  SweepTold more{.stops_after = stopped.trials + 1};
  CHECK_FALSE(
      Answer({.rare_event = true}, folder.Path(), *result, evaluator, {}, ObserverOf(more)));
  CHECK(more.from_journal >= 20);
}

TEST_CASE("A shrunk row is saved with the trials its claims rest on, as a folder to replay") {
  const test::TemporaryFolder folder;
  SweepTold told;
  const experiment::Experiment grid =
      LoadText(kShortWay +
               "gap: {threshold_m: 0.004}\nreference: {kind: path, trials: 1}\n"
               "space: {mismatch: [0, 0.2], control.v_min: [0.15, 0.16]}\n");
  sweep::Evaluator evaluator(grid, "sweep.yaml", FileInputs());
  const auto result = RunSweep(evaluator, {.out = folder.Path()}, ObserverOf(told));
  REQUIRE(result);
  REQUIRE(result->rows.back().falsified);
  const auto answers =
      Answer({.shrink = "4"}, folder.Path(), *result, evaluator, {.jobs = 2}, ObserverOf(told));
  REQUIRE(answers);
  CHECK(answers->shrunk->id == 4);
  CHECK_FALSE(answers->rare_event);
  const fs::path shrunk = folder.Path() / "shrunk";
  CHECK(files::ReadFile(shrunk / "experiment.yaml") == experiment::WriteExperiment(grid));
  sweep::SweepResult rows = *result;
  rows.rows = answers->shrunk->rows;
  CHECK(files::ReadFile(shrunk / "table.csv") == report::TableCsv(rows));
  CHECK_THAT(files::ReadFile(folder / "shrunk.json"), Contains(shrunk.string()));
  CHECK(ReadStatus(folder.Path()).state == "done");
}

}  // namespace
}  // namespace rift::sessions
