#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "rift/sweep/run/slurm_options.hpp"

namespace rift::sweep {

/// Slurm does not answer or takes no jobs for the moment: ask again later.
class SlurmBusy : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A job array to be submitted.
struct SlurmArray {
  std::string name;              ///< of the job; by it its tasks are found again
  std::vector<int> tasks;        ///< indices, ascending
  std::filesystem::path script;  ///< absolute
  std::filesystem::path logs;    ///< folder for TASK.log, absolute
  std::filesystem::path folder;  ///< where the tasks start
};

/// A task that is in the queue.
struct SlurmTask {
  std::string job;     ///< id of its array
  std::string state;   ///< as squeue has it: PENDING, RUNNING, COMPLETING, ...
  std::string reason;  ///< why it is pending; empty when Slurm does not know yet

  /// After max_batch_requeue failures of its nodes (5 by default) Slurm keeps a task without ever
  /// starting it again.
  bool LostItsNodes() const { return reason == "JobHoldMaxRequeue"; }
  /// The same, after a single failure: a node that goes down while it starts the task, or cannot
  /// set it up ("launch failed requeued held"; later versions write underscores).
  bool FailedToStart() const {
    return reason.ends_with("requeued held") || reason.ends_with("requeued_held");
  }
  bool IsGivenUp() const { return LostItsNodes() || FailedToStart(); }
  bool IsWaiting() const { return state == "PENDING" || state == "REQUEUE_HOLD"; }
};

/// How long a command of Slurm is waited for: of a controller that is overloaded, or a file system
/// that does not answer, there may be no end.
struct SlurmPatience {
  double limit_s = 60.0;
  /// False: it is waited for kAtStop_s at most, so that one that is about to answer still does.
  std::function<bool()> go_on = [] { return true; };

  static constexpr double kAtStop_s = 1.0;
};

/// "0-4,7" of {0, 1, 2, 3, 4, 7}.
std::string IndexRanges(const std::vector<int>& indices);

/// The commands of Slurm, started by argument lists, never through a shell. All throw SlurmBusy
/// when Slurm cannot answer now, or not in time (the command is killed then), and
/// std::runtime_error, with its last line, when it refuses or is not installed.
///
/// The id of the new job.
std::string SubmitArray(const SlurmArray& array, const SlurmOptions& options,
                        const SlurmPatience& patience = {});
/// The tasks of this user's jobs of that name which have not ended, by their index.
std::map<int, SlurmTask> QueuedTasks(const std::string& name, const SlurmPatience& patience = {});
/// Cancels this user's jobs of that name; none is no error.
void CancelArrays(const std::string& name, const SlurmPatience& patience = {});
/// Cancels one task of an array.
void CancelTask(const SlurmTask& task, int index, const SlurmPatience& patience = {});
/// MaxArraySize of the cluster, below which indices are; the default of Slurm where it is busy.
int MaxArraySize(const SlurmPatience& patience = {});

}  // namespace rift::sweep
