#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "support/inputs/trials.hpp"
#include "support/tree.hpp"

namespace rift::test {

/// The cells of each row of a CSV file that a script of `room`'s oracle folder has written, without
/// the names of its columns.
inline std::vector<std::vector<std::string>> OracleRows(const std::string& room,
                                                        const std::string& name) {
  std::istringstream lines(ReadFile(SourceDir() + "/tests/" + room + "/oracle/" + name));
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

}  // namespace rift::test
