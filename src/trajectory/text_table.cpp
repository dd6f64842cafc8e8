#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "columns.hpp"
#include "rift/trajectory/csv.hpp"

namespace rift::trajectory {
namespace {

bool IsBlankOrComment(std::string_view line) {
  return csv::IsBlankLine(line) || csv::IsComment(line);
}

/// `-0,25` where commas do not separate cells.
bool HasDecimalComma(std::string_view cell) {
  const size_t comma = cell.find(',');
  if (comma == 0 || comma + 1 >= cell.size()) return false;
  const bool is_between_digits = std::isdigit(static_cast<unsigned char>(cell[comma - 1])) != 0 &&
                                 std::isdigit(static_cast<unsigned char>(cell[comma + 1])) != 0;
  std::string with_point(cell);
  with_point[comma] = '.';
  return is_between_digits && cell.find('.') == cell.npos && csv::NumberOf(with_point).has_value();
}

/// Between semicolons each cell with a comma is a number, and there is one.
bool ArePartedBySemicolons(std::string_view line) {
  if (line.find(';') == line.npos || line.find(',') == line.npos) return false;
  const std::vector<std::string> cells = csv::SplitHeader(line, ';');
  return std::all_of(cells.begin(), cells.end(), [](const std::string& cell) {
    return cell.find(',') == cell.npos || HasDecimalComma(cell);
  });
}

/// What stands between the cells of a line.
char SeparatorOf(std::string_view line) {
  if (ArePartedBySemicolons(line)) return ';';
  char most = ' ';
  std::ptrdiff_t count = 0;
  for (const char separator : {',', ';', '\t'}) {
    const std::ptrdiff_t found = std::count(line.begin(), line.end(), separator);
    if (found > count) most = separator;
    count = std::max(count, found);
  }
  return most;
}

/// Tabs part the cells of the first line: whether they do so in the first row below it, where a
/// name may hold blanks and a cell be empty, or any run of blanks does.
bool ArePartedByTabs(std::string_view line, std::string_view rest) {
  std::string_view row;
  while (!rest.empty() && IsBlankOrComment(row)) row = csv::TakeLine(rest);
  return IsBlankOrComment(row) ||
         csv::SplitHeader(row, '\t').size() == csv::SplitHeader(line, '\t').size();
}

/// `0,25` where commas do not separate cells.
std::string WithPoint(std::string cell, char separator) {
  if (separator != ';' || std::count(cell.begin(), cell.end(), ',') != 1) return cell;
  if (cell.find('.') == cell.npos) cell[cell.find(',')] = '.';
  return cell;
}

bool AreNumbers(const std::vector<std::string>& cells, char separator) {
  return std::all_of(cells.begin(), cells.end(), [&](const std::string& cell) {
    return csv::NumberOf(WithPoint(cell, separator)).has_value();
  });
}

/// Those of these columns, of which one at least is not empty.
bool AreNumbersIn(const std::vector<size_t>& columns, const std::vector<std::string>& cells,
                  char separator) {
  std::vector<std::string> chosen;
  for (const size_t column : columns) {
    if (column >= cells.size()) return false;
    chosen.push_back(cells[column]);
  }
  const auto is_empty = [](const std::string& cell) { return cell.empty(); };
  return !std::all_of(chosen.begin(), chosen.end(), is_empty) && AreNumbers(chosen, separator);
}

}  // namespace

bool TextTable::NextLine(std::string_view& line) {
  while (!rest_.empty()) {
    line = csv::TakeLine(rest_);
    ++line_number_;
    if (!csv::IsBlankLine(line)) return true;
  }
  return false;
}

TextTable::TextTable(std::string_view text, const std::string& name,
                     const std::vector<size_t>& number_columns)
    : rest_(csv::WithoutMark(text)), name_(name) {
  std::string_view line;
  std::vector<std::string> comment;
  while (true) {
    const std::string_view before = rest_;
    const int line_before = line_number_;
    if (!NextLine(line)) return;
    if (csv::IsComment(line)) {  // the last one may name the columns
      line.remove_prefix(std::min(line.find_first_not_of("# \t"), line.size()));
      comment = csv::SplitHeader(line, SeparatorOf(line));
      continue;
    }
    separator_ = SeparatorOf(line);
    if (separator_ == '\t' && !ArePartedByTabs(line, rest_)) separator_ = ' ';
    columns_ = csv::SplitHeader(line, separator_);
    first_line_ = line_number_;
    if (AreNumbers(columns_, separator_) || AreNumbersIn(number_columns, columns_, separator_)) {
      const bool is_named = comment.size() == columns_.size();
      for (size_t i = 0; i < columns_.size(); ++i) {
        columns_[i] = is_named ? comment[i] : fmt::format("{}", i + 1);
      }
      rest_ = before;  // it is a row
      line_number_ = line_before;
    }
    csv::RefuseRepeatedColumns(columns_, fmt::format("{}:{}", name_, first_line_));
    return;
  }
}

bool TextTable::Next() {
  std::string_view line;
  while (NextLine(line)) {
    if (csv::IsComment(line)) continue;
    cells_ = csv::SplitHeader(line, separator_);
    if (cells_.size() == columns_.size()) return true;
    throw std::invalid_argument(fmt::format("{}:{}: the row has {} cells where {} are expected",
                                            name_, line_number_, cells_.size(), columns_.size()));
  }
  return false;
}

std::optional<double> TextTable::Number(size_t column) const {
  return csv::NumberOf(WithPoint(cells_[column], separator_));
}

}  // namespace rift::trajectory
