#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rift/sessions/sweep/engine.hpp"
#include "rift/sessions/sweep/further_questions.hpp"
#include "rift/sweep/run/worker_pool.hpp"

namespace rift::commands {

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
  std::optional<int> suggest;        ///< experiments to print
  sessions::FurtherQuestions further;
  sessions::EngineRequest engine;
  std::string write_robot;
};

/// The flags of `rift sweep`; `request` must outlive the app.
void AddSweepFlags(CLI::App& app, SweepRequest& request);

}  // namespace rift::commands
