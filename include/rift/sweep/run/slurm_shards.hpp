#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rift/sweep/run/job_array.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/shard.hpp"
#include "rift/sweep/run/slurm.hpp"
#include "rift/sweep/run/slurm_options.hpp"

namespace rift::sweep {

/// How far the shards of a sweep are.
struct ShardCounts {
  int total = 0;
  int done = 0;
  int running = 0;
  int pending = 0;     ///< in the queue, not started
  std::string reason;  ///< why the first of the pending waits, as squeue has it

  bool operator==(const ShardCounts&) const = default;
};

/// Shards of a sweep as job arrays of Slurm, and their rows in the journal of the sweep.
///
///   OUT/slurm/N/        an array of at most MaxArraySize shards: what its jobs read, `array.sh`
///                       that they run, `jobs` with the ids of what was submitted, their logs
///   OUT/shards/         journals of shards, whole files that jobs put there
///
/// These files are all that is known of what was submitted, so that a coordinator that was killed
/// goes on where it was. A shard that leaves the queue without its journal is submitted again; one
/// whose files are not those that were submitted is given up, and its trials are missing.
class SlurmShards {
 public:
  using Say = std::function<void(const std::string&)>;
  struct Watch {
    /// At every look at the queue.
    std::function<void(const ShardCounts&)> seen = [](const ShardCounts&) {};
    /// Asked at least every 0.1 s, also while a command of Slurm runs; false cancels the jobs.
    std::function<bool()> go_on = [] { return true; };
    /// A line for people: a refusal of Slurm, a damaged journal.
    Say say = [](const std::string&) {};
  };

  /// `out` is the folder of the sweep, which nobody else works in; `experiment` its resolved text.
  /// All must outlive this.
  SlurmShards(const std::filesystem::path& out, const SlurmOptions& options, std::string experiment,
              Journal& journal, Watch watch);

  /// Takes in what jobs of an earlier coordinator left and waits for those that are still under
  /// way. False when it was told to stop.
  bool Resume();
  /// Submits shards and waits until the rows of all are in the journal. False when it was told to
  /// stop: the jobs are cancelled then. Throws std::runtime_error when Slurm refuses the array, or
  /// a shard ended kMostTries times without a journal.
  bool Run(const std::vector<Shard>& shards);

  /// True where arrays of a sweep are not over.
  static bool AreOpen(const std::filesystem::path& out);
  /// Cancels the jobs of a sweep and removes what is left of them. Where Slurm does not answer, as
  /// on a machine that has none, that is said, and what is left is removed all the same: a task
  /// without its folder ends.
  static void Forget(const std::filesystem::path& out, const Say& say);

  static constexpr int kMostTries = 3;

 private:
  using Clock = std::chrono::steady_clock;

  struct Task {
    std::string name;  ///< of the shard
    bool is_done = false;
    int tries = 0;               ///< submissions by this process
    int absent = 0;              ///< looks in a row at a queue without it
    bool may_be_useless = true;  ///< its files may not be any more what was written
  };
  /// An array and its tasks.
  struct Group {
    JobArray array;
    std::string job_name;
    std::vector<Task> tasks;
    bool is_known = false;  ///< the queue has been looked at since it was submitted
    Limits limits = Limits::kOfNow;
  };

  Group Write(const std::vector<Shard>& shards) const;
  bool Drive(std::vector<Group> groups);
  ShardCounts Look(std::vector<Group>& groups);
  void LookAt(Group& group, ShardCounts& counts);
  void GiveUp(Group& group, size_t index, const SlurmTask& queued);
  void TakeIn(Group& group);
  bool TakeIn(const std::filesystem::path& journal, Limits limits);
  void Submit(Group& group);
  void DropUseless(Group& group);
  bool Wait(double duration_s) const;
  void Cancel(const std::vector<Group>& groups) const;
  void Complain(const std::string& reason);
  SlurmPatience Patience() const { return {.go_on = watch_.go_on}; }

  std::filesystem::path out_;
  const SlurmOptions& options_;
  std::string experiment_;
  Journal& journal_;
  Watch watch_;
  int most_at_once_ = 1'000'000;  ///< tasks in one submission: halved by each refusal
  double back_off_s_ = 0.0;
  bool queue_was_read_ = false;     ///< so that Slurm is there, and a failure passes
  Clock::time_point not_before_{};  ///< of the next submission, after a refusal
  std::string complaint_;           ///< the last, so that it is said once
};

/// How far the shards are of a sweep that was given to Slurm and is not over; nothing for others.
/// Where Slurm does not answer in that time only what is done is counted.
std::optional<ShardCounts> ReadShardCounts(const std::filesystem::path& out, double limit_s = 10.0);

}  // namespace rift::sweep
