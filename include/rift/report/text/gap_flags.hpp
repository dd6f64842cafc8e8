#pragma once

#include <string>

#include "rift/experiment/experiment.hpp"

namespace rift::report {

/// The flags of `rift gap` with which the two logs of a row of a sweep come out as in its table;
/// empty where a row does not compare two logs.
std::string GapFlags(const experiment::Experiment& experiment);

}  // namespace rift::report
