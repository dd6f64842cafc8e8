#include "rift/vision/rendering/precision_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"
#include "rift/vision/tracking/tag_visibility.hpp"
#include "rift/vision/tracking/world_frame.hpp"

namespace rift::vision {
namespace {

constexpr int kPicturesToFind = 3;  // as the staged search takes to reach full size
constexpr int kViewsOfLeast = 6;
constexpr double kFrame_s = 1.0 / 30.0;

/// One tag of one size below the camera.
class Trial {
 public:
  Trial(const CameraModel& camera, TagOptions options, SyntheticCameraOptions look)
      : pictures_(camera, With(look, options)), tracker_(camera, options), options_(options) {}

  /// The sighting of a tag that lies there, from nothing, or none.
  std::optional<Sighting> Find(const Eigen::Vector2d& at_m, double yaw_rad,
                               std::mt19937_64& generator) {
    RobotMotion robot;
    robot.world_from_tag.translation() << at_m, options_.height_m;
    robot.world_from_tag.linear() =
        Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    tracker_.Forget();
    for (int i = 0; i < kPicturesToFind; ++i) {
      Frame frame = pictures_.Render(robot, PixelFormat::kGrey, generator);
      frame.captured_s = t_s_ += kFrame_s;
      if (auto sighting = tracker_.Track(frame).sighting) return sighting;
    }
    return std::nullopt;
  }

 private:
  static SyntheticCameraOptions With(SyntheticCameraOptions look, const TagOptions& options) {
    look.tag_family = options.family;
    look.tag_id = options.id;
    look.tag_size_m = options.size_m;
    // A small tag lies on a small robot, so that the disc's rim keeps its distance.
    look.body_radius_m = std::max(look.body_radius_m, options.size_m);
    return look;
  }

  SyntheticCamera pictures_;
  TagTracker tracker_;
  TagOptions options_;
  double t_s_ = 0.0;
};

/// The whole circle but for a random start, so that few views are not all alike.
double Heading_rad(int view, int views, std::mt19937_64& generator) {
  const double within = std::uniform_real_distribution<double>(0.0, 1.0)(generator);
  return geometry::WrapToPi(2.0 * std::numbers::pi * (view + within) / views);
}

void TryPlace(Trial& trial, const PrecisionMapOptions& map, double m_per_px,
              std::mt19937_64& generator, PrecisionPlace& place) {
  std::uniform_real_distribution<double> within_px(-0.5, 0.5);
  place.views = map.views;
  for (int view = 0; view < map.views; ++view) {
    const Eigen::Vector2d at_m =
        *place.floor_m + m_per_px * Eigen::Vector2d(within_px(generator), within_px(generator));
    const double yaw_rad = Heading_rad(view, map.views, generator);
    const std::optional<Sighting> seen = trial.Find(at_m, yaw_rad, generator);
    if (!seen) continue;
    const geometry::Pose2 pose = seen->Planar();
    ++place.found;
    place.off_m.push_back((pose.Position() - at_m).norm());
    place.yaw_off_rad.push_back(std::abs(geometry::WrapToPi(pose.yaw_rad - yaw_rad)));
  }
}

PrecisionPlace PlaceAt(const CameraModel& camera, const TagOptions& options,
                       const Eigen::Vector2d& at_px) {
  PrecisionPlace place{.at_px = at_px};
  const auto floor_m = MapFromPixel(camera, at_px, options.height_m);
  if (!floor_m) return place;
  const Eigen::Vector3d tag_m(floor_m->x(), floor_m->y(), options.height_m);
  const auto side_px = ShortSide_px(camera, options.size_m, tag_m);
  if (!side_px) return place;
  place.floor_m = floor_m;
  place.side_px = *side_px;
  const Eigen::Vector3d to_tag = tag_m - camera.world->world_from_camera.translation();
  place.shift_by_height = to_tag.head<2>().norm() / std::abs(to_tag.z());
  return place;
}

bool IsFoundAt(const CameraModel& camera, TagOptions options, const SyntheticCameraOptions& look,
               const PrecisionPlace& place, double side_px, std::uint64_t seed) {
  options.size_m *= side_px / place.side_px;
  Trial trial(camera, options, look);
  std::mt19937_64 generator(seed);
  for (int view = 0; view < kViewsOfLeast; ++view) {
    const double yaw_rad = Heading_rad(view, kViewsOfLeast, generator);
    if (!trial.Find(*place.floor_m, yaw_rad, generator)) return false;
  }
  return true;
}

/// By halving, between a side that no detector reads and one that any does.
double LeastSide_px(const CameraModel& camera, const TagOptions& options,
                    const SyntheticCameraOptions& look, const PrecisionPlace& place,
                    std::uint64_t seed) {
  double not_found_px = 6.0, found_px = 48.0;
  while (found_px - not_found_px > 1.0) {
    const double side_px = 0.5 * (not_found_px + found_px);
    (IsFoundAt(camera, options, look, place, side_px, seed) ? found_px : not_found_px) = side_px;
  }
  return found_px;
}

}  // namespace

PrecisionMap PredictPrecision(const CameraModel& camera, const TagOptions& options,
                              SyntheticCameraOptions look, const PrecisionMapOptions& map,
                              const std::function<void(int, int)>& on_place) {
  if (!camera.world) {
    throw std::invalid_argument(
        "the calibration holds no world frame: rift track --world sets one, and only then is it "
        "known where the floor is");
  }
  PrecisionMap result{.columns = map.columns, .rows = map.rows};
  Trial trial(camera, options, look);
  const int all = map.columns * map.rows;
  for (int i = 0; i < all; ++i) {
    const Eigen::Vector2d share((i % map.columns + 0.5) / map.columns,
                                (i / map.columns + 0.5) / map.rows);  // NOLINT: whole rows
    PrecisionPlace place =
        PlaceAt(camera, options, {share.x() * camera.width_px, share.y() * camera.height_px});
    if (place.floor_m) {
      std::mt19937_64 generator(map.seed + static_cast<std::uint64_t>(i));
      TryPlace(trial, map, options.size_m / place.side_px, generator, place);
    }
    result.places.push_back(std::move(place));
    if (on_place) on_place(i + 1, all);
  }
  const auto least = [](const PrecisionPlace& a, const PrecisionPlace& b) {
    return (a.floor_m ? a.side_px : HUGE_VAL) < (b.floor_m ? b.side_px : HUGE_VAL);
  };
  const auto smallest = std::min_element(result.places.begin(), result.places.end(), least);
  if (smallest == result.places.end() || !smallest->floor_m) return result;
  // Where the tag is smallest it is also seen at the steepest slant and in the least light.
  result.least_side_px = LeastSide_px(camera, options, look, *smallest, map.seed);
  for (PrecisionPlace& place : result.places) {
    if (place.floor_m) {
      place.least_size_m = options.size_m * result.least_side_px / place.side_px;
    }
  }
  return result;
}

}  // namespace rift::vision
