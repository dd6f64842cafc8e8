#pragma once

#include "rift/view/film.hpp"

namespace rift::view {

/// The poses whose positions are the trail: those measured, else the true ones.
inline const trajectory::Trajectory& Trail(const Run& run) {
  return run.logged.poses.empty() ? run.truth : run.logged;
}

/// The ground around everything that is shown, and what lies on it.
Stage MakeStage(const Run& run, const ViewOptions& options);

}  // namespace rift::view
