#include "rift/sessions/sweep/journal.hpp"

#include <fmt/format.h>

#include "rift/files/folder_lock.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::sessions {
namespace {

/// Keys that say when a sweep ends and not what a trial is: a journal goes on with others.
bool IsFree(const std::string& key) {
  if (key.starts_with("run.")) return true;
  for (const char* free : {"name", "search.budget", "search.max_s", "falsify.until"}) {
    if (key == free) return true;
  }
  return false;
}

/// A journal that says "running" while nobody holds the folder was left by a killed sweep, and one
/// with damaged rows lacks trials, whatever it says.
std::string StateOf(const std::filesystem::path& folder, const sweep::JournalSummary& summary) {
  if (files::FolderLock::IsHeld(folder)) return "running";
  const auto noted = summary.notes.find("state");
  const bool is_noted = noted != summary.notes.end() && noted->second == "done";
  const bool is_done = is_noted && summary.damaged == 0;
  return is_done ? "done" : "stopped";
}

}  // namespace

bool IsComputed(const experiment::Experiment& experiment) {
  return experiment.candidate.kind != experiment::CandidateKind::kLogs ||
         experiment.reference.kind == experiment::ReferenceKind::kProgram;
}

sweep::Facts FactsOf(const experiment::Experiment& experiment) {
  sweep::Facts facts;
  for (const auto& [key, value] : experiment::FlatValues(experiment)) {
    if (!IsFree(key)) facts[key] = value;
  }
  facts["the version of rift"] = fmt::format("{} ({})", RIFT_VERSION, sweep::PhysicsVersion());
  return facts;
}

SweepStatus ReadStatus(const std::filesystem::path& folder) {
  SweepStatus status{.summary = sweep::ReadJournal(folder / kJournalName)};
  status.state = StateOf(folder, status.summary);
  status.shards = sweep::ReadShardCounts(folder);
  return status;
}

}  // namespace rift::sessions
