#pragma once

#include <map>
#include <string>

#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// One row a trial: a column for each parameter by its last name, then trial, gap_m, falsified,
/// status and further evidence; cells of what could not be computed are empty.
std::string TableCsv(const sweep::SweepResult& result);

/// Cells of one row of a table.csv by the names of their columns.
using TableRow = std::map<std::string, std::string>;

/// The first row of such a table.
TableRow FirstTableRow(const std::string& table_csv);

/// The row with this `id`. Throws std::invalid_argument, naming the table and the ids there are,
/// when there is none.
TableRow TableRowOf(const std::string& table_csv, const std::string& id, const std::string& name);

}  // namespace rift::report
