// A sweep on a cluster whose commands do nothing: the shards are computed by this test while the
// sweep waits for them.
#include <catch2/catch.hpp>
#include <filesystem>

#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/further_questions.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "sessions/idle_slurm.hpp"
#include "sessions/sweep_folder.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;

struct OnCluster {
  explicit OnCluster(const experiment::Experiment& swept) : experiment(swept), nodes{out, swept} {
    options.poll_s = 0.05;
    options.max_array_size = 100;
    fs::create_directories(out);
  }
  SweepObserver Observer() {
    SweepObserver observer = ObserverOf(told);
    // Asked also while a command of Slurm runs: the nodes begin when their shards are told.
    observer.watch_for_stop = [this] {
      return [this] { return counts.empty() || nodes.Compute(); };
    };
    observer.shards = [this](const sweep::ShardCounts& seen) { counts.push_back(seen); };
    return observer;
  }
  std::string Table() {
    sweep::Evaluator evaluator(experiment, "sweep.yaml", FileInputs());
    const auto result = RunSweep(evaluator, {.out = out, .cluster = &options}, Observer());
    REQUIRE(result);
    SaveResult(out, evaluator, *result);
    return report::TableCsv(*result);
  }

  IdleSlurm slurm;
  test::TemporaryFolder folder;
  fs::path out = folder / "cluster";
  experiment::Experiment experiment;
  Nodes nodes;
  sweep::SlurmOptions options;
  SweepTold told;
  std::vector<sweep::ShardCounts> counts;
};

std::string LocalTable(const experiment::Experiment& experiment) {
  const test::TemporaryFolder folder;
  SweepTold told;
  const auto result = SweepInto(folder.Path(), experiment, told);
  REQUIRE(result);
  return report::TableCsv(*result);
}

TEST_CASE("A grid on a cluster is dealt out as asked for, and no trial of it is run here") {
  OnCluster cluster(SmallGrid());
  cluster.options.shards = 3;
  CHECK(cluster.Table() == LocalTable(SmallGrid()));
  CHECK(cluster.nodes.sizes == std::vector<size_t>{2, 1, 1});
  CHECK(cluster.nodes.paths == std::vector<int>{2, 1, 1});
  CHECK(cluster.nodes.kinds == std::vector<sweep::ShardKind>(3, sweep::ShardKind::kTrials));
  CHECK(cluster.told.trials == 4);
  CHECK(cluster.told.from_journal == 4);
  REQUIRE(cluster.counts.size() == 2);  // told when they change alone
  CHECK(cluster.counts[0] == sweep::ShardCounts{.total = 3});
  CHECK(cluster.counts[1] == sweep::ShardCounts{.total = 3, .done = 3});
  CHECK_FALSE(fs::exists(cluster.out / "shards"));
  OnCluster whole(SmallGrid());
  whole.options.shards = 1;
  CHECK(whole.Table() == LocalTable(SmallGrid()));
  CHECK(whole.nodes.sizes == std::vector<size_t>{4});
}

TEST_CASE("Where nobody says how many shards, eight trials here tell it within its bounds") {
  OnCluster cluster(SmallGrid({"reference.trials=8"}));
  cluster.options.most_shards = 2;
  SECTION("small shards: as many as there may be") {
    cluster.options.shard_s = 1e-6;
    CHECK(cluster.Table() == LocalTable(cluster.experiment));
    CHECK(cluster.nodes.sizes == std::vector<size_t>{4, 4});
  }
  SECTION("large shards: one") {
    cluster.options.shard_s = 1e6;
    CHECK(cluster.Table() == LocalTable(cluster.experiment));
    CHECK(cluster.nodes.sizes == std::vector<size_t>{8});
  }
  SECTION("what eight trials finish is given to nobody") {
    cluster.experiment = SmallGrid();
    CHECK(cluster.Table() == LocalTable(cluster.experiment));
    CHECK(cluster.told.from_journal == 4);
  }
}

