#include "alignment.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace rift::gap {
namespace {

/// A fit over more points than this moves by less than a micrometre.
constexpr int kMostFitSamples = 2000;

Eigen::Matrix2Xd SampledPoints(const ArcPath& path, int samples) {
  const std::vector<Eigen::Vector2d> points = Resample(path, samples);
  Eigen::Matrix2Xd columns(2, samples);
  for (int i = 0; i < samples; ++i) columns.col(i) = points[i];
  return columns;
}

}  // namespace

geometry::Pose2 StartMotion(const ArcPath& sim, const ArcPath& real) {
  const Eigen::Vector2d offset_m = real.Vertex(0) - sim.Vertex(0);
  return {offset_m.x(), offset_m.y(), 0.0};
}

geometry::Pose2 BestRigidMotion(const ArcPath& sim, const ArcPath& real, int samples) {
  const int count = std::clamp(samples, 2, kMostFitSamples);
  const Eigen::Matrix3d real_from_sim =
      Eigen::umeyama(SampledPoints(sim, count), SampledPoints(real, count), false);
  return {real_from_sim(0, 2), real_from_sim(1, 2),
          std::atan2(real_from_sim(1, 0), real_from_sim(0, 0))};
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
