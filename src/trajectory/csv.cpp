#include "csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <system_error>

namespace rift::trajectory::csv {
namespace {

bool IsBlank(char c) { return c == ' ' || c == '\t'; }

std::string_view Trim(std::string_view cell) {
  while (!cell.empty() && IsBlank(cell.front())) cell.remove_prefix(1);
  while (!cell.empty() && IsBlank(cell.back())) cell.remove_suffix(1);
  return cell;
}

std::string_view TakeCell(std::string_view& line, char separator) {
  if (IsBlank(separator)) {
    line = Trim(line);
    const size_t end = std::min(line.find_first_of(" \t"), line.size());
    const std::string_view cell = line.substr(0, end);
    line.remove_prefix(end);
    return cell;
  }
  const size_t end = std::min(line.find(separator), line.size());
  const std::string_view cell = Trim(line.substr(0, end));
  line.remove_prefix(std::min(end + 1, line.size()));
  return cell;
}

/// Takes a cell in double quotes off the line, in which two of them stand for one. A quote that is
/// not closed ends with the line.
std::string TakeQuoted(std::string_view& line) {
  std::string cell;
  line.remove_prefix(1);
  while (!line.empty()) {
    const bool quote = line.front() == '"';
    if (quote && !line.starts_with("\"\"")) break;
    cell += line.front();
    line.remove_prefix(quote ? 2 : 1);
  }
  if (!line.empty()) line.remove_prefix(1);
  return cell;
}

/// A number may begin with a plus, which std::from_chars does not know.
std::string_view WithoutPlus(std::string_view cell) {
  const bool plus = cell.size() > 1 && cell[0] == '+' && cell[1] != '-' && cell[1] != '+';
  return plus ? cell.substr(1) : cell;
}

void RefuseRepeatedColumns(const std::vector<std::string>& columns, const std::string& where) {
  for (auto column = columns.begin(); column != columns.end(); ++column) {
    if (column->empty() || std::find(columns.begin(), column, *column) == column) continue;
    throw std::invalid_argument(fmt::format(
        "{}: the header has two columns '{}': rename or remove one of them", where, *column));
  }
}

/// Cells of one row, appended to the table.
class RowReader {
 public:
  RowReader(Table& table, const std::string& name, char separator)
      : table_(table), name_(name), separator_(separator) {}

  void Read(std::string_view line, int line_number) {
    if (!ReadPlain(line)) ReadAny(line, line_number);
    table_.lines.push_back(line_number);
  }

 private:
  /// The row of a large log, numbers and commas only, straight through. False for any other, of
  /// which nothing is kept.
  bool ReadPlain(std::string_view line) {
    const size_t before = table_.cells.size();
    const char *at = line.data(), *end = line.data() + line.size();
    while (separator_ == ',') {
      double value = 0.0;
      const auto [stop, error] = std::from_chars(at, end, value);
      if (error != std::errc{} || !std::isfinite(value)) break;
      table_.cells.push_back(value);
      if (stop == end && table_.cells.size() - before == static_cast<size_t>(table_.width)) {
        return true;
      }
      if (stop == end || *stop != ',') break;
      at = stop + 1;
    }
    table_.cells.resize(before);
    return false;
  }

  void ReadAny(std::string_view line, int line_number) {
    const size_t before = table_.cells.size();
    bool more = true;
    while (more) {
      const bool ends_here = IsBlank(separator_) ? false : line.find(separator_) == line.npos;
      const std::string_view cell = TakeCell(line, separator_);
      if (IsBlank(separator_) && cell.empty()) break;
      Append(cell, line_number, table_.cells.size() - before);
      more = IsBlank(separator_) ? !line.empty() : !ends_here;
    }
    const size_t found = table_.cells.size() - before;
    if (table_.width == 0) table_.width = static_cast<int>(found);
    if (found != static_cast<size_t>(table_.width)) {
      throw std::invalid_argument(fmt::format("{}:{}: the row has {} cells where {} are expected",
                                              name_, line_number, found, table_.width));
    }
  }

  void Append(std::string_view cell, int line_number, size_t column) {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!cell.empty()) {
      const std::string_view digits = WithoutPlus(cell);
      const char* const digits_end = digits.data() + digits.size();
      const auto [end, error] = std::from_chars(digits.data(), digits_end, value);
      const bool is_number = error == std::errc{} && end == digits_end;
      if (!is_number || !std::isfinite(value)) Refuse(cell, line_number, column);
    }
    table_.cells.push_back(value);
  }

  [[noreturn]] void Refuse(std::string_view cell, int line_number, size_t column) const {
    const std::string where =
        column < table_.columns.size() ? table_.columns[column] : fmt::format("{}", column + 1);
    throw std::invalid_argument(fmt::format("{}:{}: column {} is '{}': a finite number is expected",
                                            name_, line_number, where, cell.substr(0, 40)));
  }

  Table& table_;
  const std::string& name_;
  char separator_;
};

/// Room for the rest, were its rows like the first one, and a fifth more.
void Reserve(Table& table, size_t first_line_size, size_t rest_size) {
  const size_t rows = 2 + rest_size * 6 / (5 * (first_line_size + 1));
  table.cells.reserve(rows * table.width);
  table.lines.reserve(rows);
}

}  // namespace

int Table::Column(std::string_view name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

std::string_view WithoutMark(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

std::string_view TakeLine(std::string_view& rest) {
  const size_t end = std::min(rest.find('\n'), rest.size());
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::vector<std::string> SplitHeader(std::string_view line) {
  std::vector<std::string> cells;
  while (true) {
    line = Trim(line);
    std::string quoted;
    if (line.starts_with('"')) quoted = TakeQuoted(line);
    const bool last = line.find(',') == line.npos;
    cells.push_back(quoted + std::string(TakeCell(line, ',')));
    if (last) return cells;
  }
}

Table ReadNumbers(std::string_view text, const std::string& name, bool has_header, char separator) {
  Table table;
  std::string_view rest = WithoutMark(text);
  RowReader reader(table, name, separator);
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const std::string_view line = TakeLine(rest);
    if (Trim(line).empty() || (!has_header && Trim(line).starts_with('#'))) continue;
    if (has_header && table.columns.empty()) {
      table.columns = SplitHeader(line);
      RefuseRepeatedColumns(table.columns, fmt::format("{}:{}", name, line_number));
      table.width = static_cast<int>(table.columns.size());
      continue;
    }
    reader.Read(line, line_number);
    if (table.Rows() == 1) Reserve(table, line.size(), rest.size());
  }
  return table;
}

}  // namespace rift::trajectory::csv
