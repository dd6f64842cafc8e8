#pragma once

#include "arc_path.hpp"

namespace rift::gap {

/// The translation that lays the first point of `sim` on the first point of `real`.
geometry::Pose2 StartMotion(const ArcPath& sim, const ArcPath& real);

/// The planar rigid motion that brings `sim` closest to `real`: least squares over `samples`
/// evenly spaced u; in the plane the fit of Umeyama 1991, without scale, has this closed form.
geometry::Pose2 BestRigidMotion(const ArcPath& sim, const ArcPath& real, int samples);

/// The same from points that stand at the same u of both.
geometry::Pose2 BestRigidMotion(const std::vector<Eigen::Vector2d>& p_in_sim,
                                const std::vector<Eigen::Vector2d>& p_in_real);

/// The motion an option asks for; identity for Align::kNone.
geometry::Pose2 AligningMotion(const ArcPath& sim, const ArcPath& real, Align align, int samples);

}  // namespace rift::gap
