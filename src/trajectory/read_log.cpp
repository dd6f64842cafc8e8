#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "csv.hpp"
#include "log_rows.hpp"
#include "plausibility.hpp"
#include "rift/geometry/angle.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::trajectory {
namespace {

using geometry::kPi;
using geometry::RadFromDeg;
using geometry::WrapToPi;

bool Has(const std::vector<std::string>& header, std::string_view name) {
  return std::find(header.begin(), header.end(), name) != header.end();
}

bool IsBlankLine(std::string_view line) { return line.find_first_not_of(" \t") == line.npos; }

bool IsComment(std::string_view line) {
  return !IsBlankLine(line) && line[line.find_first_not_of(" \t")] == '#';
}

/// True when the first line that is no comment holds numbers between blanks, and for comments only.
bool LooksLikeTum(std::string_view line, std::string_view rest) {
  bool commented = false;
  while (IsComment(line) || (IsBlankLine(line) && !rest.empty())) {
    commented = commented || IsComment(line);
    line = csv::TakeLine(rest);
  }
  if (IsBlankLine(line)) return commented;
  return line.find_first_not_of("0123456789+-.eE \t") == line.npos;
}

/// kAuto where the header is the authors': it is the same for their robot and their simulator.
Format FormatFromHeader(std::string_view text, const std::string& name) {
  std::string_view rest = csv::WithoutMark(text);
  std::string_view line;
  int number = 0;
  for (; !rest.empty() && IsBlankLine(line); ++number) line = csv::TakeLine(rest);
  const std::vector<std::string> header = csv::SplitHeader(line);
  if (Has(header, "t_s") && Has(header, "x_m") && Has(header, "y_m")) return Format::kRift;
  if (Has(header, "t") && Has(header, "x") && Has(header, "y")) return Format::kAuto;
  if (LooksLikeTum(line, rest)) return Format::kTum;
  throw std::invalid_argument(fmt::format(
      "{}:{}: the header '{}' belongs to no dialect: it needs t_s,x_m,y_m (rift), t,x,y (tracker, "
      "webots) or eight columns without header (tum)",
      name, number, csv::Shown(line)));
}

/// The one place where the authors' camera frame (x right, y down, z away from the camera, yaw
/// clockwise seen from above) becomes the frame of their waypoints. They wrote the waypoints in
/// camera numbers and drove Webots, a y-up world, by the same numbers: their floor and their
/// simulator are mirror images. x, y and yaw agree with each other as they stand and are kept, so
/// that robot, simulator and waypoints can be compared; left and right of a real log are swapped.
/// Height is measured up from the camera.
void FromTrackerFrame(StampedPose& pose) {
  pose.z_m = -pose.z_m;
  pose.roll_rad = RadFromDeg(pose.roll_rad);
  pose.pitch_rad = RadFromDeg(pose.pitch_rad);
  pose.yaw_rad = WrapToPi(RadFromDeg(pose.yaw_rad));
}

/// The authors' robot model points along its own y axis, hence the quarter turn.
void FromWebotsFrame(StampedPose& pose) { pose.yaw_rad = WrapToPi(pose.yaw_rad - kPi / 2.0); }

/// Angles of which the unit is not known are taken out rather than guessed.
void ForgetAngles(Log& log) {
  double largest = 0.0;
  bool any = false;
  for (StampedPose& pose : log.trajectory.poses) {
    for (double* angle : {&pose.roll_rad, &pose.pitch_rad, &pose.yaw_rad}) {
      if (std::isnan(*angle)) continue;
      any = true;
      largest = std::max(largest, std::abs(*angle));
      *angle = StampedPose::kNotLogged;
    }
    pose.z_m = StampedPose::kNotLogged;
  }
  if (!any) return;
  log.unknown_angles = fmt::format(
      "its header does not tell degrees (tracker) from radians (webots){}",
      largest > 2.0 * kPi ? fmt::format("; an angle of {:.1f} looks like degrees", largest) : "");
}

void ConvertAngles(Log& log) {
  if (log.format == Format::kRift || log.format == Format::kTum) return;
  for (StampedPose& pose : log.trajectory.poses) {
    if (log.format == Format::kTracker) FromTrackerFrame(pose);
    if (log.format == Format::kWebots) FromWebotsFrame(pose);
  }
  if (log.format == Format::kAuto) ForgetAngles(log);
}

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

void CheckMoves(const Trajectory& trajectory, const std::string& name) {
  if (trajectory.poses.size() < 2) {
    throw std::invalid_argument(fmt::format("{}: {} poses, and a trajectory needs at least 2", name,
                                            trajectory.poses.size()));
  }
  const auto moves = [](const StampedPose& a, const StampedPose& b) {
    return (b.Position() - a.Position()).norm() > 0.0;
  };
  const auto& poses = trajectory.poses;
  if (std::adjacent_find(poses.begin(), poses.end(), moves) == poses.end()) {
    throw std::invalid_argument(
        fmt::format("{}: the path has zero length: the robot never moved", name));
  }
}

/// Files whose lines no reader finds, each with what to do.
void RefuseNoText(std::string_view head, const std::string& name) {
  if (csv::WithoutMark(head).find_first_not_of(" \t\r\n") == head.npos) {
    throw std::invalid_argument(name + ": the file is empty");
  }
  if (head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF")) {
    throw std::invalid_argument(name + ": is UTF-16: save it as UTF-8 text");
  }
  if (head.find('\n') == head.npos && head.find('\r') < head.size() - 1) {
    throw std::invalid_argument(name + ": its lines end with CR alone: save it with LF or CRLF");
  }
}

}  // namespace

Log ReadLog(std::string_view text, const std::string& name, Format format) {
  const auto next = [&] { return std::exchange(text, {}); };
  return ReadLog(TextPieces{next, text.size()}, name, format);
}

Log ReadLog(const TextPieces& pieces, const std::string& name, Format format) {
  Log log;
  const std::string_view head = pieces.next();
  RefuseNoText(head, name);
  log.format = format == Format::kAuto ? FormatFromHeader(head, name) : format;
  LogRows rows = ReadRows(head, pieces, name, log.format);
  log.trajectory = std::move(rows.trajectory);
  NoteDoubtfulAngles(log, rows.largest_angles);
  ConvertAngles(log);
  if (!rows.time_rises) SortByTime(log);
  if (rows.first_line_without_yaw && LacksSomeYaw(log.trajectory)) {
    log.line_without_yaw = rows.first_line_without_yaw;
  }
  CheckMoves(log.trajectory, name);
  return log;
}

}  // namespace rift::trajectory
