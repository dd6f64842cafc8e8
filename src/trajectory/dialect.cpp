#include "dialect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "columns.hpp"
#include "plausibility.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/trajectory/csv.hpp"
#include "rift_columns.hpp"

namespace rift::trajectory {
namespace {

using geometry::kPi;
using geometry::RadFromDeg;
using geometry::WrapToPi;

bool Has(const std::vector<std::string>& header, std::string_view name) {
  return std::find(header.begin(), header.end(), name) != header.end();
}

/// Cells between blanks.
int CellsOf(std::string_view line) {
  int cells = 0;
  bool is_blank = true;
  for (const char c : line) {
    const bool was_blank = std::exchange(is_blank, c == ' ' || c == '\t');
    cells += was_blank && !is_blank;
  }
  return cells;
}

/// True when the first line that is no comment holds eight numbers between blanks, and for comments
/// only.
bool LooksLikeTum(std::string_view line, std::string_view rest) {
  bool commented = false;
  while (csv::IsComment(line) || (csv::IsBlankLine(line) && !rest.empty())) {
    commented = commented || csv::IsComment(line);
    line = csv::TakeLine(rest);
  }
  if (csv::IsBlankLine(line)) return commented;
  return line.find_first_not_of("0123456789+-.eE \t") == line.npos && CellsOf(line) == 8;
}

/// In the order of StampedPose.
constexpr std::array<std::string_view, 9> kAuthorsColumns{
    "t", "x", "y", "z", "roll", "pitch", "yaw", "desired_x", "desired_y"};

constexpr std::array<double StampedPose::*, 9> kFields{
    &StampedPose::t_s,     &StampedPose::x_m,        &StampedPose::y_m,
    &StampedPose::z_m,     &StampedPose::roll_rad,   &StampedPose::pitch_rad,
    &StampedPose::yaw_rad, &StampedPose::target_x_m, &StampedPose::target_y_m};

/// Where the named columns of a header go: into the fields of a pose, further ones into channels.
class ColumnMap {
 public:
  ColumnMap(const std::vector<std::string>& header, const std::array<std::string_view, 9>& names,
            const std::string& name, int header_line)
      : names_(names), name_(name) {
    std::vector<bool> taken(header.size(), false);
    for (size_t i = 0; i < names.size(); ++i) {
      const auto found = std::find(header.begin(), header.end(), names[i]);
      if (found == header.end() && i < kRequired) {
        throw std::invalid_argument(
            fmt::format("{}:{}: column {} is missing", name, header_line, names[i]));
      }
      if (found == header.end()) continue;
      taken[found - header.begin()] = true;
      fields_.push_back({static_cast<size_t>(found - header.begin()), kFields[i]});
    }
    for (size_t column = 0; column < taken.size(); ++column) {
      if (!taken[column]) channels_.push_back(column);
      if (header[column] == "track_state") state_ = column;
    }
  }

  const std::vector<size_t>& Channels() const { return channels_; }

  bool IsTrackedIn(const csv::RowReader& row) const {
    return !state_ || IsTracked(row.Cells()[*state_]);
  }

  StampedPose PoseOf(const csv::RowReader& row) const {
    StampedPose pose;
    for (const auto& [column, field] : fields_) pose.*field = row.Cells()[column];
    for (size_t i = 0; i < kRequired; ++i) {
      if (!std::isnan(pose.*kFields[i])) continue;
      throw std::invalid_argument(
          fmt::format("{}:{}: column {} is empty", name_, row.Line(), names_[i]));
    }
    return pose;
  }

 private:
  static constexpr size_t kRequired = 3;
  struct Source {
    size_t column;
    double StampedPose::*field;
  };

