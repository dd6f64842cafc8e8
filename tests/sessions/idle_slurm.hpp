#pragma once

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "rift/sessions/sweep/shard.hpp"
#include "sessions/sweep_folder.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {

/// Commands in PATH that take jobs and show an empty queue.
class IdleSlurm {
 public:
  IdleSlurm() {
    for (const char* name : {"sbatch", "squeue", "scancel", "scontrol"}) {
      const std::string says = std::string(name) == "sbatch" ? "echo 7\n" : "";
      test::WriteText(folder_ / name, "#!/bin/sh\n" + says);
      std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_all);
    }
  }

 private:
  test::TemporaryFolder folder_;
  test::Environment path_{"PATH", folder_.Path().string() + ":" + std::getenv("PATH")};
};

/// The nodes: what a sweep in `out` has submitted is computed whenever it asks whether to go on.
struct Nodes {
  std::filesystem::path out;
  experiment::Experiment experiment;
  std::set<std::filesystem::path> computed{};
  std::vector<size_t> sizes{};  ///< requests of each shard
  std::vector<sweep::ShardKind> kinds{};
  std::vector<int> paths{};
  bool is_busy = false;

  bool Compute() {
    if (is_busy) return true;
    is_busy = true;
    std::error_code none;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out / "slurm", none)) {
      if (entry.path().extension() != ".shard" || !std::filesystem::exists(out / "shards"))
        continue;
      if (!computed.insert(entry.path()).second) continue;
      const ShardFile shard = ReadShard(entry.path(), experiment);
      sizes.push_back(shard.shard.requests.size());
      kinds.push_back(shard.shard.kind);
      paths.push_back(shard.shard.paths);
      SweepTold told;
      RunShard(shard, experiment, "sweep.yaml", FileInputs(), {.out = out}, ObserverOf(told));
    }
    is_busy = false;
    return true;
  }
};

}  // namespace rift::sessions
