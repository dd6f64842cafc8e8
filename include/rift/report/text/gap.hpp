#pragma once

#include <string>

#include "rift/gap/result.hpp"

namespace rift::report {

/// Definition, a table with a row for each trial, mean gap, noise floor, what the gap consists of,
/// verdict and likeness.
std::string GapText(const gap::GapResult& result);

}  // namespace rift::report
