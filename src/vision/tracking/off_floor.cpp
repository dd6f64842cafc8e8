#include "rift/vision/tracking/off_floor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rift/statistics/descriptive.hpp"
#include "rift/vision/tracking/tag_pose.hpp"

namespace rift::vision {
namespace {

constexpr std::size_t kLeastSightings = 10;
constexpr std::size_t kOfTen = 9;   // sightings, off the floor
constexpr double kHighest_m = 2.0;  // of track.tag.height_m

}  // namespace

OffFloorCheck::OffFloorCheck(const CameraModel& camera, const TagOptions& tag)
    : camera_(camera), tag_(tag), has_floor_(FloorPriorOf(camera, tag)) {}

std::optional<std::string> OffFloorCheck::Add(const Sighting& sighting) {
  if (is_said_ || !sighting.in_world || !has_floor_) return {};
  ++sightings_;
  if (!sighting.is_on_floor) z_m_.push_back(sighting.map_from_tag.translation().z());
  if (z_m_.size() < kLeastSightings || 10 * z_m_.size() < kOfTen * sightings_) return {};
  is_said_ = true;
  return Warning();
}

/// A side that is told too long puts the tag too far down the ray on which it is seen.
std::string OffFloorCheck::Warning() const {
  const double camera_m = camera_.world->world_from_camera.translation().z();
  const double z_m = statistics::Median(z_m_);
  if (camera_m <= std::max(z_m, tag_.height_m)) {
    return fmt::format(
        "the world frame puts the camera at z {:.3f} m, below the tag at {:.3f} m: set the frame "
        "again (--world), z is up",
        camera_m, std::max(z_m, tag_.height_m));
  }
  const double size_m = tag_.size_m * (camera_m - tag_.height_m) / (camera_m - z_m);
  std::string text = fmt::format(
      "the tag is not on the floor in {} of {} pictures (z {:.3f} m, track.tag.height_m {:g}): is "
      "its side {:.4f} m (--set track.tag.size_m={:.4f})",
      z_m_.size(), sightings_, z_m, tag_.height_m, size_m, size_m);
  if (z_m >= 0.0 && z_m <= kHighest_m) {
    text += fmt::format(", its height {:.3f} m (--tag-height {:.3f})", z_m, z_m);
  }
  return text + ", or was the camera moved since its world frame was set?";
}

}  // namespace rift::vision
