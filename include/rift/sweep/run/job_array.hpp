#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "rift/sweep/run/shard.hpp"
#include "rift/sweep/run/slurm_options.hpp"

namespace rift::sweep {

/// The folder OUT/slurm/N of one job array: what its tasks read, the script that they run, and what
/// they had to say. It is open from when it was written whole until all of it is over.
class JobArray {
 public:
  explicit JobArray(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Those of a sweep, by number.
  static std::vector<JobArray> Of(const std::filesystem::path& out);
  /// The same, those that are open.
  static std::vector<JobArray> OpenOf(const std::filesystem::path& out);
  /// A new one behind them, not open yet.
  static JobArray Next(const std::filesystem::path& out);

  const std::filesystem::path& Folder() const { return folder_; }
  std::filesystem::path Script() const { return folder_ / "array.sh"; }
  std::filesystem::path LogFile(size_t task) const;
  /// What a task had to say last; "nothing" where it said nothing.
  std::string LastLine(size_t task) const;

  /// No other sweep of this user has jobs of that name.
  std::string JobName() const;
  /// Names of the shards, one a task; none where it is not open.
  std::vector<std::string> OpenShards() const;

  /// Writes what the tasks read, `experiment` resolved, and opens it. The names of the shards.
  std::vector<std::string> Write(const std::string& experiment, const std::vector<Shard>& shards);
  /// The script, before it is opened, and again where the cluster's habits may be others now. `out`
  /// is absolute.
  void WriteScript(const std::filesystem::path& out, const SlurmOptions& options) const;
  /// A line to the file of what was submitted: the job's id and its tasks.
  void NoteJob(const std::string& job, const std::string& tasks) const;

  /// Whether it was written with that experiment; false where nobody can say.
  bool IsOf(const std::string& experiment) const;
  /// Why a task would refuse its shard, which is named by its content; empty: it would not.
  std::string WhyUseless(size_t task, const std::string& shard) const;

  /// Closes it and removes what only its tasks need; script, ids and what they had to say stay.
  void CleanUp(const std::filesystem::path& out, const std::vector<std::string>& shards) const;

 private:
  std::filesystem::path ShardFile(size_t task) const;
  std::filesystem::path Experiment() const { return folder_ / "experiment.yaml"; }
  std::filesystem::path Index() const { return folder_ / "shards"; }  ///< a name a line

  std::filesystem::path folder_;
};

}  // namespace rift::sweep
