#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "columns.hpp"
#include "dialect.hpp"
#include "plausibility.hpp"
#include "rift/trajectory/csv.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::trajectory {
namespace {

void Reorder(Trajectory& trajectory, const std::vector<size_t>& order) {
  Trajectory sorted;
  for (const size_t i : order) sorted.poses.push_back(trajectory.poses[i]);
  for (const Channel& channel : trajectory.channels) {
    Channel copy{channel.name, {}};
    for (const size_t i : order) copy.values.push_back(channel.values[i]);
    sorted.channels.push_back(std::move(copy));
  }
  trajectory = std::move(sorted);
}

bool TimeRises(const Trajectory& trajectory) {
  const auto does_not_rise = [](const StampedPose& a, const StampedPose& b) {
    return b.t_s <= a.t_s;
  };
  const auto& poses = trajectory.poses;
  return std::adjacent_find(poses.begin(), poses.end(), does_not_rise) == poses.end();
}

/// Makes time strictly increasing and notes what had to be done for it.
void SortByTime(Log& log) {
  const auto& poses = log.trajectory.poses;
  std::vector<size_t> order(poses.size());
  std::iota(order.begin(), order.end(), size_t{0});
  size_t backwards = 0;
  for (size_t i = 1; i < poses.size(); ++i) backwards += poses[i].t_s < poses[i - 1].t_s;
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return poses[a].t_s < poses[b].t_s; });
  std::vector<size_t> kept;
  for (const size_t i : order) {
    if (!kept.empty() && poses[kept.back()].t_s == poses[i].t_s) kept.pop_back();
    kept.push_back(i);
  }
  const size_t dropped = poses.size() - kept.size();
  Reorder(log.trajectory, kept);
  if (backwards > 0) {
    log.notes.push_back(fmt::format("time runs backwards {} times: rows sorted", backwards));
  }
  if (dropped > 0) {
    log.notes.push_back(
        fmt::format("{} rows share the time of another: the last is kept", dropped));
  }
}

/// Of the poses that were kept some have a yaw and some have none.
bool LacksSomeYaw(const Trajectory& trajectory) {
  const auto has_one = [](const StampedPose& pose) { return !std::isnan(pose.yaw_rad); };
  return !trajectory.HasYaw() &&
         std::any_of(trajectory.poses.begin(), trajectory.poses.end(), has_one);
}

/// A log whose header does not tell whether z is up may hold one that was not taken.
void RequireHeights(const Log& log, const std::string& name, const ReadOptions& options) {
  for (const StampedPose& pose : log.trajectory.poses) {
    if (!std::isnan(pose.z_m)) continue;
    const bool is_unknown = log.format == Format::kAuto;
    throw std::invalid_argument(fmt::format(
        "{}: the pose at {:.10g} s has no height z, and a gap in space (dimension xyz) needs it: "
        "{}, "
        "or leave dimension at xy",
        name, pose.t_s,
        is_unknown ? "name its format, tracker or webots, since its header does not tell which way "
                     "z points"
                   : fmt::format("log z_m, or name its column: {}t=...,x=...,y=...,z=...",
                                 options.columns_flag)));
  }
}

/// `notes`: what has become of the rows that are no poses.
void CheckMoves(const Trajectory& trajectory, const std::string& name, bool in_space,
                const std::vector<std::string>& notes) {
  if (trajectory.poses.size() < 2) {
    throw std::invalid_argument(fmt::format("{}: {}, and a trajectory needs at least 2{}{}", name,
                                            trajectory.poses.empty() ? "0 poses" : "1 pose",
                                            notes.empty() ? "" : ": ", fmt::join(notes, "; ")));
  }
  const auto moves = [in_space](const StampedPose& a, const StampedPose& b) {
    return (b.Position() - a.Position()).norm() > 0.0 || (in_space && a.z_m != b.z_m);
  };
  const auto& poses = trajectory.poses;
  if (std::adjacent_find(poses.begin(), poses.end(), moves) == poses.end()) {
    throw std::invalid_argument(
        fmt::format("{}: the path has zero length: the robot never moved", name));
  }
}

