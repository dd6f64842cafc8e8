#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rift/vision/tracking/tag_detector.hpp"
#include "rift/vision/tracking/world_frame.hpp"

namespace rift::vision {

/// How far each point lies off where all the others put it, metres on its plane, in the order of
/// the points. Of four points, where three that are left put a camera in up to four places, the
/// nearest place counts, so that it is a lower bound.
std::vector<double> LeaveOneOut_m(const CameraModel& camera, const std::vector<WorldPoint>& points);

/// The points when they fit; throws std::invalid_argument, saying which point is wrong or which two
/// are swapped and what to do, when one lies further than `limit_m` off where the others put it,
/// and as RequireFramePoints does. Names are the points'.
void CheckPoints(const CameraModel& camera, const std::vector<WorldPoint>& points, double limit_m);

/// The side of the robot's tag as this world frame measures it at `height_m`, over its printed
/// side: 1 where the frame's metres are metres. None when the tag is not among those seen.
std::optional<double> ScaleByTag(const CameraModel& camera, const std::vector<TagDetection>& seen,
                                 int id, double size_m, double height_m);

/// Throws std::invalid_argument when the scale is off 1 by more than `tolerance`, with the likely
/// reason (centimetres, inches, a tag printed at another size).
void CheckScale(double scale, double size_m, double tolerance);

/// Why the frame that the camera has should not be replaced by `next`, one line without the file's
/// name; none when `next` is as good.
std::optional<std::string> IsWorseThan(const WorldFrame& next, const WorldFrame& present);

/// Why the world frame of a camera is not one of its lens, one line; none when it is, or when no
/// tags set it. Its own reference tags were so far off when it was set as it says, and lie
/// elsewhere when it came from the file of another lens.
std::optional<std::string> WhyNotOfThisLens(const CameraModel& camera);

}  // namespace rift::vision
