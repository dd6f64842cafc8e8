#pragma once

#include <filesystem>
#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/sessions/sweep/observer.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/sweep/run/shard.hpp"

namespace rift::sessions {

/// A shard as a job of --engine slurm finds it.
struct ShardFile {
  std::string file;
  std::string name;  ///< of its journal
  sweep::Shard shard;
};

/// Throws std::invalid_argument for a shard of another experiment or another build of rift.
ShardFile ReadShard(const std::string& file, const experiment::Experiment& experiment);

struct ShardRunRequest {
  std::filesystem::path out;
  int jobs = 1;
  double copy_every_s = 600.0;
};

/// Computes the trials of a shard into a journal on this machine's own disk (TMPDIR) and puts it,
/// whole, into OUT/shards. Ends at once where it is there already. What is done is copied back
/// every `copy_every_s` seconds and when it is told to stop, and the next job of the same shard
/// goes on from there. True when it is done.
bool RunShard(const ShardFile& shard, const experiment::Experiment& experiment,
              const std::string& experiment_file, const sweep::Inputs& inputs,
              const ShardRunRequest& request, const SweepObserver& observer);

}  // namespace rift::sessions
