#pragma once

#include <string>
#include <vector>

#include "rift/sessions/sweep/further_questions.hpp"
#include "rift/sweep/run/worker_pool.hpp"

namespace rift::commands {

/// Where the trials of a sweep are run, as it was asked for.
struct EngineRequest {
  std::string engine = "local";  ///< local, slurm, or a file of configs/engines
  std::string partition;
  int shards = 0;               ///< 0: not asked for
  std::string shard;            ///< a file: this process is a job and computes that shard
  double copy_every_s = 600.0;  ///< of a shard
};

/// What `rift sweep` was asked for.
struct SweepRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string out;
  std::string budget;
  std::string seconds;
  int jobs = sweep::CoresToUse();
  bool fresh = false;  ///< --force as well: replace what is in the folder
  bool any_waypoints = false;
  bool quiet = false;
  bool json_progress = false;
  bool json = false;
  bool brief = false;  ///< five lines
  bool exit_code = false;
  bool serve = false;  ///< a page that grows, at a local address
  std::string status;
  std::vector<std::string> compare;  ///< two folders
  std::string page;                  ///< of --compare
  int suggest = 0;                   ///< experiments to print; 0: none
  sessions::FurtherQuestions further;
  EngineRequest engine;
  std::string write_robot;
};

}  // namespace rift::commands
