#include "rift/sweep/falsify/uncrossed_note.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace rift::sweep {

std::optional<std::string> UncrossedNote(const SimulatedTrial& trial) {
  if (!trial.image) return std::nullopt;
  constexpr double kStep_m = 0.002;
  const simulation::SurfaceOptions& surface = trial.simulation.terrain.Chosen();
  const Eigen::Vector2d centre_m(surface.image_x_m, surface.image_y_m);
  const Eigen::Vector2d half_m =
      0.5 * surface.image_width_m *
      Eigen::Vector2d(1.0, (trial.image->rows - 1.0) / (trial.image->columns - 1.0));
  const std::vector<control::TimedPose> path = trial.task.IdealPath();
  for (size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector2d from_m = path[i - 1].world_from_robot.Position();
    const Eigen::Vector2d way_m = path[i].world_from_robot.Position() - from_m;
    const long steps = std::max(1L, std::lround(std::ceil(way_m.norm() / kStep_m)));
    for (long k = 0; k <= steps; ++k) {
      const Eigen::Vector2d off_m =
          (from_m + static_cast<double>(k) / static_cast<double>(steps) * way_m - centre_m)
              .cwiseAbs();
      if (off_m.x() <= half_m.x() && off_m.y() <= half_m.y()) return std::nullopt;
    }
  }
  const Eigen::Vector2d low_m = centre_m - half_m, high_m = centre_m + half_m;
  return fmt::format(
      "note: the path of the task crosses {} nowhere, which covers x from {:g} to {:g} m and "
      "y from {:g} to {:g} m (image_width_m, image_x_m, image_y_m): the robot drives on the floor "
      "beside it",
      surface.image, low_m.x(), high_m.x(), low_m.y(), high_m.y());
}

}  // namespace rift::sweep
