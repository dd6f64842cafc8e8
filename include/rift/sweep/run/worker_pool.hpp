#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rift/sweep/run/options.hpp"

namespace rift::sweep {

enum class JobEnd {
  kDone,
  kThrew,        ///< the work threw a std::exception
  kHung,         ///< longer than RunOptions::timeout_s
  kCrashed,      ///< the process ended: a signal, an abort, an exit
  kOutOfMemory,  ///< more than RunOptions::memory_mb
};

struct JobResult {
  JobEnd end = JobEnd::kDone;
  std::string bytes;  ///< what the work returned; else one line that says why it did not
};

class Worker;

/// Cores that this process may use.
int CoresToUse();

/// Work done in processes forked from this one, so that a crash costs one job. ODE cannot run twice
/// in one process, and worker processes share everything that was loaded before they started.
///
/// The coordinator must have a single thread. Workers see the memory of the moment they were
/// forked, close every descriptor but their own, leave Ctrl-C to the coordinator and die with it.
class WorkerPool {
 public:
  using Work = std::function<std::string(const std::string& job)>;

  /// What Run asks and tells its caller.
  struct Batch {
    int count = 0;
    std::function<std::string(int index)> job;       ///< bytes for Work, below 64 kB
    std::function<void(int index, JobResult)> done;  ///< once for each job, as they end
    std::function<bool()> go_on;  ///< asked at least every 0.1 s; false: stop now
  };

  /// Starts no process yet. Throws std::invalid_argument for less than one worker.
  WorkerPool(Work work, int workers, const RunOptions& options);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Runs all jobs of a batch. A job that hangs, crashes or runs out of memory is tried again
  /// `retries` times. True when all ended; false when go_on said no: what was under way is killed.
  /// Throws MachineTrouble when no process can be made and where the work did, after killing what
  /// was under way.
  bool Run(const Batch& batch);

 private:
  struct Job {
    int index = 0;
    std::string bytes;
    int failures = 0;  ///< own ones
    int kills = 0;     ///< by somebody else
  };
  struct Slot;

  void Feed(const Batch& batch);
  void Wait();
  void Collect(Slot& slot, const Batch& batch);
  void EndWorker(Slot& slot, JobEnd end, const std::string& reason, const Batch& batch);
  void KillAll();

  Work work_;
  RunOptions options_;
  std::vector<Slot> slots_;
  std::deque<Job> again_;  ///< to be tried again, before any new job
  int next_ = 0;
  int open_ = 0;  ///< jobs handed out or waiting to be tried again
};

}  // namespace rift::sweep
