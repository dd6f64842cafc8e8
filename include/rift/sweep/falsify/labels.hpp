#pragma once

#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// The two sides of figures 7, 8, 10 and 13: the first categorical parameter (else the first)
/// and the combination of all others.
struct FactorSplit {
  int main_factor = 0;
  std::vector<int> others;  ///< indices of the other parameters; empty for one axis
  std::string others_name;  ///< "[v_min, v_max]"
};

/// Throws std::invalid_argument for a space without parameters.
FactorSplit SplitFactors(const std::vector<experiment::Parameter>& parameters);

/// The value for people: one drawn from a range has 17 digits, which nobody reads; table.csv has
/// them.
std::string ShortText(const experiment::Parameter& parameter,
                      const experiment::ParameterValue& value);

/// "surface parchment, v_min 0.15", by the parameters' last names and for people as well.
std::string SettingText(const std::vector<experiment::Parameter>& parameters,
                        const experiment::Theta& theta);

/// "0.15" for one parameter, "[0.15, 0.30]" for several.
std::string CombinationLabel(const experiment::Theta& theta, const std::vector<int>& parameters);

/// The value of the main factor; empty in a space without parameters.
std::string MainLevel(const std::vector<experiment::Parameter>& parameters,
                      const experiment::Theta& theta);

/// A text that is the same for two settings only when all their values are written the same.
std::string SettingKey(const experiment::Theta& theta);

/// Rows grouped by the combination of the named parameters' values, in the order of first rows.
std::vector<LevelSummary> SummariseBy(const SweepResult& result,
                                      const std::vector<int>& parameters);

}  // namespace rift::sweep
