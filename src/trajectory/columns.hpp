#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dialect.hpp"
#include "rift/trajectory/read_options.hpp"

namespace rift::trajectory {

/// What a column of a log may hold of a pose.
inline constexpr std::array<std::string_view, 13> kQuantities{
    "t", "x", "y", "z", "roll", "pitch", "yaw", "qx", "qy", "qz", "qw", "target_x", "target_y"};

/// A text table whose cells need not be numbers. Its first line is a header unless all its cells
/// are numbers; a header may be a comment (`# time x y`). Columns without names are called by their
/// numbers, from 1. Between cells stand commas, semicolons, tabs or blanks, whichever the first
/// line has most of; with semicolons a number may have a decimal comma.
class TextTable {
 public:
  /// Throws std::invalid_argument `name:line: ...` for two columns of one name.
  TextTable(std::string_view text, const std::string& name);

  const std::vector<std::string>& Columns() const { return columns_; }
  /// Goes on to the next row that is neither blank nor a comment; false after the last. Throws
  /// std::invalid_argument for a row with another number of cells than the header has.
  bool Next();
  /// NaN for an empty cell; nothing for one that is no finite number.
  std::optional<double> Number(size_t column) const;
  const std::string& Cell(size_t column) const { return cells_[column]; }
  /// 1-based line of the row; before the first row, of the header.
  int Line() const { return line_number_; }

 private:
  bool NextLine(std::string_view& line);

  std::string_view rest_;
  const std::string& name_;
  char separator_ = ',';
  std::vector<std::string> columns_;
  std::vector<std::string> cells_;
  int line_number_ = 0;
};

/// Reads a log by ReadOptions::columns and units. Throws std::invalid_argument `name:line: ...`.
LogRows ReadColumns(std::string_view text, const std::string& name, const ReadOptions& options);

/// What the columns of a log may be, as ReadOptions::columns: told from their names, their ranges
/// and the direction of travel. Empty when time and position are not found. `units` are taken as
/// given; others are guessed and written behind their columns.
std::string GuessColumns(std::string_view text, const std::string& name, const std::string& units);

/// Units of one kind each, in metres, seconds and radians.
struct Units {
  std::optional<double> length_m, time_s, angle_rad;
};
/// Throws std::invalid_argument for words that are no units.
Units ParseUnits(const std::string& text);
/// The unit in metres, seconds or radians where `quantity` may have it.
std::optional<double> UnitFor(std::string_view quantity, std::string_view unit);

/// Roll, pitch and yaw of a quaternion that need not have length 1. Throws std::invalid_argument
/// for one of zero length.
void SetAngles(StampedPose& pose, double qx, double qy, double qz, double qw,
               const std::string& where);

}  // namespace rift::trajectory
