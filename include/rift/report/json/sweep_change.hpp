#pragma once

#include <string>

#include "rift/sweep/explain/sweep_change.hpp"

namespace rift::report {

/// What `rift sweep --compare A B --json` prints.
std::string ChangeJson(const sweep::SweepChange& change);

}  // namespace rift::report
