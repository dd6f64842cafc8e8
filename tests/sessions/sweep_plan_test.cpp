// What is decided about a sweep before its first trial: its space, its engine, its notes.
#include <catch2/catch.hpp>
#include <filesystem>

#include "rift/sessions/sweep/engine.hpp"
#include "rift/sessions/sweep/further_questions.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "rift/sessions/sweep/plan.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/sweep/falsify/verdict.hpp"
#include "sessions/sweep_folder.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

const std::string kLogs =
    "candidate: {kind: logs, path: \"a{trial}.csv\"}\nreference: {kind: logs, path: "
    "\"b{trial}.csv\", "
    "trials: [1, 2]}\n";

std::vector<std::string> NotesOf(const experiment::Experiment& experiment) {
  std::vector<std::string> lines;
  NotePlan(experiment, "task.yaml", [&](const std::string& line) { lines.push_back(line); });
  return lines;
}

TEST_CASE("A simulated sweep without a space is the paper's, and only that") {
  const experiment::Experiment planned = PlanSweep(LoadText(kShortWay));
  REQUIRE(planned.space.parameters.size() == 3);
  CHECK(planned.space.parameters[0].Name() == "surface");
  CHECK(planned.space.parameters[1].Name() == "v_min");
  CHECK(planned.space.parameters[2].Name() == "v_max");
  CHECK(PlanSweep(LoadText(kLogs)).space.parameters.empty());
  CHECK(PlanSweep(SmallGrid()).space.parameters.size() == 1);
  CHECK(NotesOf(LoadText(kShortWay)) ==
        std::vector<std::string>{
            "note: task.yaml names no space: the paper's grid of surface, v_min and v_max"});
  CHECK(NotesOf(LoadText(kLogs)).empty());
  CHECK(NotesOf(SmallGrid()).empty());
}

TEST_CASE("A heading that no controller turns to is noted") {
  const std::vector<std::string> lines = NotesOf(
      LoadText("waypoints: [{x: 0, y: 0, heading: 5}, {x: 0.2, y: 0, heading: 30}]\n" + kLogs));
  REQUIRE(lines.size() == 1);
  CHECK_THAT(lines[0], StartsWith("note: task.yaml: waypoints[1]") && Contains("has heading 30"));
}

TEST_CASE("A simulated robot that stands tilted is warned of, and one of logs is none") {
  const std::vector<std::string> tilted{"simulation.body.caster_below_m=0.005"};
  const std::vector<std::string> lines = NotesOf(SmallGrid(tilted));
  REQUIRE(lines.size() == 1);
  CHECK_THAT(lines[0], StartsWith("warning: the simulated robot stands tilted"));
  CHECK(NotesOf(LoadText(kLogs, tilted)).empty());
}

TEST_CASE("A serial line that takes less than it is sent is noted of a simulated robot alone") {
  const std::vector<std::string> full{"simulation.link.baud=1000", "trial.control_period_s=0.02"};
  const std::vector<std::string> lines = NotesOf(SmallGrid(full));
  REQUIRE(lines.size() == 1);
  CHECK_THAT(lines[0], StartsWith("note: trial.control_period_s, 0.02 s, sends 50 commands"));
  CHECK(NotesOf(LoadText(kLogs, full)).empty());
}

TEST_CASE("Too few repeats to falsify are noted of a search, with the number that it takes") {
  const std::string search =
      kShortWay +
      "goal: falsify\nreference: {kind: path}\nspace: {control.v_min: {min: 0.12, max: 0.2}}\n";
  const experiment::Experiment plan = LoadText(search, {"search.budget=40"});
  const int needed = sweep::TrialsToFalsify(plan.falsify, 40);
  REQUIRE(needed > 2);
  const auto with = [&](int most) {
    return NotesOf(
        LoadText(search, {"search.budget=40", "falsify.most_repeats=" + std::to_string(most)}));
  };
  CHECK(with(needed).empty());
  const std::vector<std::string> lines = with(needed - 1);
  REQUIRE(lines.size() == 1);
  CHECK_THAT(lines[0], Contains("falsify.most_repeats is " + std::to_string(needed - 1)) &&
                           Contains("it takes " + std::to_string(needed) + " failing trials") &&
                           Contains("of 40 settings at 95 % confidence"));
  CHECK(NotesOf(SmallGrid({"falsify.most_repeats=1"})).empty());  // of a grid nothing is said
}

