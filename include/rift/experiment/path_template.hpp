#pragma once

#include <string>
#include <vector>

#include "rift/experiment/parameter.hpp"

namespace rift::experiment {

/// Names in braces in a path template: "{surface}/vmin{v_min:.2f}_real{trial}.csv" names surface,
/// v_min and trial. Throws std::invalid_argument for a brace without its partner.
std::vector<std::string> TemplateNames(const std::string& path_template);

/// Fills a path template in with the values of the parameters (by their last names) and the trial.
/// Format specifications are those of fmt and Python: `{v_min:.2f}`, `{trial:03d}`.
/// Throws std::invalid_argument for a name that is no parameter or a specification that does not
/// fit the value.
std::string FillTemplate(const std::string& path_template, const std::vector<Parameter>& parameters,
                         const std::vector<ParameterValue>& theta, const std::string& trial);

}  // namespace rift::experiment
