#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "rift/statistics/bootstrap_options.hpp"
#include "rift/statistics/inference.hpp"

namespace rift::statistics {

/// A statistic of groups that were drawn: their numbers, as many as there are groups, some of them
/// several times.
using GroupStatistic = std::function<double(std::span<const std::size_t> drawn)>;

/// Expanded percentile interval (Hesterberg 2015, "What teachers should know about the bootstrap")
/// of a statistic over `groups` groups drawn with replacement: what belongs together, such as all
/// trials of a setting, is drawn together. Few groups scatter less than they would with the next
/// ones in place, so the shares that are left out are those of Student's t, not the normal's. Draws
/// of which the statistic is NaN are left out; NaN for fewer than two groups or without a draw that
/// tells.
Interval BootstrapGroups(std::size_t groups, const GroupStatistic& statistic,
                         const BootstrapOptions& options, std::uint64_t seed);

}  // namespace rift::statistics
