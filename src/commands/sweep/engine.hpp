#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "progress.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/slurm_options.hpp"
#include "rift/sweep/run/slurm_shards.hpp"

namespace rift::commands {

/// Where the trials of a sweep are run, as it was asked for.
struct EngineRequest {
  std::string engine = "local";  ///< local, slurm, or a file of configs/engines
  std::string partition;
  int shards = 0;               ///< 0: not asked for
  std::string shard;            ///< a file: this process is a job and computes that shard
  double copy_every_s = 600.0;  ///< of a shard
};

void AddEngineFlags(CLI::App& app, EngineRequest& request);

/// The habits of the cluster; nothing where trials are run on this machine. Throws
/// std::invalid_argument for an engine that is none, and yaml::Error for a wrong file.
std::optional<sweep::SlurmOptions> ClusterOf(const EngineRequest& request);

/// Throws std::invalid_argument for an experiment that has no trials to be handed out.
void CheckEngine(const experiment::Experiment& experiment, const std::string& experiment_file);

/// The trials of a sweep on a cluster. What it brings into the journal is what a local run would
/// have put there; whoever runs the sweep afterwards finds its trials done.
class Cluster {
 public:
  /// All must outlive this.
  Cluster(sweep::Evaluator& evaluator, const sweep::Facts& facts,
          const sweep::SlurmOptions& options, ProgressStyle progress, std::function<bool()> go_on);

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
  ProgressStyle progress_;
  std::function<bool()> go_on_;
  std::string experiment_;  ///< resolved
  std::filesystem::path out_;
  sweep::Journal* journal_ = nullptr;
  bool has_run_sweep_ = false;
  std::optional<sweep::SlurmShards> shards_;
  std::string told_;
};

}  // namespace rift::commands
