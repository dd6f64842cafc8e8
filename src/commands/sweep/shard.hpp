#pragma once

#include "request.hpp"

namespace rift::commands {

/// What a job of --engine slurm does: computes the trials of a shard into a journal on this
/// machine's own disk (TMPDIR) and puts it, whole, into OUT/shards. Ends at once where it is there
/// already. What is done is copied back every --copy-every seconds and when it is told to stop, and
/// the next job of the same shard goes on from there. Returns the exit code.
int RunShard(const SweepRequest& request, const experiment::Experiment& experiment);

}  // namespace rift::commands
