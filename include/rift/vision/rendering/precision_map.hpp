#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"
#include "rift/vision/tracking/tag_options.hpp"

namespace rift::vision {

/// Where and how often a precision map tries the tag.
struct PrecisionMapOptions {
  int columns = 7;  ///< of places, evenly over the picture
  int rows = 5;
  int views = 16;  ///< of each place, at headings at random
  std::uint64_t seed = 1;
};

/// What tracking makes of the tag at one place of the picture.
struct PrecisionPlace {
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero();
  /// On the plane of the tag, world metres; none where the picture shows no floor.
  std::optional<Eigen::Vector2d> floor_m;
  double side_px = 0.0;  ///< the tag's shortest
  int views = 0;
  int found = 0;                    ///< of the views, within three pictures
  std::vector<double> off_m;        ///< of each view found, on the plane
  std::vector<double> yaw_off_rad;  ///< the same, absolute
  double shift_by_height = 0.0;  ///< metres of the pose for a metre that the tag's height is wrong
  std::optional<double> least_size_m;  ///< the smallest tag that is found here
};

struct PrecisionMap {
  int columns = 0, rows = 0;
  std::vector<PrecisionPlace> places;  ///< row by row from the top left of the picture
  double least_side_px = 0.0;          ///< the shortest side at which every tag tried was found
};

/// Renders the tag all over the picture as this camera would see it and tracks it there, each view
/// from nothing. `look` gives blur, noise and light; its tag is options'. What the calibration
/// itself gets wrong is not in it. The same arguments give the same map. `on_place(done, all)` is
/// called after each place. std::invalid_argument without a world frame.
PrecisionMap PredictPrecision(const CameraModel& camera, const TagOptions& options,
                              SyntheticCameraOptions look, const PrecisionMapOptions& map,
                              const std::function<void(int, int)>& on_place = {});

}  // namespace rift::vision
