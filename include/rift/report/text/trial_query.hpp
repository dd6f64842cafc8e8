#pragma once

#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// Queries for the trials table: a parameter by its name, a column of the page's own by its title
/// after a dot, which no parameter's name holds.

/// Those above the threshold and those that did not arrive, where that counts as a failure.
std::string FailingTrials();
std::string TrialsWhere(const std::string& parameter, const std::string& value);
std::string TrialsOf(const sweep::SweepResult& result, const experiment::Theta& theta);
/// By their numbers in table.csv; of many, the first hundred.
std::string TrialsNumbered(const std::vector<int>& rows);
std::string Both(const std::string& a, const std::string& b);

}  // namespace rift::report
