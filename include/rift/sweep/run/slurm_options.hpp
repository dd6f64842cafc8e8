#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace rift::sweep {

/// The habits of a cluster (configs/engines/*.yaml): how its jobs are asked for, and how large they
/// are made. None of it changes what a trial computes.
struct SlurmOptions {
  std::string account;
  std::string partition;
  std::string time_limit;
  int cpus_per_task = 1;
  std::vector<std::string> arguments;
  std::vector<std::string> prologue;
  std::string program;
  int shards = 0;
  double shard_s = 60.0;
  int most_shards = 1000;
  int max_array_size = 0;
  int shards_at_once = 0;
  double copy_every_s = 600.0;
  double poll_s = 10.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("account", self.account, "whom the time is charged to (sbatch --account); empty: nobody");
    field("partition", self.partition, "where jobs go (sbatch --partition); empty: the default");
    field("time_limit", self.time_limit,
          "of one shard, as sbatch --time has it, such as 0:30:00; empty: the partition's");
    field("cpus_per_task", self.cpus_per_task, 1, 4096,
          "CPUs of one task, and worker processes in it");
    field("arguments", self.arguments, "further arguments of sbatch, such as --qos=short");
    field("prologue", self.prologue,
          "lines of shell before rift starts in a job, such as module load gcc");
    field("program", self.program,
          "rift as the nodes see it; empty: the file that was started here");
    field("shards", self.shards, 0, 1'000'000, "shards of a batch; 0: as many as shard_s allows");
    field("shard_s", self.shard_s, 0.01, 86400.0,
          "work that a shard has at least, estimated from a few trials that are run here first");
    field("most_shards", self.most_shards, 1, 1'000'000, "shards of a batch at most");
    field("max_array_size", self.max_array_size, 0, 1'000'000,
          "tasks of one array at most; 0: MaxArraySize of scontrol show config");
    field("shards_at_once", self.shards_at_once, 0, 1'000'000,
          "tasks of an array that run at once at most; 0: as many as the cluster lets");
    field("copy_every_s", self.copy_every_s, 1.0, 86400.0,
          "how often a shard that is not done yet is copied back");
    field("poll_s", self.poll_s, 0.05, 3600.0, "how often squeue is asked");
  }

  void Check() const {
    for (const std::string& argument : arguments) {
      if (argument.empty() || argument[0] != '-') {
        throw std::invalid_argument(
            "arguments: '" + argument +
            "' must be an option of sbatch in one word, such as --qos=short");
      }
    }
  }
};

}  // namespace rift::sweep
