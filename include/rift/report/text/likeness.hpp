#pragma once

#include <string>
#include <vector>

#include "rift/gap/likeness.hpp"
#include "rift/sweep/calibrate/sweep_likeness.hpp"

namespace rift::report {

/// A table, a line for each group, with what its columns mean.
std::string LikenessText(const std::vector<sweep::GroupLikeness>& groups);

/// In sentences, without what only a controller's side can tell.
std::string LikenessText(const gap::Likeness& likeness);

}  // namespace rift::report
