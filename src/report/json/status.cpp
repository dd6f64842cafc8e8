#include "rift/report/json/json.hpp"

#include <fmt/format.h>

#include "rift/report/json/fields.hpp"

namespace rift::report {
namespace {

std::string NoteOf(const sweep::JournalSummary& summary, const std::string& name) {
  const auto found = summary.notes.find(name);
  return found == summary.notes.end() ? "0" : found->second;
}

std::string PlanText(const sweep::JournalSummary& summary) {
  if (!summary.notes.contains("most_settings")) return NoteOf(summary, "most_trials");
  return "at most " + NoteOf(summary, "most_settings") + " settings";
}

int Done(const sweep::JournalSummary& summary) {
  int done = 0;
  for (const auto& [status, count] : summary.trials_by_status) done += count;
  return done;
}

}  // namespace

std::string StatusJson(const sweep::JournalSummary& summary, const std::string& state,
                       const std::optional<sweep::ShardCounts>& shards) {
  nlohmann::ordered_json status{{"state", state},
                                {"name", NoteOf(summary, "name")},
                                {"done", Done(summary)},
                                {"most_trials", std::stoi(NoteOf(summary, "most_trials"))},
                                {"most_settings", std::stoi(NoteOf(summary, "most_settings"))},
                                {"elapsed_s", std::stod(NoteOf(summary, "elapsed_s"))},
                                {"falsified", summary.falsified},
                                {"damaged", summary.damaged},
                                {"largest_gap_m", nullptr},
                                {"largest_gap_at", summary.largest_key},
                                {"trials_by_status", summary.trials_by_status},
                                {"shards", nullptr}};
  if (summary.largest_gap_m) status["largest_gap_m"] = *summary.largest_gap_m;
  if (shards) {
    status["shards"] = {{"total", shards->total},
                        {"done", shards->done},
                        {"running", shards->running},
                        {"pending", shards->pending},
                        {"reason", shards->reason}};
  }
  return Dump(status);
}

std::string StatusText(const sweep::JournalSummary& summary, const std::string& state,
                       const std::optional<sweep::ShardCounts>& shards) {
  std::string text = fmt::format("{}: {}, {} trials done (planned: {}) in {} s, {} falsified\n",
                                 NoteOf(summary, "name"), state, Done(summary), PlanText(summary),
                                 NoteOf(summary, "elapsed_s"), summary.falsified);
  if (shards) {
    text += fmt::format("shards on the cluster: {} of {} done, {} running, {} pending{}\n",
                        shards->done, shards->total, shards->running, shards->pending,
                        shards->reason.empty() ? "" : fmt::format(" ({})", shards->reason));
  }
  for (const auto& [status, count] : summary.trials_by_status) {
    if (status != "ok") text += fmt::format("{}: {}\n", status, count);
  }
  if (summary.damaged > 0) {
    text += fmt::format("damaged, to be run again: {}\n", summary.damaged);
  }
  if (summary.largest_gap_m) {
    text +=
        fmt::format("largest gap: {:.4f} m at {}\n", *summary.largest_gap_m, summary.largest_key);
  }
  return text;
}

}  // namespace rift::report
