#include "documented.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tree.hpp"

namespace rift::test {
namespace {

/// Cells of `| a | b |`, without the blanks around them; none for other lines.
std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells;
  if (!line.starts_with("| ")) return cells;
  std::istringstream rest(line.substr(1));
  for (std::string cell; std::getline(rest, cell, '|');) {
    const size_t begin = cell.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    cells.push_back(cell.substr(begin, cell.find_last_not_of(' ') - begin + 1));
  }
  return cells;
}

std::string Unquoted(const std::string& cell) {
  const bool quoted = cell.size() > 2 && cell.front() == '`' && cell.back() == '`';
  return quoted ? cell.substr(1, cell.size() - 2) : "";
}

std::ifstream OpenDocument(const std::string& file) {
  std::ifstream stream(SourceDir() + "/docs/" + file);
  if (!stream) throw std::runtime_error("no docs/" + file);
  return stream;
}

}  // namespace

std::vector<std::string> Documented(const std::string& file, const std::string& heading) {
  std::ifstream stream = OpenDocument(file);
  std::vector<std::string> names;
  bool is_here = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("## ")) is_here = line == "## " + heading;
    const std::vector<std::string> cells = CellsOf(line);
    if (is_here && !cells.empty() && !Unquoted(cells[0]).empty()) {
      names.push_back(Unquoted(cells[0]));
    }
  }
  if (names.empty()) throw std::runtime_error("docs/" + file + " has no table below " + heading);
  return names;
}

std::set<std::string> DocumentedKeys(const std::string& heading) {
  const std::vector<std::string> names = Documented("json.md", heading);
  return {names.begin(), names.end()};
}

std::vector<std::string> Columns(const std::string& csv) {
  std::vector<std::string> columns;
  std::istringstream header(csv.substr(0, csv.find('\n')));
  for (std::string column; std::getline(header, column, ',');) columns.push_back(column);
  return columns;
}

std::vector<DocumentedRoom> DocumentedRooms() {
  std::ifstream stream = OpenDocument("rooms.md");
  std::vector<DocumentedRoom> rooms;
  for (std::string line; std::getline(stream, line);) {
    const std::vector<std::string> cells = CellsOf(line);
    if (cells.size() == 3 && !Unquoted(cells[0]).empty()) {
      rooms.push_back({Unquoted(cells[0]), cells[2]});
    }
  }
  return rooms;
}

}  // namespace rift::test