  const std::array<std::string_view, 9>& names_;
  const std::string& name_;
  std::vector<Source> fields_;
  std::vector<size_t> channels_;
  std::optional<size_t> state_;
};

void ReadColumns(csv::RowReader row, const std::array<std::string_view, 9>& names,
                 const std::string& name, const std::string& columns_flag, LogRows& rows) {
  const ColumnMap columns(row.Columns(), names, name, row.Line());
  row.Advise(columns.Channels(),
             fmt::format("; where the columns to be read are named, others may hold text: "
                         "{}'t={},x={},y={}'",
                         columns_flag, names[0], names[1], names[2]));
  for (const size_t column : columns.Channels()) {
    rows.trajectory.channels.push_back({row.Columns()[column], {}});
  }
  while (row.Next()) {
    if (!columns.IsTrackedIn(row)) {
      ++rows.untracked;
      continue;
    }
    AddPose(rows, columns.PoseOf(row), name, row.Line());
    for (size_t i = 0; i < columns.Channels().size(); ++i) {
      rows.trajectory.channels[i].values.push_back(row.Cells()[columns.Channels()[i]]);
    }
  }
  for (const Channel& channel : rows.trajectory.channels) {
    if (channel.name == "tag_id") RequireOneRobot(channel.values, name);
  }
}

StampedPose TumPose(const csv::RowReader& row, const std::string& name) {
  const std::span<const double> cells = row.Cells();
  if (cells.size() != 8) {
    throw std::invalid_argument(
        fmt::format("{}:{}: {} columns, and tum has 8: t tx ty tz qx qy qz qw", name, row.Line(),
                    cells.size()));
  }
  StampedPose pose{.t_s = cells[0], .x_m = cells[1], .y_m = cells[2], .z_m = cells[3]};
  SetAngles(pose, cells[4], cells[5], cells[6], cells[7], fmt::format("{}:{}", name, row.Line()));
  return pose;
}

void ReadTum(csv::RowReader row, const std::string& name, LogRows& rows) {
  while (row.Next()) AddPose(rows, TumPose(row, name), name, row.Line());
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

std::string_view NameOf(Format format) {
  return EnumNames(format)[static_cast<std::size_t>(format)];
}

/// Nothing where the text has no columns, as that of another kind of file.
ColumnGuess GuessOf(std::string_view text, const std::string& name) {
  try {
    return GuessColumns(text, name, "");
  } catch (const std::invalid_argument&) {
    return {};
  }
}

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

}  // namespace

bool IsTracked(double track_state) { return track_state == 0.0; }

void RequireOneRobot(std::vector<double> tags, const std::string& name) {
  std::erase_if(tags, [](double tag) { return std::isnan(tag); });  // not logged
  if (tags.empty()) return;
  const auto [least, greatest] = std::minmax_element(tags.begin(), tags.end());
  if (*least == *greatest) return;
  throw std::invalid_argument(
      fmt::format("{}: it holds several robots, tags {:g} to {:g}: keep the rows of one tag_id",
                  name, *least, *greatest));
}

void AddPose(LogRows& rows, const StampedPose& pose, const std::string& name, int line) {
  CheckMagnitudes(pose, name, line);
  if (std::isnan(pose.yaw_rad) && !rows.first_line_without_yaw) rows.first_line_without_yaw = line;
  rows.trajectory.poses.push_back(pose);
}

Format FormatFromHeader(std::string_view text, const std::string& name,
                        const std::string& columns_flag) {
  std::string_view rest = csv::WithoutMark(text);
  std::string_view line;
  int number = 0;
  for (; !rest.empty() && csv::IsBlankLine(line); ++number) line = csv::TakeLine(rest);
  const std::vector<std::string> header = csv::SplitHeader(line);
  if (Has(header, "t_s") && Has(header, "x_m") && Has(header, "y_m")) return Format::kRift;
  if (Has(header, "t") && Has(header, "x") && Has(header, "y")) return Format::kAuto;
  if (LooksLikeTum(line, rest)) return Format::kTum;
  const auto [guess, unclear] = GuessOf(text, name);
  throw std::invalid_argument(fmt::format(
      "{}:{}: the header '{}' belongs to no dialect: it needs t_s,x_m,y_m (rift), t,x,y (tracker, "
      "webots) or eight columns without header (tum); {} {}'{}'{}",
      name, number, csv::Shown(line), guess.empty() ? "name its columns:" : "is it this?",
      columns_flag, guess.empty() ? "t=...,x=...,y=...,yaw=...:deg" : guess, unclear));
}

void RequireFormat(std::string_view text, const std::string& name, Format format) {
  const bool is_authors = format == Format::kTracker || format == Format::kWebots;
  Format told = Format::kAuto;
  try {
    told = FormatFromHeader(text, name, "");
  } catch (const std::invalid_argument&) {  // what is missing is said by who reads it
    return;
  }
  if (told == (is_authors ? Format::kAuto : format)) return;
  throw std::invalid_argument(fmt::format(
      "{}: its header is of dialect {}, and the format asked for is {}: leave it at "
      "auto, or name another log",
      name, told == Format::kAuto ? std::string_view("tracker or webots") : NameOf(told),
      NameOf(format)));
}

LogRows ReadRows(std::string_view text, const std::string& name, Format format,
                 const std::string& columns_flag) {
  LogRows rows;
  rows.trajectory.poses.reserve(std::count(text.begin(), text.end(), '\n') + 1);
  if (format == Format::kTum) {
    ReadTum(csv::RowReader(text, name, false, ' '), name, rows);
  } else {
    ReadColumns(csv::RowReader(text, name, true, ','),
                format == Format::kRift ? kRiftColumns : kAuthorsColumns, name, columns_flag, rows);
  }
  return rows;
}

void ConvertUnitsAndFrame(Log& log) {
  if (log.format == Format::kRift || log.format == Format::kTum) return;
  for (StampedPose& pose : log.trajectory.poses) {
    if (log.format == Format::kTracker) FromTrackerFrame(pose);
    if (log.format == Format::kWebots) FromWebotsFrame(pose);
  }
  if (log.format == Format::kAuto) ForgetAngles(log);
}

}  // namespace rift::trajectory