/// Files whose lines no reader finds, each with what to do.
void RefuseNoText(std::string_view text, const std::string& name) {
  if (csv::WithoutMark(text).find_first_not_of(" \t\r\n") == text.npos) {
    throw std::invalid_argument(name + ": the file is empty");
  }
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    throw std::invalid_argument(name + ": is UTF-16: save it as UTF-8 text");
  }
  // Further down anything may be left by a writer that was killed; a terminal's colours are text.
  const std::string_view start = text.substr(0, text.find('\n'));
  if (std::any_of(start.begin(), start.end(), csv::IsNoText)) {
    throw std::invalid_argument(name +
                                ": is not text: a log is a table of numbers in text, such as CSV");
  }
  if (text.find('\n') == text.npos && text.find('\r') < text.size() - 1) {
    throw std::invalid_argument(name + ": its lines end with CR alone: save it with LF or CRLF");
  }
}

void NoteLeftOut(size_t rows, std::string_view why, Log& log) {
  if (rows == 0) return;
  const std::string number = rows == 1 ? "1 row is" : fmt::format("{} rows are", rows);
  log.notes.push_back(fmt::format("{} left out: {}", number, why));
}

/// Units alone do not change those that a header names.
UnitAdvice AdviceOf(const ReadOptions& options, bool has_named_units) {
  if (!has_named_units) return {options.OwnUnitsFlag() + "mm", options.OwnUnitsFlag() + "ms"};
  return {options.OwnColumnsFlag() + "'t=...,x=...:mm,y=...:mm'",
          options.OwnColumnsFlag() + "'t=...:ms,x=...,y=...'"};
}

}  // namespace

Log ReadLog(std::string_view text, const std::string& name, Format format) {
  return ReadLog(text, name, ReadOptions{.format = format});
}

Log ReadLog(std::string_view text, const std::string& name, const ReadOptions& options) {
  CheckColumns(options);
  RefuseNoText(text, name);
  csv::RequireTaken(text, name);
  const bool has_own_columns = !options.columns.empty() || !options.units.empty();
  Log log;
  LogRows rows;
  if (has_own_columns) {
    log.format = Format::kRift;
    rows = ReadColumns(text, name, options);
    if (!rows.guessed.empty()) {
      log.notes.push_back(fmt::format("read as {}'{}'", options.OwnColumnsFlag(), rows.guessed));
    }
  } else {
    if (options.format != Format::kAuto) RequireFormat(text, name, options.format);
    log.format = options.format == Format::kAuto
                     ? FormatFromHeader(text, name, options.columns_flag)
                     : options.format;
    if (log.format == Format::kRift) {
      if (const auto note = csv::NoteOfEnd(text)) log.notes.push_back(*note);
      text = csv::WithoutTornRow(text);
    }
    rows = ReadRows(text, name, log.format, options.columns_flag);
  }
  log.trajectory = std::move(rows.trajectory);
  NoteLeftOut(rows.untracked, "track_state is predicted, ambiguous or lost", log);
  NoteLeftOut(rows.without_position, "no position", log);
  if (!has_own_columns) NoteDoubtfulAngles(log);
  ConvertUnitsAndFrame(log);
  if (!TimeRises(log.trajectory)) SortByTime(log);
  if (rows.first_line_without_yaw && LacksSomeYaw(log.trajectory)) {
    log.line_without_yaw = rows.first_line_without_yaw;
  }
  if (options.in_space) RequireHeights(log, name, options);
  CheckMoves(log.trajectory, name, options.in_space, log.notes);
  const bool has_named_units =
      !rows.guessed.empty() || (!has_own_columns && log.format == Format::kRift);
  log.doubts = Doubts(log.trajectory, options.in_space, AdviceOf(options, has_named_units));
  return log;
}

}  // namespace rift::trajectory
