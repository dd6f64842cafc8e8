#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rift::trajectory::csv {

/// Numbers of a text table, row by row; a cell that was empty is NaN, any other is finite.
struct Table {
  std::vector<std::string> columns;  ///< header cells; empty for a table without header
  int width = 0;
  std::vector<double> cells;  ///< row-major, width per row
  std::vector<int> lines;     ///< 1-based line of each row in the file

  size_t Rows() const { return lines.size(); }
  double At(size_t row, int column) const { return cells[row * width + column]; }
  /// Position of the named column, -1 when there is none.
  int Column(std::string_view name) const;
};

/// The text without its byte order mark.
std::string_view WithoutMark(std::string_view text);

/// Takes the next line off `rest`, without its CR LF or LF.
std::string_view TakeLine(std::string_view& rest);

/// Cells between commas, without the blanks or the double quotes around them.
std::vector<std::string> SplitHeader(std::string_view line);

/// Reads numbers separated by `separator` (a blank stands for any run of blanks and tabs). No two
/// columns of a header may share a name.
/// Throws std::invalid_argument `name:line: ...`.
Table ReadNumbers(std::string_view text, const std::string& name, bool has_header, char separator);

}  // namespace rift::trajectory::csv
