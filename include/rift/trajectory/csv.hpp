#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rift::trajectory::csv {

/// The text without its byte order mark.
std::string_view WithoutMark(std::string_view text);

/// Takes the next line off `rest`, without its CR LF or LF.
std::string_view TakeLine(std::string_view& rest);

bool IsBlankLine(std::string_view line);

/// Whether the first of a line that is no blank is #.
bool IsComment(std::string_view line);

/// A control character other than blanks, line ends, the bell and what colours a terminal.
bool IsNoText(char c);

/// At most so many bytes of it for a message, those that no terminal shows written as \xNN.
std::string Shown(std::string_view text, size_t most = 60);

/// Cells between separators, without the blanks or the double quotes around them. A blank stands
/// for any run of blanks and tabs.
std::vector<std::string> SplitHeader(std::string_view line, char separator = ',');

/// The text as a cell: where it holds one of `special`, in double quotes, its own ones doubled
/// (RFC 4180).
std::string Cell(std::string_view text, std::string_view special = ",\"\r\n");

/// Throws std::invalid_argument `name: ...` or `name:line: ...` for a table of more rows or columns
/// than are taken (limits::Require), before memory for its cells is.
void RequireTaken(std::string_view text, const std::string& name);

/// The number of a cell; NaN of an empty one, nothing of one that is no finite number.
std::optional<double> NumberOf(std::string_view cell);

/// Throws std::invalid_argument `where: ...` for two columns of one name.
void RefuseRepeatedColumns(const std::vector<std::string>& columns, const std::string& where);

/// A table with commas and a header, each row of which was written with its line end: without a
/// last row that lacks it and cells too, or ends within a number. Its writer was killed, or the
/// disk full.
std::string_view WithoutTornRow(std::string_view text);

/// What to tell of the last row of such a table: left out, or perhaps short of digits; else
/// nothing.
std::optional<std::string> NoteOfEnd(std::string_view text);

/// The numbers of a text table, one row after the other, separated by `separator` (a blank stands
/// for any run of blanks and tabs). No two columns of a header may share a name. Blank lines are
/// skipped, and in a table without header lines that begin with # too. Everything throws
/// std::invalid_argument `name:line: ...`.
class RowReader {
 public:
  /// `text` and `name` must outlive the reader. Throws what RequireTaken does.
  RowReader(std::string_view text, const std::string& name, bool has_header, char separator);

  /// Header cells; empty for a table without header.
  const std::vector<std::string>& Columns() const { return columns_; }

  /// Appends `what` to the refusal of a cell in one of these columns (from 0).
  void Advise(std::vector<size_t> columns, std::string what);

  /// Goes on to the next row; false after the last. Every row has as many cells as the header, or
  /// as the first row has.
  bool Next();
  /// The row as numbers; a cell that was empty is NaN, any other is finite.
  std::span<const double> Cells() const { return cells_; }
  /// 1-based line of the row in the file.
  int Line() const { return line_number_; }

 private:
  void ReadHeader();
  bool IsSkipped(std::string_view line) const;
  void ReadCells(std::string_view line);
  double Number(std::string_view cell, size_t column) const;
  [[noreturn]] void Refuse(std::string_view cell, size_t column) const;

  std::string_view rest_;
  const std::string& name_;
  const bool has_header_;
  const char separator_;
  std::vector<std::string> columns_;
  std::vector<double> cells_;
  std::vector<size_t> advised_columns_;
  std::string advice_;
  int line_number_ = 0;
};

}  // namespace rift::trajectory::csv