std::optional<sweep::SlurmOptions> Cluster(const EngineRequest& request) {
  return ClusterFor(request, SmallGrid(), "task.yaml");
}

TEST_CASE("Trials are run here unless a cluster is named, and its words need one") {
  CHECK_FALSE(Cluster({}));
  CHECK_THROWS_WITH(Cluster({.partition = "long"}), "--partition is for --engine slurm");
  CHECK_THROWS_WITH(Cluster({.shards = 3}), "--shards is for --engine slurm");
  const auto plain = Cluster({.engine = "slurm"});
  REQUIRE(plain);
  CHECK(plain->partition.empty());
  CHECK(plain->shards == 0);
  CHECK(plain->shard_s == 60.0);
  CHECK(plain->most_shards == 1000);
  CHECK(plain->copy_every_s == 600.0);
  CHECK(plain->poll_s == 10.0);
  const auto said = Cluster({.engine = "slurm", .partition = "long", .shards = 3});
  REQUIRE(said);
  CHECK(said->partition == "long");
  CHECK(said->shards == 3);
}

TEST_CASE("A cluster's habits are those of its file, under what was said beside it") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "own.yaml", "partition: short\naccount: me\nshards: 7\n");
  const auto own = Cluster({.engine = folder / "own.yaml"});
  REQUIRE(own);
  CHECK(own->partition == "short");
  CHECK(own->account == "me");
  CHECK(own->shards == 7);
  const auto said = Cluster({.engine = folder / "own.yaml", .partition = "long", .shards = 2});
  CHECK(said->partition == "long");
  CHECK(said->shards == 2);
  CHECK_THROWS_WITH(Cluster({.engine = "pbs"}),
                    Contains("--engine pbs: must be local, slurm or a file"));
  test::WriteText(folder / "wrong.yaml", "partitions: short\n");
  CHECK_THROWS_WITH(Cluster({.engine = folder / "wrong.yaml"}), Contains("wrong.yaml:1"));
}

TEST_CASE("Logs are compared here, and a program has to be where it is run") {
  const experiment::Experiment logs = LoadText(kLogs);
  CHECK_FALSE(ClusterFor({}, logs, "task.yaml"));
  CHECK_THROWS_WITH(ClusterFor({.engine = "slurm"}, logs, "task.yaml"),
                    Contains("task.yaml: candidate.kind is logs"));
  const experiment::Experiment program = LoadText(
      kShortWay +
      "candidate: {kind: program, run: [no_such_program_anywhere]}\nreference: {kind: path}\n"
      "space: {a: [1, 2]}\n");
  CHECK_THROWS_WITH(ClusterFor({}, program, "task.yaml"), Contains("no_such_program_anywhere"));
  CHECK_NOTHROW(ClusterFor({.engine = "slurm", .shards = 2}, program, "task.yaml"));
}

