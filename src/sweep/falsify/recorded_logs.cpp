#include "rift/sweep/falsify/recorded_logs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/gap/goal.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/trajectory/frame_grid.hpp"

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

std::string RecordedLogs::HashOf(const std::string& path) const {
  const auto found = hash_of_.find(path);
  return found == hash_of_.end() ? "" : found->second;
}

std::string RecordedLogs::HashesText() const {
  std::string text;
  for (const auto& [path, hash] : hash_of_) text += fmt::format("{}  {}\n", hash, path);
  return text;
}

namespace {

bool Counts(const CountOptions& count, TrialStatus status) {
  switch (status) {
    case TrialStatus::kTimedOut:
      return count.timed_out;
    case TrialStatus::kFell:
      return count.fell;
    case TrialStatus::kLeftArena:
      return count.left_arena;
    case TrialStatus::kLost:
      return count.lost;
    default:
      return false;
  }
}

void Fail(TrialRow& row, const Recording& recording) {
  row.status = recording.status;
  // A reader's message begins with the path already.
  const bool is_named = recording.reason.find(recording.source) != recording.reason.npos;
  row.reason =
      is_named ? recording.reason : fmt::format("{}: {}", recording.source, recording.reason);
}

bool IsFinite(const trajectory::Trajectory& path) {
  return std::all_of(path.poses.begin(), path.poses.end(), [](const auto& pose) {
    return std::isfinite(pose.x_m) && std::isfinite(pose.y_m);
  });
}

/// A path that never moves is a row of its own, not the sweep's end.
void Measure(const experiment::Experiment& experiment, const Recording& candidate,
             const Recording& reference, TrialRow& row) {
  const gap::GapOptions& options = experiment.gap;
  if (!IsFinite(candidate.trajectory)) {
    row.status = TrialStatus::kNan;
    row.reason = fmt::format("{}: a position is not finite", candidate.source);
    return;
  }
  try {
    row.comparison = gap::Compare(candidate.trajectory, reference.trajectory, options);
    if (const std::optional<gap::Goal> goal = WayGoalOf(experiment, row)) {
      row.way_gap_m = gap::WayGap_m(candidate.trajectory, reference.trajectory, *goal, options);
    }
    row.evidence.fingerprint = Fingerprint(candidate.trajectory);
    row.evidence.errors_m = ErrorsAlong(candidate.trajectory, reference.trajectory, options);
    row.evidence.path_m = EvenPath(candidate.trajectory, reference.trajectory, options);
    row.evidence.path_times_s = EvenTimes_s(candidate.trajectory, options);
  } catch (const std::invalid_argument& no_path) {
    row.status = TrialStatus::kUnreadable;
    row.reason =
        fmt::format("{} against {}: {}", candidate.source, reference.source, no_path.what());
  }
}

}  // namespace

TrialRow CompareTrial(const experiment::Experiment& experiment, const TrialRequest& request,
                      const Recording& simulated, const Recording& real) {
  TrialRow row = RowFor(request);
  row.candidate = simulated.source;
  row.reference = real.source;
  row.evidence.candidate_limits = simulated.limits;
  row.evidence.reference_limits = real.limits;
  if (real.status != TrialStatus::kOk) {
    Fail(row, real);
  } else if (simulated.status != TrialStatus::kOk) {
    Fail(row, simulated);
    row.falsified = Counts(experiment.falsify.count, simulated.status);
    row.left_m = simulated.left_m;
    if (row.falsified) row.evidence.fingerprint = Fingerprint(simulated.trajectory);
    row.evidence.path_m = EvenPath(simulated.trajectory, experiment.gap);
    row.evidence.path_times_s = EvenTimes_s(simulated.trajectory, experiment.gap);
  } else {
    Measure(experiment, simulated, real, row);
    row.falsified = row.CountedGap_m() > experiment.gap.threshold_m;
  }
  return row;
}

}  // namespace rift::sweep
