#pragma once

#include <string>

#include "rift/sweep/falsify/result.hpp"

namespace rift::commands {

/// One row a trial: a column for each parameter by its last name, then trial, gap_m, falsified,
/// status and further evidence; cells of what could not be computed are empty.
std::string TableCsv(const sweep::SweepResult& result);

/// {mean_gap_m, failures, n, not_ok, "by": {parameter: {value: the same}}, effects, settings, ...}
std::string SummaryJson(const sweep::SweepResult& result);

/// What a person wants to know first, for the terminal.
std::string SweepText(const sweep::SweepResult& result);

}  // namespace rift::commands
