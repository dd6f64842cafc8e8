#include "alignment.hpp"

#include <cmath>

namespace rift::gap {
namespace {

Eigen::Vector2d Centroid(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

geometry::Pose2 StartMotion(const ArcPath& sim, const ArcPath& real) {
  const Eigen::Vector2d offset_m = real.Vertex(0) - sim.Vertex(0);
  return {offset_m.x(), offset_m.y(), 0.0};
}

geometry::Pose2 BestRigidMotion(const ArcPath& sim, const ArcPath& real, int samples) {
  return BestRigidMotion(Resample(sim, samples), Resample(real, samples));
}

geometry::Pose2 BestRigidMotion(const std::vector<Eigen::Vector2d>& p_in_sim,
                                const std::vector<Eigen::Vector2d>& p_in_real) {
  const Eigen::Vector2d sim_centre = Centroid(p_in_sim), real_centre = Centroid(p_in_real);
  double along = 0.0, across = 0.0;
  for (size_t i = 0; i < p_in_sim.size(); ++i) {
    const Eigen::Vector2d a = p_in_sim[i] - sim_centre, b = p_in_real[i] - real_centre;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  const geometry::Pose2 rotation{0.0, 0.0, std::atan2(across, along)};
  const Eigen::Vector2d offset_m = real_centre - rotation * sim_centre;
  return {offset_m.x(), offset_m.y(), rotation.yaw_rad};
}

geometry::Pose2 AligningMotion(const ArcPath& sim, const ArcPath& real, Align align, int samples) {
  switch (align) {
    case Align::kNone:
      return {};
    case Align::kStart:
      return StartMotion(sim, real);
    case Align::kSe2:
      return BestRigidMotion(sim, real, samples);
  }
  return {};
}

}  // namespace rift::gap
