#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "rift/files/descriptor.hpp"
#include "rift/sweep/run/options.hpp"
#include "rift/sweep/run/worker_pool.hpp"

namespace rift::sweep {

/// One forked process that does jobs one after the other.
class Worker {
 public:
  /// Throws MachineTrouble when no process can be made.
  Worker(const WorkerPool::Work& work, const RunOptions& options);
  /// Kills and reaps it.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  int Descriptor() const { return socket_.Number(); }
  /// A job that cannot be sent shows as the worker's exit.
  void Send(const std::string& job);
  /// Takes in what has arrived. False when the worker has exited.
  bool Receive();
  /// The next finished job among what arrived. Throws MachineTrouble where the work did.
  std::optional<JobResult> NextResult();

  struct ExitStatus {
    JobEnd end = JobEnd::kCrashed;
    std::string reason;
    bool from_outside = false;  ///< killed by somebody else: no fault of the job
  };
  /// Reaps a worker that exited by itself and says why.
  ExitStatus Reap();

 private:
  std::string StartOfOutput() const;

  RunOptions options_;
  pid_t pid_ = -1;
  files::Descriptor socket_;
  files::Descriptor output_;  ///< what it wrote to stdout and stderr during the job
  std::string arrived_;
};

}  // namespace rift::sweep
