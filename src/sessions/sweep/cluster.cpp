#include "cluster.hpp"

#include <chrono>
#include <utility>

#include "rift/statistics/hash.hpp"
#include "rift/sweep/run/shard.hpp"

namespace rift::sessions {

Cluster::Cluster(sweep::Evaluator& evaluator, const sweep::Facts& facts,
                 const sweep::SlurmOptions& options, const SweepObserver& observer, GoOn go_on)
    : evaluator_(evaluator),
      facts_(facts),
      options_(options),
      observer_(observer),
      go_on_(std::move(go_on)),
      experiment_(experiment::WriteExperiment(evaluator.experiment())) {}

bool Cluster::Resume(const std::filesystem::path& out, sweep::Journal& journal) {
  out_ = out;
  journal_ = &journal;
  shards_.emplace(
      out, options_, experiment_, journal,
      sweep::SlurmShards::Watch{[this](const sweep::ShardCounts& counts) { Tell(counts); }, go_on_,
                                observer_.say});
  return shards_->Resume();
}

sweep::Shard Cluster::EmptyShard() const {
  return {.facts = sweep::HashOf(facts_), .experiment = statistics::Hash128Text(experiment_)};
}

bool Cluster::RunAsOne(sweep::Shard shard) {
  const sweep::Shard empty = EmptyShard();
  shard.facts = empty.facts;
  shard.experiment = empty.experiment;
  const std::filesystem::path start =
      sweep::UnfinishedShardJournal(out_, sweep::ShardName(sweep::EncodeShard(shard)));
  std::filesystem::create_directories(start.parent_path());
  std::filesystem::remove(start);
  journal_->CopyTo(start);
  return shards_->Run({shard});
}

std::optional<size_t> Cluster::ShardsFor(const std::vector<sweep::TrialRequest>& requests,
                                         std::vector<size_t>& missing, sweep::TrialRunner& runner) {
  if (options_.shards > 0) return options_.shards;
  constexpr size_t kProbed = 8;
  std::vector<sweep::TrialRequest> probed;
  for (size_t i = 0; i < std::min(kProbed, missing.size()); ++i) {
    probed.push_back(requests[missing[i]]);
  }
  const auto begun = std::chrono::steady_clock::now();
  sweep::TrialRunner here(
      [this](const sweep::TrialRequest& trial) { return evaluator_.Evaluate(trial); },
      [this](const sweep::TrialRequest& trial) { return evaluator_.KeyOf(trial); }, journal_, 1,
      evaluator_.experiment().run,
      {[](const sweep::TrialRow&, bool) {}, go_on_,
       [this](sweep::TrialRow& row) { evaluator_.NameSides(row); }});
  if (!here.Run(probed)) return std::nullopt;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  missing = runner.Missing(requests);
  const double trial_s = took.count() / static_cast<double>(probed.size());
  const double work_s = trial_s * static_cast<double>(missing.size()) / options_.cpus_per_task;
  const double shards = std::min(work_s / options_.shard_s, double(options_.most_shards));
  return std::max<size_t>(1, static_cast<size_t>(shards));
}

bool Cluster::Run(const std::vector<sweep::TrialRequest>& requests, sweep::TrialRunner& runner) {
  std::vector<size_t> missing = runner.Missing(requests);
  if (missing.empty()) return true;
  if (evaluator_.experiment().goal == experiment::Goal::kFalsify) {
    // What was damaged on the way is run here.
    return std::exchange(has_run_sweep_, true) || RunAsOne({.kind = sweep::ShardKind::kSweep});
  }
  const std::optional<size_t> count = ShardsFor(requests, missing, runner);
  if (!count) return false;
  std::vector<sweep::Shard> shards;
  for (const std::vector<size_t>& part : sweep::DealOut(missing.size(), *count)) {
    sweep::Shard shard = EmptyShard();
    sweep::KeysHash keys;
    for (const size_t i : part) {
      const sweep::TrialRequest& request = requests[missing[i]];
      keys.Add(evaluator_.KeyOf(request));
      shard.requests.push_back(sweep::EncodeRequest(request));
      shard.paths += missing[i] < runner.PathsLeft();
    }
    shard.keys = keys.Text();
    shards.push_back(std::move(shard));
  }
  return shards_->Run(shards);
}

void Cluster::Tell(const sweep::ShardCounts& counts) {
  if (counts == told_) return;
  told_ = counts;
  observer_.shards(counts);
}

}  // namespace rift::sessions
