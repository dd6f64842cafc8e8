#pragma once

#include <string>
#include <vector>

#include "engine.hpp"
#include "explain.hpp"
#include "run.hpp"

namespace rift::commands {

/// What `rift sweep` was asked for.
struct SweepRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string out;
  std::string budget;
  std::string seconds;
  int jobs = CoresToUse();
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
  ExplainRequest explain;
  EngineRequest engine;
  std::string write_robot;
};

}  // namespace rift::commands
