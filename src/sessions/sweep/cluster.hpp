#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rift/sessions/sweep/observer.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/slurm_options.hpp"
#include "rift/sweep/run/slurm_shards.hpp"

namespace rift::sessions {

/// The trials of a sweep on a cluster. What it brings into the journal is what a local run would
/// have put there; whoever runs the sweep afterwards finds its trials done.
class Cluster {
 public:
  /// All must outlive this.
  Cluster(sweep::Evaluator& evaluator, const sweep::Facts& facts,
          const sweep::SlurmOptions& options, const SweepObserver& observer, GoOn go_on);

  /// Called once before the others: what jobs of an earlier run have done, and are doing.
  /// False when it was told to stop, as the others.
  bool Resume(const std::filesystem::path& out, sweep::Journal& journal);
  /// Runs those of the trials that the journal lacks. A grid's as job arrays; a few of them are run
  /// here first, to tell how long the others take. A search asks for a few trials at a time, which
  /// are not worth a job: the whole of it is run in one, and then all that it asks for is there.
  bool Run(const std::vector<sweep::TrialRequest>& requests, sweep::TrialRunner& runner);
  /// The same of what asks for its trials one after the other: one job with its workers, which goes
  /// on with what the journal holds. `shard` says what, besides where it belongs.
  bool RunAsOne(sweep::Shard shard);

 private:
  sweep::Shard EmptyShard() const;
  void Tell(const sweep::ShardCounts& counts);
  /// Shards for that many trials; nothing when it was told to stop.
  std::optional<size_t> ShardsFor(const std::vector<sweep::TrialRequest>& requests,
                                  std::vector<size_t>& missing, sweep::TrialRunner& runner);

  sweep::Evaluator& evaluator_;
  const sweep::Facts& facts_;
  const sweep::SlurmOptions& options_;
  const SweepObserver& observer_;
  GoOn go_on_;
  std::string experiment_;  ///< resolved
  std::filesystem::path out_;
  sweep::Journal* journal_ = nullptr;
  bool has_run_sweep_ = false;
  std::optional<sweep::SlurmShards> shards_;
  std::optional<sweep::ShardCounts> told_;
};

}  // namespace rift::sessions
