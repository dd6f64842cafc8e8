#include "rift/vision/rendering/synthetic_camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <stdexcept>

#include "flat_painter.hpp"
#include "rift/vision/camera/jpeg.hpp"

namespace rift::vision {
namespace {

/// Normal noise for whole pictures at the cost of two additions a pixel: a long table made once,
/// of which every row of every picture takes a stretch from a random place.
class SensorNoise {
 public:
  explicit SensorNoise(double sigma_grey);
  /// Adds to every pixel, within 0 to 255.
  void AddTo(cv::Mat1b& picture, std::mt19937_64& generator) const;

 private:
  cv::Mat1b brighter_;  ///< one row each; the noise is their difference
  cv::Mat1b darker_;
};

constexpr int kTableLength = 1 << 20;
constexpr std::uint64_t kTableSeed = 0x5eed;

SensorNoise::SensorNoise(double sigma_grey) {
  if (sigma_grey <= 0.0) return;
  cv::Mat1f table(1, kTableLength);
  cv::RNG(kTableSeed).fill(table, cv::RNG::NORMAL, 0.0, sigma_grey);
  table.convertTo(brighter_, CV_8U);
  cv::Mat1f(-table).convertTo(darker_, CV_8U);
}

void SensorNoise::AddTo(cv::Mat1b& picture, std::mt19937_64& generator) const {
  if (brighter_.empty()) return;
  const auto places = static_cast<std::uint64_t>(kTableLength - picture.cols);
  for (int y = 0; y < picture.rows; ++y) {
    const cv::Rect part(static_cast<int>(generator() % places), 0, picture.cols, 1);
    cv::Mat row = picture.row(y);
    cv::add(row, brighter_(part), row);
    cv::subtract(row, darker_(part), row);
  }
}

constexpr std::uint64_t kGrainSeed = 0xf1008;
/// Exposures that are averaged where the shutter is open for a while: one a pixel of smear. So many
/// edges need fewer points each.
constexpr int kMostMoments = 8;
constexpr int kFineOfMoments = 6;

Region Union(const Region& a, const Region& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const cv::Rect both = cv::Rect(a.x_px, a.y_px, a.width_px, a.height_px) |
                        cv::Rect(b.x_px, b.y_px, b.width_px, b.height_px);
  return {both.x, both.y, both.width, both.height};
}

Region Grown(const Region& region, int by_px, const CameraModel& camera) {
  return Clipped({region.x_px - by_px, region.y_px - by_px, region.width_px + 2 * by_px,
                  region.height_px + 2 * by_px},
                 camera.width_px, camera.height_px);
}

cv::Rect ToRect(const Region& region) {
  return {region.x_px, region.y_px, region.width_px, region.height_px};
}

/// The texture of paper: noise of about one and of about twenty pixels, half of the variance each.
cv::Mat1f Grain(const CameraModel& camera, double sigma_grey) {
  cv::Mat1f sum(cv::Mat1f::zeros(camera.height_px, camera.width_px));
  cv::RNG random(kGrainSeed);
  for (const double width_px : {1.0, 20.0}) {
    cv::Mat1f layer(sum.size());
    random.fill(layer, cv::RNG::NORMAL, 0.0, 1.0);
    cv::GaussianBlur(layer, layer, {}, width_px);
    cv::Scalar mean, deviation;
    cv::meanStdDev(layer, mean, deviation);
    cv::scaleAdd(layer, sigma_grey * std::sqrt(0.5) / deviation[0], sum, sum);
  }
  return sum;
}

/// Light falls off with the square of the distance from the picture's middle.
void DimTowardsCorners(cv::Mat1f& picture, double falloff) {
  const double corner2 = std::pow(picture.cols / 2.0, 2) + std::pow(picture.rows / 2.0, 2);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const double r2 = std::pow(x - picture.cols / 2.0, 2) + std::pow(y - picture.rows / 2.0, 2);
      picture(y, x) *= static_cast<float>(1.0 - falloff * r2 / corner2);
    }
  }
}

Eigen::Isometry3d Later(const RobotMotion& motion, double by_s) {
  Eigen::Isometry3d pose = motion.world_from_tag;
  pose.linear() = Eigen::AngleAxisd(motion.yaw_rate_radps * by_s, Eigen::Vector3d::UnitZ()) *
                  motion.world_from_tag.linear();
  pose.translation() += motion.velocity_mps * by_s;
  return pose;
}

}  // namespace

