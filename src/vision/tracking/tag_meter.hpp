#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "edge_fit.hpp"
#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/tracking/tag_detector.hpp"
#include "rift/vision/tracking/tag_options.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"

namespace rift::vision {

/// Measures one tag where it was guessed to be: edges, bits, pose. Knows nothing of time.
class TagMeter {
 public:
  TagMeter(const CameraModel& camera, const TagOptions& options);

  /// The tag of `cells` near the guess, which is good to half a cell. Without a world frame,
  /// `normal_in_camera` tells which of the two planar poses is likelier. The sighting lacks what is
  /// not of the picture: index, times, state, the number of tags.
  TrackResult Measure(const GreyPatch& patch, const TagCorners& guess, const TagCells& cells,
                      TrackMode mode, const std::optional<Eigen::Vector3d>& normal_in_camera) const;

 private:
  TrackResult Believe(const FittedSquare& square, const ReadBits& bits, TrackMode mode,
                      const std::optional<Eigen::Vector3d>& normal_in_camera) const;
  /// The pose on the floor, or the free one where the tag is not there.
  TagPose Choose(const TagPoses& poses, const FittedSquare& square,
                 const Eigen::Vector3d& up_in_camera, bool& is_on_floor) const;

  CameraModel camera_;
  TagOptions options_;
  Eigen::Isometry3d map_from_camera_;
  std::optional<FloorPrior> floor_;
};

}  // namespace rift::vision
