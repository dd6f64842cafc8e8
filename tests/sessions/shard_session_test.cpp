// A shard of a sweep, as the job of a cluster computes it.
#include <catch2/catch.hpp>
#include <filesystem>

#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "rift/sessions/sweep/shard.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "sessions/sweep_folder.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

/// A shard of the small grid in a file, as whoever submits it writes it.
struct Submitted {
  explicit Submitted(sweep::ShardKind kind = sweep::ShardKind::kTrials) {
    fs::create_directories(out / "shards");
    shard.facts = sweep::HashOf(FactsOf(experiment));
    shard.experiment = statistics::Hash128Text(experiment::WriteExperiment(experiment));
    shard.kind = kind;
    shard.paths = 3;
    sweep::Evaluator evaluator(experiment, "sweep.yaml", FileInputs());
    sweep::KeysHash keys;
    for (const sweep::TrialRequest& request : Requests()) {
      requests.push_back(request);
      shard.requests.push_back(sweep::EncodeRequest(request));
      keys.Add(evaluator.KeyOf(request));
    }
    if (kind == sweep::ShardKind::kTrials) shard.keys = keys.Text();
  }

  std::vector<sweep::TrialRequest> Requests() const {
    std::vector<sweep::TrialRequest> all;
    for (const experiment::ParameterValue& surface : experiment.space.parameters[0].levels) {
      for (const sweep::TrialRequest& one : sweep::TrialsAt(experiment, {surface})) {
        all.push_back(one);
      }
    }
    return all;
  }
  ShardFile Read() const {
    test::WriteText(folder / "0.shard", sweep::EncodeShard(shard));
    return ReadShard(folder / "0.shard", experiment);
  }
  bool Run(SweepTold& told, int jobs = 1) const {
    return RunShard(Read(), experiment, "sweep.yaml", FileInputs(), {.out = out, .jobs = jobs},
                    ObserverOf(told));
  }
  fs::path Done() const { return sweep::ShardJournal(out, Read().name); }
  fs::path Unfinished() const { return sweep::UnfinishedShardJournal(out, Read().name); }

  test::TemporaryFolder folder;
  fs::path out = folder / "out";
  experiment::Experiment experiment = SmallGrid();
  sweep::Shard shard;
  std::vector<sweep::TrialRequest> requests;
};

TEST_CASE("A shard is read with its name, and one of another experiment or build is refused") {
  const Submitted submitted;
  const ShardFile read = submitted.Read();
  CHECK(read.file == submitted.folder / "0.shard");
  CHECK(read.name == sweep::ShardName(sweep::EncodeShard(submitted.shard)));
  CHECK(read.shard.requests == submitted.shard.requests);
  // The journal would go on with another limit, the shard does not.
  CHECK_THROWS_WITH(
      ReadShard(submitted.folder / "0.shard", SmallGrid({"run.timeout_s=77"})),
      Contains((submitted.folder / "0.shard") + ": it is a shard of another experiment"));
  Submitted other;
  other.shard.facts += "0";
  CHECK_THROWS_WITH(other.Read(), Contains("every node must run the rift that submitted it"));
}

TEST_CASE(
    "The journal of a shard holds its trials with the rows of a local run, and the key says so") {
  const Submitted submitted;
  SweepTold told;
  CHECK(submitted.Run(told));
  CHECK(fs::exists(submitted.Done()));
  CHECK_FALSE(fs::exists(submitted.Unfinished()));
  sweep::Journal journal(submitted.Done(), FactsOf(submitted.experiment));
  sweep::Evaluator evaluator(submitted.experiment, "sweep.yaml", FileInputs());
  int paths = 0;
  for (const sweep::TrialRequest& request : submitted.requests) {
    const auto bytes = journal.Find(evaluator.KeyOf(request));
    REQUIRE(bytes);
    sweep::TrialRow row = sweep::RowFor(request);
    sweep::DecodeFindings(*bytes, row);
    CHECK(row.comparison.gap_m == evaluator.Evaluate(request).comparison.gap_m);
    paths += !row.evidence.path_m.empty();
  }
  CHECK(paths == 3);  // of four
}

TEST_CASE("A shard that is done is not computed again") {
  const Submitted submitted;
  SweepTold told;
  REQUIRE(submitted.Run(told));
  int asked = 0;
  SweepObserver observer = ObserverOf(told);
  observer.watch_for_stop = [&asked] {
    ++asked;
    return [] { return false; };
  };
  CHECK(RunShard(submitted.Read(), submitted.experiment, "sweep.yaml", FileInputs(),
                 {.out = submitted.out}, observer));
  CHECK(asked == 0);
}