TEST_CASE(
    "A program of a cluster has to be here where trials or nominal runs are, with the reason") {
  const auto refusal = [](const std::string& sides, const std::vector<std::string>& overrides,
                          std::optional<int> shards) -> std::string {
    const experiment::Experiment program =
        LoadText(kShortWay + sides + "space: {a: [1, 2]}\n", overrides);
    try {
      ClusterFor({.engine = "slurm", .shards = shards}, program, "task.yaml");
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const std::string run =
      "candidate: {kind: program, run: [no_such_program_anywhere]}\nreference: ";
  const std::string missing =
      "task.yaml: candidate.run: there is no program 'no_such_program_anywhere' in PATH: ";
  CHECK_THAT(refusal(run + "{kind: path}\n", {}, {}),
             Catch::StartsWith(missing) && Contains("say --shards N"));
  CHECK(refusal(run + "{kind: path}\n", {}, 2).empty());
  CHECK(refusal(run + "{kind: path}\n", {"goal=falsify"}, {}).empty());
  CHECK_THAT(refusal(run + "{kind: nominal}\n", {"goal=falsify"}, 2),
             Catch::StartsWith(missing) && Contains("the nominal runs come first"));
}

TEST_CASE("Further trials need a simulator, a space, and a row or the worst") {
  const experiment::Experiment grid = SmallGrid();
  CHECK_FALSE(FurtherQuestions{}.Any());
  CHECK(FurtherQuestions{.shrink = "1"}.Any());
  CHECK(FurtherQuestions{.rare_event = true}.Any());
  CHECK_NOTHROW(FurtherQuestions{}.Check(LoadText(kLogs)));
  for (const char* row : {"1", "12", "worst"}) {
    CHECK_NOTHROW(FurtherQuestions{.shrink = row}.Check(grid));
  }
  for (const char* row : {"-1", "1.5", "best", "1 "}) {
    INFO(row);
    CHECK_THROWS_WITH(FurtherQuestions{.shrink = row}.Check(grid),
                      Contains(std::string("--shrink ") + row + ": must be the id of a row"));
  }
  CHECK_NOTHROW(FurtherQuestions{.rare_event = true}.Check(grid));
  CHECK_THROWS_WITH(FurtherQuestions{.shrink = "1"}.Check(LoadText(kLogs)),
                    StartsWith("--shrink drives further trials, and candidate.kind is logs"));
  CHECK_THROWS_WITH(FurtherQuestions{.rare_event = true}.Check(LoadText(kLogs)),
                    StartsWith("--rare-event drives further trials"));
  CHECK_THROWS_WITH(FurtherQuestions{.shrink = "1"}.Check(LoadText(kShortWay)),
                    StartsWith("--shrink needs a space"));
  CHECK_THROWS_WITH(FurtherQuestions{.rare_event = true}.Check(LoadText(kShortWay)),
                    StartsWith("--rare-event needs a space"));
}

TEST_CASE("Trials are kept in a journal unless logs are held against logs or a path") {
  CHECK(IsComputed(SmallGrid()));
  CHECK_FALSE(IsComputed(LoadText(kLogs)));
  const std::string candidates = "candidate: {kind: logs, path: \"a{trial}.csv\"}\n" + kShortWay;
  CHECK_FALSE(IsComputed(LoadText(candidates + "reference: {kind: path, trials: [1, 2]}\n")));
  CHECK(
      IsComputed(LoadText(candidates + "reference: {kind: program, run: [sh], trials: [1, 2]}\n")));
}

TEST_CASE("A journal goes on with other names, processes and limits, and with nothing else") {
  const sweep::Facts facts = FactsOf(SmallGrid());
  for (const char* same : {"name=other", "run.timeout_s=77", "search.budget=7", "search.max_s=5",
                           "falsify.until=budget"}) {
    INFO(same);
    CHECK(FactsOf(SmallGrid({same})) == facts);
  }
  for (const char* other : {"seed=8", "gap.threshold_m=0.02", "control.v_min=0.17",
                            "simulation.motor.mismatch=0.01", "search.strategy=random",
                            "falsify.share=0.2", "falsify.most_repeats=7", "reference.trials=3"}) {
    INFO(other);
    CHECK(FactsOf(SmallGrid({other})) != facts);
  }
  REQUIRE(facts.count("the version of rift") == 1);
  CHECK_THAT(facts.at("the version of rift"),
             Contains(" (" + std::string(sweep::PhysicsVersion()) + ")"));
  CHECK(facts.at("gap.threshold_m") == "0.01");
}

}  // namespace
}  // namespace rift::sessions
