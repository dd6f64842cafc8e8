#include "rift/sweep/falsify/recorded_logs.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <vector>

#include "rift/gap/result.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/trajectory/frame_grid.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::sweep {

namespace {

std::string WhyNoYaw(const trajectory::Log& log, const std::string& format_key) {
  if (!log.unknown_angles.empty()) return fmt::format("{}: set {}", log.unknown_angles, format_key);
  if (log.line_without_yaw) return fmt::format("line {} has none", *log.line_without_yaw);
  return "it logs none: leave the tag offset at 0";
}

}  // namespace

trajectory::Log ReadMovedLog(const std::string& text, const std::string& path,
                             const LogOptions& options) {
  trajectory::Log log = trajectory::ReadLog(text, path, options.read);
  if (options.tag_offset_m != 0.0 && !log.trajectory.HasYaw()) {
    throw std::invalid_argument(fmt::format("{}: a tag offset of {:g} m needs the yaw, and {}",
                                            path, options.tag_offset_m,
                                            WhyNoYaw(log, options.format_key)));
  }
  log.trajectory = trajectory::OffsetAlongHeading(std::move(log.trajectory), options.tag_offset_m);
  if (options.grid_fps > 0.0) {
    trajectory::OnFrames found =
        trajectory::PutOnFrames(std::move(log.trajectory), options.grid_fps);
    if (!found.grid.is_found) log.notes.push_back(found.grid.Text());
    log.trajectory = std::move(found.trajectory);
  }
  return log;
}

const Recording& RecordedLogs::At(const std::string& path) {
  const auto [found, is_new] = recordings_.try_emplace(path);
  if (is_new) found->second = Load(path);
  return found->second;
}

Recording RecordedLogs::Load(const std::string& path) {
  Recording recording{.source = path};
  try {
    const std::optional<std::string> bytes = inputs_.read(path);
    if (!bytes) {
      recording.status = TrialStatus::kMissing;
      recording.reason = "no such file";
      return recording;
    }
    hash_of_[path] = statistics::Hash128Text(*bytes);
    trajectory::Log log = ReadMovedLog(*bytes, path, options_);
    for (const std::string& note : log.notes) inputs_.note(fmt::format("{}: {}", path, note));
    recording.doubts = std::move(log.doubts);
    recording.trajectory = std::move(log.trajectory);
  } catch (const std::invalid_argument& bad_log) {  // a row of its own, not the sweep's end
    recording.status = TrialStatus::kUnreadable;
    recording.reason = bad_log.what();
  }
  return recording;
}

void RecordedLogs::NoteCopies() {
  std::vector<std::string> paths;
  std::vector<trajectory::Trajectory> logs;
  for (const auto& [path, recording] : recordings_) {
    if (recording.status != TrialStatus::kOk) continue;
    paths.push_back(path);
    logs.push_back(recording.trajectory);
  }
  const std::vector<std::optional<size_t>> copy_of = gap::CopiesAmong(logs);
  for (size_t i = 0; i < paths.size(); ++i) {
    if (!copy_of[i]) continue;
    inputs_.note(
        fmt::format("{}: it has the positions of {}: a log that was copied is no further "
                    "drive of the robot",
                    paths[i], paths[*copy_of[i]]));
  }
}

std::string RecordedLogs::HashOf(const std::string& path) const {
  const auto found = hash_of_.find(path);
  return found == hash_of_.end() ? "" : found->second;
}

std::string RecordedLogs::HashesText() const {
  std::string text;
  for (const auto& [path, hash] : hash_of_) text += fmt::format("{}  {}\n", hash, path);
  return text;
}

}  // namespace rift::sweep
