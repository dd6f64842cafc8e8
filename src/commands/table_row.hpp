#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace rift::commands {

/// Cells of one row of a table.csv by the names of their columns.
using TableRow = std::map<std::string, std::string>;

/// The first row of such a table.
TableRow FirstTableRow(const std::string& table_csv);

/// The row with this `id`. Throws std::invalid_argument when there is none, naming those there are.
TableRow ReadTableRow(const std::filesystem::path& table, const std::string& id);

}  // namespace rift::commands
