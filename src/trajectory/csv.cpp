#include "rift/trajectory/csv.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <unordered_set>
#include <utility>

#include "rift/limits/limits.hpp"

namespace rift::trajectory::csv {
namespace {

bool IsBlank(char c) { return c == ' ' || c == '\t'; }

/// A tab that stands between cells is no blank around one.
std::string_view Trim(std::string_view cell, char separator = ' ') {
  const auto is_around = [separator](char c) {
    return IsBlank(c) && !(c == '\t' && separator == '\t');
  };
  while (!cell.empty() && is_around(cell.front())) cell.remove_prefix(1);
  while (!cell.empty() && is_around(cell.back())) cell.remove_suffix(1);
  return cell;
}

size_t CellEnd(std::string_view line, char separator) {
  return std::min(separator == ' ' ? line.find_first_of(" \t") : line.find(separator), line.size());
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

/// Takes the next cell off the line; false when it was the last.
bool TakeCell(std::string_view& line, char separator, std::string& cell) {
  line = Trim(line, separator);
  cell = line.starts_with('"') ? TakeQuoted(line) : "";
  const size_t end = CellEnd(line, separator);
  cell += Trim(line.substr(0, end), separator);
  const bool is_last = end == line.size();
  line.remove_prefix(is_last ? end : end + 1);
  return !is_last;
}

size_t CellsOf(std::string_view line) {
  size_t cells = 1;
  std::string cell;
  while (TakeCell(line, ',', cell)) ++cells;
  return cells;
}

/// By whichever separator the line has most of; a run of blanks is one.
size_t MostCellsOf(std::string_view line) {
  std::array<size_t, 4> found{};
  char before = ' ';
  for (const char c : line) {
    const size_t kind = std::string_view(",;\t ").find(c);
    if (kind != std::string_view::npos) found[kind] += c != ' ' || before != ' ';
    before = c;
  }
  return 1 + *std::max_element(found.begin(), found.end());
}

/// A number may begin with a plus, which std::from_chars does not know.
std::string_view WithoutPlus(std::string_view cell) {
  const bool plus = cell.size() > 1 && cell[0] == '+' && cell[1] != '-' && cell[1] != '+';
  return plus ? cell.substr(1) : cell;
}

/// The last row where it has no line end; empty where it has, and where it is the only line.
std::string_view UnendedRow(std::string_view text) {
  const size_t begin = text.rfind('\n') + 1;
  const std::string_view last = text.substr(begin);
  return begin == 0 || last.find_first_not_of(" \t\r") == last.npos ? "" : last;
}

}  // namespace

std::string_view WithoutTornRow(std::string_view text) {
  const std::string_view last = UnendedRow(text);
  if (last.empty()) return text;
  const size_t header = text.find_first_not_of("\r\n");
  const std::string_view columns = text.substr(header, text.find('\n', header) - header);
  const auto cells = static_cast<size_t>(std::count(last.begin(), last.end(), ',')) + 1;
  const bool lacks_cells = cells < CellsOf(columns);
  const bool is_torn =
      lacks_cells || std::string_view("+-.eE").find(last.back()) != std::string_view::npos;
  return is_torn ? text.substr(0, text.size() - last.size()) : text;
}

std::optional<std::string> NoteOfEnd(std::string_view text) {
  if (UnendedRow(text).empty()) return std::nullopt;
  return WithoutTornRow(text).size() < text.size()
             ? "the last row was cut short while it was written: it is left out"
             : "the last row has no line end: its last number may be cut";
}

std::string Cell(std::string_view text, std::string_view special) {
  std::string cell(text);
  if (text.find_first_of(special) == text.npos) return cell;
  for (size_t at = 0; (at = cell.find('"', at)) != cell.npos; at += 2) cell.insert(at, 1, '"');
  return '"' + cell + '"';
}

void RequireTaken(std::string_view text, const std::string& name) {
  using limits::Amount;
  const auto lines = static_cast<double>(std::count(text.begin(), text.end(), '\n') + 1);
  limits::Require(Amount::kRows, lines, name);
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = TakeLine(text);
    if (static_cast<double>(line.size()) < limits::Most(Amount::kColumns)) continue;  // fewer cells
    limits::Require(Amount::kColumns, static_cast<double>(MostCellsOf(line)),
                    fmt::format("{}:{}", name, number));
  }
}

void RefuseRepeatedColumns(const std::vector<std::string>& columns, const std::string& where) {
  std::unordered_set<std::string_view> seen;
  for (const std::string& column : columns) {
    if (column.empty() || seen.insert(column).second) continue;
    throw std::invalid_argument(fmt::format(
        "{}: the header has two columns '{}': rename or remove one of them", where, Shown(column)));
  }
}

std::string_view WithoutMark(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

std::string_view TakeLine(std::string_view& rest) {
  const size_t end = std::min(rest.find('\n'), rest.size());
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  while (line.ends_with('\r')) line.remove_suffix(1);  // some make CRLF of CRLF
  return line;
}

bool IsBlankLine(std::string_view line) { return line.find_first_not_of(" \t") == line.npos; }

bool IsComment(std::string_view line) { return Trim(line).starts_with('#'); }

bool IsNoText(char c) {
  return static_cast<unsigned char>(c) < 0x20 &&
         std::string_view("\t\n\r\v\f\a\x1b").find(c) == std::string_view::npos;
}

std::string Shown(std::string_view text, size_t most) {
  std::string shown;
  for (const char c : text.substr(0, most)) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_visible = byte >= 0x20 && byte != 0x7F && byte < 0xF8;
    shown += is_visible ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
  }
  return shown;
}

std::vector<std::string> SplitHeader(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  while (TakeCell(line, separator, cells.back())) cells.emplace_back();
  return cells;
}

std::optional<double> NumberOf(std::string_view cell) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::string_view digits = WithoutPlus(cell);
  const char* const digits_end = digits.data() + digits.size();
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits_end, value);
  const bool is_number = error == std::errc{} && end == digits_end;
  if (!is_number || !std::isfinite(value)) return std::nullopt;
  return value;
}

