#include "rift/report/json/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace rift::report {
namespace {

using nlohmann::ordered_json;

std::string DurationText(double duration_s) {
  const auto whole_s = static_cast<int>(std::lround(duration_s));
  if (whole_s < 3600) return fmt::format("{}:{:02}", whole_s / 60, whole_s % 60);
  return fmt::format("{}:{:02}:{:02}", whole_s / 3600, whole_s / 60 % 60, whole_s % 60);
}

}  // namespace

std::string ProgressBar(const ProgressCounts& counts) {
  constexpr int kWidth = 24;
  const int full = counts.most > 0
                       ? static_cast<int>(static_cast<long>(kWidth) *
                                          std::min(counts.steps, counts.most) / counts.most)
                       : 0;
  return fmt::format("[{}{}]", std::string(static_cast<size_t>(full), '#'),
                     std::string(static_cast<size_t>(kWidth - full), '.'));
}

std::string ProgressText(const ProgressCounts& counts) {
  std::string text =
      counts.is_settings
          ? fmt::format("{}/{} settings, {} trials, {:.1f}/s", counts.steps, counts.most,
                        counts.done, counts.trials_per_s)
          : fmt::format("{}/{} trials, {:.1f}/s", counts.done, counts.most, counts.trials_per_s);
  if (counts.left_s) {
    text += fmt::format(", {}{} left", counts.is_settings ? "at most " : "",
                        DurationText(*counts.left_s));
  }
  if (counts.largest_gap_m) text += fmt::format(", largest gap {:.4f} m", *counts.largest_gap_m);
  return text + fmt::format(", {} failing, {} without gap", counts.falsified, counts.failed);
}

std::string ProgressJson(const std::string& state, const ProgressCounts& counts) {
  ordered_json json{{"state", state},
                    {"done", counts.done},
                    {"from_journal", counts.from_journal},
                    {"trials_per_s", counts.trials_per_s},
                    {"left_s", nullptr},
                    {"largest_gap_m", nullptr},
                    {"falsified", counts.falsified},
                    {"failed", counts.failed}};
  json[counts.is_settings ? "most_settings" : "total"] = counts.most;
  if (counts.is_settings) json["settings"] = counts.steps;
  if (counts.left_s) json["left_s"] = *counts.left_s;
  if (counts.largest_gap_m) json["largest_gap_m"] = *counts.largest_gap_m;
  return json.dump();
}

std::string ReferencesText(const sweep::ReferenceProgress& references) {
  std::string text =
      fmt::format("references: {} of {} nominal runs", references.arrived, references.seeds);
  if (references.others_tried > 0) {
    text += fmt::format(", {} other seeds tried for those that did not arrive",
                        references.others_tried);
  }
  if (references.last_failure.empty()) return text;
  return text + fmt::format(" (last: {})", references.last_failure);
}

std::string ReferencesJson(const sweep::ReferenceProgress& references) {
  return ordered_json{{"state", "references"},
                      {"references", references.seeds},
                      {"references_done", references.arrived}}
      .dump();
}

std::string ShardsText(const sweep::ShardCounts& shards) {
  const std::string text = fmt::format("slurm: {}/{} shards done, {} running, {} pending",
                                       shards.done, shards.total, shards.running, shards.pending);
  return shards.reason.empty() ? text : text + fmt::format(" ({})", shards.reason);
}

std::string ShardsJson(const sweep::ShardCounts& shards) {
  return ordered_json{{"state", "running"},
                      {"shards", shards.total},
                      {"shards_done", shards.done},
                      {"shards_running", shards.running},
                      {"shards_pending", shards.pending}}
      .dump();
}

}  // namespace rift::report
