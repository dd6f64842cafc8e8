#pragma once

#include "arc_path.hpp"

namespace rift::gap {

/// Largest distance from a vertex of either polyline to the closest point of the other.
double Hausdorff_m(const Points& a, const Points& b);

/// Discrete Frechet distance (Eiter and Mannila 1994).
double DiscreteFrechet_m(const Points& a, const Points& b);

/// Mean distance along the warping path of least total distance (Sakoe and Chiba 1978).
double DynamicTimeWarping_m(const Points& a, const Points& b);

/// Largest distance at equal time since each first vertex, over the time both last. Both paths
/// hold their times.
double EqualTime_m(const ArcPath& a, const ArcPath& b);

}  // namespace rift::gap
