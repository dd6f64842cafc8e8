#pragma once

#include <optional>
#include <string>

#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/tracking/tag_options.hpp"

namespace rift::vision {

/// Sides shorter than this are not measured: a cell has two pixels (see FitSquare).
constexpr double LeastSide_px(TagFamily family) { return 2.0 * ShapeOf(family).square; }
/// From here on a pose is good to the errors that docs/concepts.md states.
inline constexpr double kGoodSide_px = 20.0;

/// The shortest side, in pixels, of the tag that lies at `p_in_world` (its middle, metres) and
/// looks away from the camera, which is how it looks smallest; the lens left out. Needs a world
/// frame; none behind the camera.
std::optional<double> ShortSide_px(const CameraModel& camera, double size_m,
                                   const Eigen::Vector3d& p_in_world);

/// The same in the middle of the picture. None without a world frame.
std::optional<double> ShortSideInMiddle_px(const CameraModel& camera, const TagOptions& options);

/// At every how many pixels AprilTag may look for the tag: its short side in the middle of the
/// picture keeps `search_px` of them, at most `acquire_decimate`.
int DecimateFor(const CameraModel& camera, const TagOptions& options);

/// One line when the tag is smaller than kGoodSide_px in the middle of the picture: what is to be
/// expected and what to do. None without a world frame.
std::optional<std::string> SmallTagWarning(const CameraModel& camera, const TagOptions& options);

}  // namespace rift::vision
