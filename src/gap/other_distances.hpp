#pragma once

#include "arc_path.hpp"

namespace rift::gap {

/// Largest distance from a vertex of either polyline to the closest point of the other.
template <int N>
double HausdorffIn_m(const PointsIn<N>& a, const PointsIn<N>& b);

/// Discrete Frechet distance (Eiter and Mannila 1994).
template <int N>
double DiscreteFrechetIn_m(const PointsIn<N>& a, const PointsIn<N>& b);

/// Mean distance along the warping path of least total distance (Sakoe and Chiba 1978).
template <int N>
double DynamicTimeWarpingIn_m(const PointsIn<N>& a, const PointsIn<N>& b);

/// Largest distance at equal time since each first vertex, over the time both last. Both paths
/// hold their times.
template <int N>
double EqualTime_m(const ArcPathIn<N>& a, const ArcPathIn<N>& b);

/// In the plane.
inline double Hausdorff_m(const Points& a, const Points& b) { return HausdorffIn_m<2>(a, b); }
inline double DiscreteFrechet_m(const Points& a, const Points& b) {
  return DiscreteFrechetIn_m<2>(a, b);
}
inline double DynamicTimeWarping_m(const Points& a, const Points& b) {
  return DynamicTimeWarpingIn_m<2>(a, b);
}

}  // namespace rift::gap