struct SyntheticCamera::State {
  State(const CameraModel& model, const SyntheticCameraOptions& given, const Scene& scene);

  /// A layer of the robot: a pattern and how far it lies below the tag.
  struct Layer {
    std::unique_ptr<FlatPattern> pattern;
    double below_tag_m;
  };

  void PaintStill(const FlatPattern& pattern, const Eigen::Isometry3d& world_from_pattern);
  Eigen::Isometry3d CameraFromLayer(const Layer& layer, const RobotMotion& robot,
                                    double by_s) const;
  Region RobotFootprint(const Layer& layer, const RobotMotion& robot) const;
  int Moments(const RobotMotion& robot) const;
  void PaintRobot(const RobotMotion& robot, double by_s, const Region& region, int fine,
                  cv::Mat1f& canvas);
  /// Everything that light and lens do, sensor noise not yet.
  cv::Mat1b Expose(const cv::Mat1f& light) const;
  void DrawRobot(const RobotMotion& robot, cv::Mat1b& picture);
  std::vector<std::uint8_t> Pack(const cv::Mat1b& picture, PixelFormat format);

  CameraModel camera;
  SyntheticCameraOptions options;
  Eigen::Isometry3d camera_from_world;
  FlatPainter painter;
  SensorNoise noise;
  std::vector<Layer> robot_layers;
  cv::Mat1f floor;  ///< before the lens
  cv::Mat1b still;  ///< the picture without a robot and without noise
};

SyntheticCamera::State::State(const CameraModel& model, const SyntheticCameraOptions& given,
                              const Scene& scene)
    : camera(model),
      options(given),
      camera_from_world(model.world->world_from_camera.inverse()),
      painter(model),
      noise(given.noise_grey) {
  floor = Grain(camera, options.grain_grey);
  floor += options.floor_grey;
  for (const PlacedBoard& board : scene.boards) {
    PaintStill(BoardPattern(board, options.black_grey, options.white_grey), board.world_from_board);
  }
  for (const PlacedTag& tag : scene.tags) {
    PaintStill(TagPattern(CellsOfTag(tag.id, tag.family), tag.size_m, options.black_grey,
                          options.white_grey),
               tag.world_from_tag);
  }
  DimTowardsCorners(floor, options.falloff);
  still = Expose(floor);
  const double radius_m = options.body_radius_m;
  robot_layers.push_back(
      {std::make_unique<DiscPattern>(radius_m, options.body_grey * 0.5), options.body_height_m});
  robot_layers.push_back({std::make_unique<DiscPattern>(radius_m, options.body_grey), 0.0});
  robot_layers.push_back(
      {std::make_unique<TagPattern>(CellsOfTag(options.tag_id, options.tag_family),
                                    options.tag_size_m, options.black_grey, options.white_grey),
       0.0});
}

void SyntheticCamera::State::PaintStill(const FlatPattern& pattern,
                                        const Eigen::Isometry3d& world_from_pattern) {
  const Eigen::Isometry3d pose = camera_from_world * world_from_pattern;
  const Region all{0, 0, camera.width_px, camera.height_px};
  painter.Paint(
      pattern, [&](double) { return pose; }, Footprint(camera, pattern, pose), all, floor);
}

Eigen::Isometry3d SyntheticCamera::State::CameraFromLayer(const Layer& layer,
                                                          const RobotMotion& robot,
                                                          double by_s) const {
  return camera_from_world * Later(robot, by_s) *
         Eigen::Translation3d(0.0, 0.0, -layer.below_tag_m);
}

Region SyntheticCamera::State::RobotFootprint(const Layer& layer, const RobotMotion& robot) const {
  const double reach_s = 0.5 * (options.shutter_s + options.readout_s);
  Region region = Footprint(camera, *layer.pattern, CameraFromLayer(layer, robot, 0.0));
  if (reach_s == 0.0) return region;
  for (const double by_s : {-reach_s, reach_s}) {
    region = Union(region, Footprint(camera, *layer.pattern, CameraFromLayer(layer, robot, by_s)));
  }
  return region;
}

int SyntheticCamera::State::Moments(const RobotMotion& robot) const {
  const double depth_m = (camera_from_world * robot.world_from_tag.translation()).z();
  const double speed_mps =
      robot.velocity_mps.norm() + std::abs(robot.yaw_rate_radps) * options.body_radius_m;
  const double smear_px = speed_mps * options.shutter_s * camera.k(0, 0) / depth_m;
  return static_cast<int>(std::clamp(std::ceil(smear_px), 1.0, double{kMostMoments}));
}

