#include "recorded_logs.hpp"

#include <filesystem>
#include <stdexcept>

#include "logs.hpp"

namespace rift::commands {

const sweep::Recording& RecordedLogs::At(const std::string& path) {
  const auto [found, is_new] = recordings_.try_emplace(path);
  if (is_new) found->second = Load(path);
  return found->second;
}

sweep::Recording RecordedLogs::Load(const std::string& path) {
  sweep::Recording recording{.source = path};
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    recording.status = sweep::TrialStatus::kMissing;
    recording.reason = error ? error.message() : "no such file";
    return recording;
  }
  try {
    hashes_.Add(path);
    trajectory::Log log = LoadLog(path, format_, tag_offset_m_, format_key_);
    PrintNotes(log, path);
    recording.trajectory = std::move(log.trajectory);
  } catch (const std::invalid_argument& bad_log) {  // a row of its own, not the sweep's end
    recording.status = sweep::TrialStatus::kUnreadable;
    recording.reason = bad_log.what();
  }
  return recording;
}

}  // namespace rift::commands
