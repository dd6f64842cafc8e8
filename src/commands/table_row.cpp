#include "table_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "files.hpp"

namespace rift::commands {
namespace {

/// RFC 4180, as TableCsv writes it. Takes one record off the front of the text.
std::vector<std::string> NextRecord(std::string_view& text) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  size_t at = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    const bool is_double = is_quoted && c == '"' && text.substr(at + 1).starts_with('"');
    if (is_double) {
      cells.back() += '"';
      ++at;
    } else if (c == '"') {
      is_quoted = !is_quoted;
    } else if (c == ',' && !is_quoted) {
      cells.emplace_back();
    } else if (c == '\n' && !is_quoted) {
      break;
    } else {
      cells.back() += c;
    }
  }
  text.remove_prefix(std::min(text.size(), at + 1));
  return cells;
}

TableRow RowOf(const std::vector<std::string>& columns, const std::vector<std::string>& cells) {
  TableRow row;
  for (size_t i = 0; i < std::min(columns.size(), cells.size()); ++i) row[columns[i]] = cells[i];
  return row;
}

}  // namespace

TableRow FirstTableRow(const std::string& table_csv) {
  std::string_view text = table_csv;
  const std::vector<std::string> columns = NextRecord(text);
  return RowOf(columns, NextRecord(text));
}

TableRow ReadTableRow(const std::filesystem::path& table, const std::string& id) {
  const std::string bytes = ReadFile(table);
  std::string_view text = bytes;
  const std::vector<std::string> columns = NextRecord(text);
  size_t rows = 0;
  for (; !text.empty(); ++rows) {
    const std::vector<std::string> cells = NextRecord(text);
    TableRow row = RowOf(columns, cells);
    if (row.contains("id") && row["id"] == id) return row;
  }
  throw std::invalid_argument(
      fmt::format("{} has no row with id {}: its ids are 1 to {}", table.string(), id, rows));
}

}  // namespace rift::commands