TEST_CASE("A shard that is told to stop leaves what it has, and the next job goes on from there") {
  const Submitted submitted;
  SweepTold told;
  SweepObserver observer = ObserverOf(told);
  observer.watch_for_stop = [] { return [] { return false; }; };
  CHECK_FALSE(RunShard(submitted.Read(), submitted.experiment, "sweep.yaml", FileInputs(),
                       {.out = submitted.out}, observer));
  CHECK_FALSE(fs::exists(submitted.Done()));
  REQUIRE(sweep::IsJournalOf(submitted.Unfinished(), FactsOf(submitted.experiment)));
  {
    // A row of an earlier job, which no run would make.
    sweep::Evaluator evaluator(submitted.experiment, "sweep.yaml", FileInputs());
    sweep::TrialRow row = evaluator.Evaluate(submitted.requests[1]);
    row.comparison.gap_m = 0.125;
    sweep::Journal journal(submitted.Unfinished(), FactsOf(submitted.experiment));
    journal.Add(evaluator.KeyOf(submitted.requests[1]),
                {"ok", 0.125, true, sweep::EncodeFindings(row)});
    journal.Close();
  }
  CHECK(submitted.Run(told));
  CHECK_FALSE(fs::exists(submitted.Unfinished()));
  const sweep::JournalSummary summary = sweep::ReadJournal(submitted.Done());
  CHECK(summary.trials_by_status.at("ok") == 4);
  CHECK(summary.largest_gap_m == 0.125);
}

TEST_CASE("A shard is copied back while it runs as often as is asked for, whatever it runs") {
  using sweep::ShardKind;
  for (const ShardKind kind : {ShardKind::kTrials, ShardKind::kSweep, ShardKind::kShrink}) {
    for (const double every_s : {0.0, 1e6}) {
      Submitted submitted(kind);
      if (kind == ShardKind::kShrink) submitted.shard.requests.resize(1);
      const ShardFile shard = submitted.Read();
      const fs::path copy = sweep::UnfinishedShardJournal(submitted.out, shard.name);
      int copies = 0;
      SweepTold told;
      SweepObserver observer = ObserverOf(told);
      observer.watch_for_stop = [&] {
        return [&] {
          copies += fs::exists(copy);
          return false;
        };
      };
      CHECK_FALSE(RunShard(shard, submitted.experiment, "sweep.yaml", FileInputs(),
                           {.out = submitted.out, .copy_every_s = every_s}, observer));
      INFO(static_cast<int>(kind) << " every " << every_s << " s");
      CHECK((copies > 0) == (every_s == 0.0));
    }
  }
}

TEST_CASE("A shard whose logs or trials are others here than where it was submitted is refused") {
  Submitted submitted;
  submitted.shard.keys = "0123";
  SweepTold told;
  CHECK_THROWS_WITH(submitted.Run(told), Contains((submitted.folder / "0.shard") +
                                                  ": its trials read logs or programs"));
  CHECK_FALSE(fs::exists(submitted.Done()));
  Submitted swapped;
  std::swap(swapped.shard.requests[0], swapped.shard.requests[3]);
  CHECK_THROWS_WITH(swapped.Run(told), Contains("are others on this machine"));
}

TEST_CASE("A whole sweep as a shard leaves a journal that a local sweep goes on with") {
  const Submitted submitted(sweep::ShardKind::kSweep);
  SweepTold told, local;
  CHECK(submitted.Run(told));
  CHECK(told.trials == 4);
  CHECK(told.ends == std::vector<std::string>{"done"});
  fs::create_directories(submitted.folder / "local");
  fs::copy_file(submitted.Done(), submitted.folder / "local/journal.sqlite");
  REQUIRE(SweepInto(submitted.folder / "local", submitted.experiment, local));
  CHECK(local.from_journal == 4);
}

TEST_CASE("A whole sweep that is stopped as a shard is not done") {
  const Submitted submitted(sweep::ShardKind::kSweep);
  SweepTold told{.stops_after = 0};
  CHECK_FALSE(submitted.Run(told));
  CHECK_FALSE(fs::exists(submitted.Done()));
  CHECK(fs::exists(submitted.Unfinished()));
}

TEST_CASE("Shrinking as a shard leaves its trials beside the table of the sweep") {
  Submitted submitted(sweep::ShardKind::kShrink);
  submitted.experiment = SmallGrid({"gap.threshold_m=0.0001"});
  submitted.shard.facts = sweep::HashOf(FactsOf(submitted.experiment));
  submitted.shard.experiment =
      statistics::Hash128Text(experiment::WriteExperiment(submitted.experiment));
  submitted.shard.requests = {submitted.shard.requests[2]};
  SweepTold told;
  CHECK(submitted.Run(told));
  const sweep::JournalSummary summary = sweep::ReadJournal(submitted.Done());
  CHECK(summary.trials_by_status.empty());  // none of its table
  sweep::Journal journal(submitted.Done(), FactsOf(submitted.experiment));
  sweep::Evaluator evaluator(submitted.experiment, "sweep.yaml", FileInputs());
  sweep::TrialRequest request = submitted.requests[2];
  CHECK(journal.Has("beside the table: " + evaluator.KeyOf(request)));
  CHECK_FALSE(journal.Has(evaluator.KeyOf(request)));
  SweepTold stopped{.stops_after = 0};
  Submitted again(sweep::ShardKind::kShrink);
  again.experiment = submitted.experiment;
  again.shard = submitted.shard;
  CHECK_FALSE(again.Run(stopped));
}

}  // namespace
}  // namespace rift::sessions
