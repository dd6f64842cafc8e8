#pragma once

#include "arc_path.hpp"

namespace rift::gap {

/// The largest error along the path and where it stands.
struct Peak {
  double error_m = -1.0;
  double u = 0.0;
};

/// The first of the samples that count: skip_start leaves out those before it.
int FirstSample(const GapOptions& options);

/// The u of sample k, in [0, 1].
double SampleU(int k, const GapOptions& options);

/// Equation (3.1) of the paper: the largest distance over the samples, the sim path moved first by
/// `real_from_sim`.
template <int N>
Peak SampledPeak(const ArcPathIn<N>& sim, const ArcPathIn<N>& real, const GapOptions& options,
                 const PoseIn<N>& real_from_sim = {});

/// The supremum over the polylines from the first sample on.
template <int N>
Peak ExactPeak(const ArcPathIn<N>& sim, const ArcPathIn<N>& real, const GapOptions& options);

}  // namespace rift::gap