void SyntheticCamera::State::PaintRobot(const RobotMotion& robot, double by_s, const Region& region,
                                        int fine, cv::Mat1f& canvas) {
  for (const Layer& layer : robot_layers) {
    const Eigen::Isometry3d still_pose = CameraFromLayer(layer, robot, by_s);
    const auto pose_of_row = [&](double row) {
      if (options.readout_s == 0.0) return still_pose;
      return CameraFromLayer(layer, robot,
                             by_s + options.readout_s * (row / camera.height_px - 0.5));
    };
    painter.Paint(*layer.pattern, pose_of_row, RobotFootprint(layer, robot), region, canvas, fine);
  }
}

cv::Mat1b SyntheticCamera::State::Expose(const cv::Mat1f& light) const {
  cv::Mat1f blurred = light;
  if (options.blur_px > 0.0) cv::GaussianBlur(light, blurred, {}, options.blur_px);
  cv::Mat1b picture;
  blurred.convertTo(picture, CV_8U, options.exposure);
  return picture;
}

void SyntheticCamera::State::DrawRobot(const RobotMotion& robot, cv::Mat1b& picture) {
  Region covered;
  for (const Layer& layer : robot_layers) covered = Union(covered, RobotFootprint(layer, robot));
  if (covered.empty()) return;
  // The blur reaches this far; what it makes at the rim of the canvas is not used.
  const int reach_px = static_cast<int>(std::ceil(4.0 * options.blur_px)) + 1;
  covered = Grown(covered, reach_px, camera);
  const Region region = Grown(covered, reach_px, camera);
  const int moments = Moments(robot);
  const int fine = moments > 1 ? kFineOfMoments : FlatPainter::kFine;
  cv::Mat1f light(cv::Mat1f::zeros(region.height_px, region.width_px));
  for (int i = 0; i < moments; ++i) {
    cv::Mat1f moment = floor(ToRect(region)).clone();
    PaintRobot(robot, options.shutter_s * ((i + 0.5) / moments - 0.5), region, fine, moment);
    cv::scaleAdd(moment, 1.0 / moments, light, light);
  }
  const cv::Rect inner(covered.x_px - region.x_px, covered.y_px - region.y_px, covered.width_px,
                       covered.height_px);
  Expose(light)(inner).copyTo(picture(ToRect(covered)));
}

std::vector<std::uint8_t> SyntheticCamera::State::Pack(const cv::Mat1b& picture,
                                                       PixelFormat format) {
  if (format == PixelFormat::kJpeg) {
    return WriteJpeg(picture, options.jpeg_quality, options.jpeg_colour);
  }
  cv::Mat packed = picture;
  if (format == PixelFormat::kBgr) cv::cvtColor(picture, packed, cv::COLOR_GRAY2BGR);
  if (format == PixelFormat::kYuyv) {
    cv::merge(std::array<cv::Mat, 2>{picture, cv::Mat1b(picture.size(), 128)}, packed);
  }
  return {packed.datastart, packed.dataend};
}

SyntheticCamera::SyntheticCamera(const CameraModel& camera, const SyntheticCameraOptions& options,
                                 const Scene& scene) {
  if (!camera.world) {
    throw std::invalid_argument(fmt::format(
        "camera {}: to render what it sees, its place in the world must be known", camera.name));
  }
  if (camera.width_px < 1 || camera.height_px < 1) {
    throw std::invalid_argument(fmt::format("camera {}: {} x {} is no size of a picture",
                                            camera.name, camera.width_px, camera.height_px));
  }
  state_ = std::make_unique<State>(camera, options, scene);
}

SyntheticCamera::~SyntheticCamera() = default;
SyntheticCamera::SyntheticCamera(SyntheticCamera&&) noexcept = default;
SyntheticCamera& SyntheticCamera::operator=(SyntheticCamera&&) noexcept = default;

Frame SyntheticCamera::Render(const std::optional<RobotMotion>& robot, PixelFormat format,
                              std::mt19937_64& generator) {
  Frame frame;
  frame.width_px = state_->camera.width_px;
  frame.height_px = state_->camera.height_px;
  frame.format = format;
  cv::Mat1b picture = state_->still.clone();
  if (robot) state_->DrawRobot(*robot, picture);
  state_->noise.AddTo(picture, generator);
  frame.bytes = state_->Pack(picture, format);
  return frame;
}

}  // namespace rift::vision
