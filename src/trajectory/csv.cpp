#include "csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <system_error>

#include "number.hpp"

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
    throw std::invalid_argument(
        fmt::format("{}: the header has two columns '{}': rename or remove one of them", where,
                    Shown(*column)));
  }
}

}  // namespace

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

std::string Shown(std::string_view text) {
  constexpr size_t kMost = 60;
  std::string shown;
  for (const char c : text.substr(0, kMost)) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_visible = byte >= 0x20 && byte != 0x7F && byte < 0xF8;
    shown += is_visible ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
  }
  return shown;
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

ShortText::ShortText(const char* begin, size_t size, const char* end) {
  if (size > sizeof(bytes_) || static_cast<size_t>(end - begin) < sizeof(bytes_)) return;
  size_ = size;
  // A look at these from `size` before their middle on keeps the first `size` bytes of a word.
  constexpr std::array<unsigned char, 16> kMask{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
  std::memcpy(&mask_, kMask.data() + kMask.size() / 2 - size, sizeof(mask_));
  std::memcpy(&bytes_, begin, sizeof(bytes_));
  bytes_ &= mask_;
}

bool ShortText::IsAt(const char* at, const char* end) const {
  std::uint64_t bytes = 0;
  if (size_ == 0 || static_cast<size_t>(end - at) < sizeof(bytes)) return false;
  std::memcpy(&bytes, at, sizeof(bytes));
  return (bytes & mask_) == bytes_;
}

RowReader::RowReader(std::string_view head, const TextPieces& pieces, const std::string& name,
                     bool has_header, char separator)
    : rest_(WithoutMark(head)),
      pieces_(pieces),
      seen_bytes_(head.size()),
      name_(name),
      has_header_(has_header),
      separator_(separator) {
  if (has_header_) ReadHeader();
}

bool RowReader::HasMore() {
  if (!rest_.empty()) return true;
  rest_ = pieces_.next();
  seen_bytes_ += rest_.size();
  return !rest_.empty();
}

void RowReader::ReadHeader() {
  while (columns_.empty() && HasMore()) {
    ++line_number_;
    const std::string_view line = TakeLine(rest_);
    if (IsSkipped(line)) continue;
    columns_ = SplitHeader(line);
    RefuseRepeatedColumns(columns_, fmt::format("{}:{}", name_, line_number_));
    cells_.resize(columns_.size());
  }
}

bool RowReader::Next() {
  while (HasMore()) {
    ++line_number_;
    const size_t before = rest_.size();
    if (!TakePlain()) {
      const std::string_view line = TakeLine(rest_);
      if (IsSkipped(line)) continue;
      ReadAny(line);
    }
    line_size_ = before - rest_.size();
    return true;
  }
  return false;
}

size_t RowReader::RowsToExpect() const {
  const size_t unseen = std::max(pieces_.size_bytes, seen_bytes_) - seen_bytes_;
  return 2 + (rest_.size() + unseen) * 6 / (5 * line_size_);
}

bool RowReader::IsSkipped(std::string_view line) const {
  const std::string_view trimmed = Trim(line);
  return trimmed.empty() || (!has_header_ && trimmed.starts_with('#'));
}

/// Takes off the row of a large log, numbers and commas only, in one go. False for any other, which
/// is left where it is. A cell that repeats the one above it, such as the waypoint of hundreds of
/// rows, is not read again.
bool RowReader::TakePlain() {
  if (separator_ != ',' || cells_.empty()) return false;
  above_.resize(cells_.size());
  const char *at = rest_.data(), *const end = at + rest_.size();
  for (size_t i = 0; i < cells_.size(); ++i) {
    const bool is_last = i + 1 == cells_.size();
    if (above_[i].IsAt(at, end)) {
      at += above_[i].Size();
      continue;
    }
    const char* const begin = at;
    const auto [stop, error] = FromChars(begin, end, cells_[i]);
    if (error != std::errc{} || !std::isfinite(cells_[i])) return false;
    at = stop + (is_last && stop != end && *stop == '\r');
    if (at == end ? !is_last : *at != (is_last ? '\n' : ',')) return false;
    at += at != end;
    above_[i] = ShortText(begin, static_cast<size_t>(at - begin), end);
  }
  rest_.remove_prefix(at - rest_.data());
  return true;
}

void RowReader::ReadAny(std::string_view line) {
  const size_t width = cells_.size();
  cells_.clear();
  above_.clear();
  bool more = true;
  while (more) {
    const bool ends_here = IsBlank(separator_) ? false : line.find(separator_) == line.npos;
    const std::string_view cell = TakeCell(line, separator_);
    if (IsBlank(separator_) && cell.empty()) break;
    cells_.push_back(Number(cell, cells_.size()));
    more = IsBlank(separator_) ? !line.empty() : !ends_here;
  }
  if (width != 0 && cells_.size() != width) {
    throw std::invalid_argument(fmt::format("{}:{}: the row has {} cells where {} are expected",
                                            name_, line_number_, cells_.size(), width));
  }
}

double RowReader::Number(std::string_view cell, size_t column) const {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::string_view digits = WithoutPlus(cell);
  const char* const digits_end = digits.data() + digits.size();
  double value = 0.0;
  const auto [end, error] = FromChars(digits.data(), digits_end, value);
  const bool is_number = error == std::errc{} && end == digits_end;
  if (!is_number || !std::isfinite(value)) Refuse(cell, column);
  return value;
}

void RowReader::Refuse(std::string_view cell, size_t column) const {
  const std::string where =
      column < columns_.size() ? columns_[column] : fmt::format("{}", column + 1);
  throw std::invalid_argument(fmt::format("{}:{}: column {} is '{}': a finite number is expected",
                                          name_, line_number_, Shown(where), Shown(cell)));
}

}  // namespace rift::trajectory::csv
