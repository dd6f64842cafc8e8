#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "rift/gap/options.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::sweep {

/// One number of a log by which a simulated log might be told from a real one.
struct DriveFeature {
  std::string_view name;   ///< ends in its unit
  bool is_timing = false;  ///< it looks at time stamps, or at the distance from one row to the next
  std::string_view meaning;
};

/// All features, in the order of FeaturesOf. None knows the frame of the log, its clock or its
/// height, which are conventions and no traits of a robot.
std::span<const DriveFeature> DriveFeatures();

/// The features of one log of a drive to waypoints; NaN where it cannot tell: without yaw, without
/// logged targets, or with a handful of rows. `options` say what counts as moving.
std::vector<double> FeaturesOf(const trajectory::Trajectory& log,
                               const gap::LikenessOptions& options);

}  // namespace rift::sweep
