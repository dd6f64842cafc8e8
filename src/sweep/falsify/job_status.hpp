#pragma once

#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/run/worker_pool.hpp"

namespace rift::sweep {

/// How a trial ended that was a job of a worker process.
TrialStatus StatusOf(JobEnd end);

/// The row of a request whose job has ended: why it has no findings, if it has none; else they are
/// to be decoded into it.
TrialRow EndedRow(TrialRequest request, const JobResult& result);

/// What `work` makes of one encoded request, in a process of its own that is given up as those of
/// a sweep are.
JobResult RunApart(const WorkerPool::Work& work, const TrialRequest& request,
                   const RunOptions& options);

}  // namespace rift::sweep