TEST_CASE("A finished sweep is asked of no cluster again") {
  OnCluster cluster(SmallGrid());
  cluster.options.shards = 2;
  const std::string table = cluster.Table();
  cluster.nodes.sizes.clear();
  CHECK(cluster.Table() == table);
  CHECK(cluster.nodes.sizes.empty());
}

const std::string kSearch =
    "gap: {threshold_m: 0.01}\nreference: {kind: path, trials: 1}\ngoal: falsify\n"
    "space: {surface: [ground, parchment], control.v_min: {min: 0.12, max: 0.2}}\n"
    "search: {budget: 6}\nfalsify: {until: budget, most_repeats: 2}\n";

TEST_CASE("A search is one job that runs the whole of it") {
  const experiment::Experiment search = LoadText(kShortWay + kSearch);
  OnCluster cluster(search);
  CHECK(cluster.Table() == LocalTable(search));
  CHECK(cluster.nodes.kinds == std::vector<sweep::ShardKind>{sweep::ShardKind::kSweep});
  CHECK(cluster.told.trials == cluster.told.from_journal);
}

TEST_CASE("Shrinking on a cluster is one job with the failing row, and its answer that of here") {
  const experiment::Experiment grid = SmallGrid({"gap.threshold_m=0.0001"});
  OnCluster cluster(grid);
  cluster.options.shards = 1;
  cluster.Table();
  cluster.nodes.kinds.clear();
  cluster.nodes.sizes.clear();
  sweep::Evaluator evaluator(grid, "sweep.yaml", FileInputs());
  const auto result =
      RunSweep(evaluator, {.out = cluster.out, .cluster = &cluster.options}, cluster.Observer());
  REQUIRE(result);
  const auto answers = Answer({.shrink = "3"}, cluster.out, *result, evaluator,
                              {.cluster = &cluster.options}, cluster.Observer());
  REQUIRE(answers);
  REQUIRE(answers->shrunk);
  CHECK(answers->shrunk->id == 3);
  CHECK(cluster.nodes.kinds == std::vector<sweep::ShardKind>{sweep::ShardKind::kShrink});
  CHECK(cluster.nodes.sizes == std::vector<size_t>{1});
  CHECK(ReadStatus(cluster.out).state == "done");
  const auto local =
      Answer({.shrink = "3"}, cluster.out, *result, evaluator, {}, cluster.Observer());
  CHECK(local->shrunk->shrunk.theta == answers->shrunk->shrunk.theta);
}

TEST_CASE("A sweep on a cluster that is told to stop says so in its journal") {
  OnCluster cluster(SmallGrid());
  cluster.options.shards = 2;
  SweepObserver observer = ObserverOf(cluster.told);
  observer.watch_for_stop = [] { return [] { return false; }; };
  sweep::Evaluator evaluator(cluster.experiment, "sweep.yaml", FileInputs());
  const SweepRunRequest request{.out = cluster.out, .cluster = &cluster.options};
  CHECK_FALSE(RunSweep(evaluator, request, observer));
  CHECK(cluster.told.ends == std::vector<std::string>{"stopped"});
  CHECK(ReadStatus(cluster.out).state == "stopped");
  // Its shards are open still: a local run says that it leaves them alone.
  SweepTold told;
  REQUIRE(SweepInto(cluster.out, cluster.experiment, told));
  CHECK_THAT(told.Text(), Catch::Contains("note: shards of this sweep were given to a cluster (" +
                                          (cluster.out / "slurm").string() + ")"));
  CHECK(told.from_journal == 0);
  // And on the cluster again: what was open is taken in before anything else.
  const SweepRunRequest fresh{.out = cluster.out, .fresh = true};
  SweepTold anew;
  REQUIRE(RunSweep(evaluator, fresh, ObserverOf(anew)));
  CHECK(anew.from_journal == 0);
  CHECK(anew.trials == 4);
  CHECK_FALSE(fs::exists(cluster.out / "slurm"));
}

}  // namespace
}  // namespace rift::sessions
