#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
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
/// line has most of; with semicolons a number may have a decimal comma, and where each comma of the
/// first line is one, its semicolons part the cells.
class TextTable {
 public:
  /// The first line is a row also where the cells of `number_columns` (from 0), if any are given,
  /// are numbers. Throws std::invalid_argument `name:line: ...` for two columns of one name.
  TextTable(std::string_view text, const std::string& name,
            const std::vector<size_t>& number_columns = {});

  const std::vector<std::string>& Columns() const { return columns_; }
  /// Goes on to the next row that is neither blank nor a comment; false after the last. Throws
  /// std::invalid_argument for a row with another number of cells than the header has.
  bool Next();
  /// NaN for an empty cell; nothing for one that is no finite number.
  std::optional<double> Number(size_t column) const;
  const std::string& Cell(size_t column) const { return cells_[column]; }
  /// 1-based line of the row.
  int Line() const { return line_number_; }
  /// 1-based line of the header, or of the first row where there is none.
  int FirstLine() const { return first_line_; }

 private:
  bool NextLine(std::string_view& line);

  std::string_view rest_;
  const std::string& name_;
  char separator_ = ',';
  std::vector<std::string> columns_;
  std::vector<std::string> cells_;
  int line_number_ = 0;
  int first_line_ = 1;
};

/// Reads a log by ReadOptions::columns and units. Rows that say that they were not tracked are left
/// out, and rows of several robots refused, as in the dialects. Throws std::invalid_argument
/// `name:line: ...`.
LogRows ReadColumns(std::string_view text, const std::string& name, const ReadOptions& options);

struct ColumnGuess {
  std::string columns;  ///< as ReadOptions::columns; empty when time or position are not found
  std::string unclear;  ///< then: which columns may be the position, to be appended to a message
};

/// What the columns of a log may be: told from their names and the direction of travel, and those
/// without names from their ranges too. Of a position that several columns may be none is taken.
/// A unit in a column's name is believed, `units` are of the others, and what neither says is
/// guessed.
ColumnGuess GuessColumns(std::string_view text, const std::string& name, const std::string& units);

/// "t" -> "time", "yaw" -> "theta:deg".
using Sources = std::vector<std::pair<std::string, std::string>>;
/// Throws std::invalid_argument `columns: ...` for what breaks a rule of ReadOptions::columns.
Sources ParseColumns(const std::string& text);

/// What stands between separators, without the blanks around it.
std::vector<std::string> TrimmedParts(std::string_view text, char separator);

/// Units of one kind each, in metres, seconds and radians.
struct Units {
  std::optional<double> length_m, time_s, angle_rad;
};
/// Throws std::invalid_argument for words that are no units.
Units ParseUnits(const std::string& text);
/// The unit in metres, seconds or radians where `quantity` may have it.
std::optional<double> UnitFor(std::string_view quantity, std::string_view unit);
/// What a column of `quantity` is in that names no unit of its own.
double StandardUnit(std::string_view quantity, const Units& units);

/// Roll, pitch and yaw of a quaternion that need not have length 1. Throws std::invalid_argument
/// for one of zero length.
void SetAngles(StampedPose& pose, double qx, double qy, double qz, double qw,
               const std::string& where);

}  // namespace rift::trajectory