RowReader::RowReader(std::string_view text, const std::string& name, bool has_header,
                     char separator)
    : rest_(WithoutMark(text)), name_(name), has_header_(has_header), separator_(separator) {
  RequireTaken(rest_, name_);
  if (has_header_) ReadHeader();
}

void RowReader::ReadHeader() {
  while (columns_.empty() && !rest_.empty()) {
    ++line_number_;
    const std::string_view line = TakeLine(rest_);
    if (IsSkipped(line)) continue;
    columns_ = SplitHeader(line);
    RefuseRepeatedColumns(columns_, fmt::format("{}:{}", name_, line_number_));
    cells_.resize(columns_.size());
  }
}

void RowReader::Advise(std::vector<size_t> columns, std::string what) {
  advised_columns_ = std::move(columns);
  advice_ = std::move(what);
}

bool RowReader::Next() {
  while (!rest_.empty()) {
    ++line_number_;
    const std::string_view line = TakeLine(rest_);
    if (IsSkipped(line)) continue;
    ReadCells(line);
    return true;
  }
  return false;
}

bool RowReader::IsSkipped(std::string_view line) const {
  const std::string_view trimmed = Trim(line);
  return trimmed.empty() || (!has_header_ && trimmed.starts_with('#'));
}

void RowReader::ReadCells(std::string_view line) {
  const size_t width = cells_.size();
  cells_.clear();
  if (IsBlank(separator_)) line = Trim(line);
  for (bool more = true; more;) {
    double value = 0.0;
    const auto [stop, error] =
        fast_float::from_chars(line.data(), line.data() + line.size(), value);
    auto end = static_cast<size_t>(stop - line.data());
    const bool ends_here = end == line.size() || line[end] == separator_;
    // Nearly every cell is a number alone. fast_float tells an underflow to zero in another way.
    if (!ends_here || error != std::errc{} || !std::isfinite(value) || value == 0.0) {
      end = CellEnd(line, separator_);
      value = Number(Trim(line.substr(0, end)), cells_.size());
    }
    cells_.push_back(value);
    more = end < line.size();
    line.remove_prefix(end + more);
    if (IsBlank(separator_)) line = Trim(line);
  }
  if (width != 0 && cells_.size() != width) {
    throw std::invalid_argument(fmt::format("{}:{}: the row has {} cells where {} are expected",
                                            name_, line_number_, cells_.size(), width));
  }
}

double RowReader::Number(std::string_view cell, size_t column) const {
  const std::optional<double> value = NumberOf(cell);
  if (!value) Refuse(cell, column);
  return *value;
}

void RowReader::Refuse(std::string_view cell, size_t column) const {
  const std::string where =
      column < columns_.size() ? columns_[column] : fmt::format("{}", column + 1);
  const bool is_advised =
      std::find(advised_columns_.begin(), advised_columns_.end(), column) != advised_columns_.end();
  throw std::invalid_argument(fmt::format("{}:{}: column {} is '{}': a finite number is expected{}",
                                          name_, line_number_, Shown(where), Shown(cell),
                                          is_advised ? advice_ : ""));
}

}  // namespace rift::trajectory::csv
