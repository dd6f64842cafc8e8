#include "sweep_status.hpp"

#include <fmt/format.h>

#include "folder_lock.hpp"
#include "rift/report/json/fields.hpp"
#include "rift/sweep/run/journal.hpp"
#include "sweep_run.hpp"

namespace rift::commands {
namespace {

/// A journal that says "running" while nobody holds the folder was left by a killed sweep.
std::string StateOf(const std::filesystem::path& folder, const sweep::JournalSummary& summary) {
  if (FolderLock::IsHeld(folder)) return "running";
  const auto noted = summary.notes.find("state");
  const bool is_done = noted != summary.notes.end() && noted->second == "done";
  return is_done ? "done" : "stopped";
}

std::string NoteOf(const sweep::JournalSummary& summary, const std::string& name) {
  const auto found = summary.notes.find(name);
  return found == summary.notes.end() ? "0" : found->second;
}

std::string PlanText(const sweep::JournalSummary& summary) {
  if (!summary.notes.contains("most_settings")) return NoteOf(summary, "most_trials");
  return "at most " + NoteOf(summary, "most_settings") + " settings";
}

}  // namespace

std::string SweepStatus(const std::filesystem::path& folder, bool json) {
  const sweep::JournalSummary summary = sweep::ReadJournal(folder / kJournalName);
  const std::string state = StateOf(folder, summary);
  int done = 0;
  for (const auto& [status, count] : summary.trials_by_status) done += count;
  if (json) {
    nlohmann::ordered_json status{{"state", state},
                                  {"name", NoteOf(summary, "name")},
                                  {"done", done},
                                  {"most_trials", std::stoi(NoteOf(summary, "most_trials"))},
                                  {"most_settings", std::stoi(NoteOf(summary, "most_settings"))},
                                  {"elapsed_s", std::stod(NoteOf(summary, "elapsed_s"))},
                                  {"falsified", summary.falsified},
                                  {"largest_gap_m", nullptr},
                                  {"largest_gap_at", summary.largest_key},
                                  {"trials_by_status", summary.trials_by_status}};
    if (summary.largest_gap_m) status["largest_gap_m"] = *summary.largest_gap_m;
    return report::Dump(status);
  }
  std::string text = fmt::format("{}: {}, {} trials done (planned: {}) in {} s, {} falsified\n",
                                 NoteOf(summary, "name"), state, done, PlanText(summary),
                                 NoteOf(summary, "elapsed_s"), summary.falsified);
  for (const auto& [status, count] : summary.trials_by_status) {
    if (status != "ok") text += fmt::format("{}: {}\n", status, count);
  }
  if (summary.largest_gap_m) {
    text +=
        fmt::format("largest gap: {:.4f} m at {}\n", *summary.largest_gap_m, summary.largest_key);
  }
  return text;
}

}  // namespace rift::commands
