#include "tag_meter.hpp"

#include <algorithm>
#include <cmath>

#include "motion_guess.hpp"

namespace rift::vision {
namespace {

/// From here on the sensor clips: white spreads over black, and a tag that looks larger is no
/// nearer.
constexpr double kClipped_grey = 245.0;

}  // namespace

TagMeter::TagMeter(const CameraModel& camera, const TagOptions& options)
    : camera_(camera),
      options_(options),
      map_from_camera_(MapFromCamera(camera)),
      floor_(FloorPriorOf(camera, options)) {}

TrackResult TagMeter::Measure(const GreyPatch& patch, const TagCorners& guess,
                              const TagCells& cells, TrackMode mode,
                              const std::optional<Eigen::Vector3d>& normal_in_camera) const {
  const std::optional<FittedSquare> square =
      FitSquare(camera_, patch, guess, cells.shape, options_.least_contrast,
                {options_.edge_sigma_px, options_.shared_sigma_px, cells.shape.square});
  if (!square || square->rms_px > options_.max_fit_px) return {.miss = Miss::kNoEdges};
  const ReadBits bits = CompareBits(camera_, patch, *square, cells);
  if (bits.wrong > options_.MaxHamming() || bits.margin < options_.min_margin) {
    return {.miss = Miss::kDoubtfulBits};
  }
  return Believe(*square, bits, mode, normal_in_camera);
}

TagPose TagMeter::Choose(const TagPoses& poses, const FittedSquare& square,
                         const Eigen::Vector3d& up_in_camera, bool& is_on_floor) const {
  const TagPose& free =
      LikelierPose(poses, up_in_camera, options_.lens_sigma_px, options_.tilt_sigma_rad);
  is_on_floor = false;
  if (!floor_) return free;
  const TagPose held = PoseOnFloor(camera_, square.corners, options_.size_m, *floor_,
                                   options_.lens_sigma_px, free.camera_from_tag);
  const double limit_px =
      std::max(2.0 * options_.lens_sigma_px, options_.off_floor_share * Side_px(square.pixels));
  is_on_floor = square.white_grey > kClipped_grey ||
                std::hypot(limit_px, free.reprojection_px) > held.reprojection_px;
  return is_on_floor ? held : free;
}

TrackResult TagMeter::Believe(const FittedSquare& square, const ReadBits& bits, TrackMode mode,
                              const std::optional<Eigen::Vector3d>& normal_in_camera) const {
  const std::optional<TagPoses> poses = SolveTagPoses(camera_, square.corners, options_.size_m);
  if (!poses) return {.miss = Miss::kNoPose};
  Eigen::Vector3d up = poses->best.camera_from_tag.linear().col(2);
  if (camera_.world) {
    up = map_from_camera_.linear().transpose() * Eigen::Vector3d::UnitZ();
  } else if (normal_in_camera) {
    up = *normal_in_camera;
  }
  Sighting sighting;
  const TagPose pose = Choose(*poses, square, up, sighting.is_on_floor);
  if (pose.reprojection_px > options_.max_fit_px) return {.miss = Miss::kNoPose};
  sighting.camera_from_tag = pose.camera_from_tag;
  sighting.map_from_tag = map_from_camera_ * pose.camera_from_tag;
  sighting.in_world = camera_.world.has_value();
  PoseCovariance turn = PoseCovariance::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = map_from_camera_.linear();
  sighting.covariance = turn * pose.covariance * turn.transpose();
  sighting.corners = square.pixels;
  sighting.mode = mode;
  sighting.hamming = bits.wrong;
  sighting.decision_margin = bits.margin;
  sighting.edge_px = square.rms_px;
  sighting.reprojection_px = pose.reprojection_px;
  if (poses->other) sighting.other_reprojection_px = poses->other->reprojection_px;
  return {.sighting = sighting};
}

}  // namespace rift::vision
