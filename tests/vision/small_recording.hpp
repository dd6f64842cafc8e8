#pragma once

#include <fmt/format.h>

#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "rift/vision/rendering/synthetic_camera.hpp"
#include "rift/vision/tracking/session.hpp"
#include "support/processes/process.hpp"
#include "vision/rendered_tags.hpp"

namespace rift::test {

/// 640 x 480, 0.6 m above the floor and looking straight down; no lens.
inline vision::CameraModel SmallCamera() {
  vision::CameraModel camera{.name = "small", .width_px = 640, .height_px = 480};
  camera.k << 610.0, 0.0, 319.5, 0.0, 610.0, 239.5, 0.0, 0.0, 1.0;
  camera.distortion = {0.0, 0.0, 0.0, 0.0};
  camera.world.emplace();
  camera.world->world_from_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  camera.world->world_from_camera.translation() = Eigen::Vector3d(0.0, 0.0, 0.6);
  camera.world->origin = "4 reference tags";
  return camera;
}

/// A tag that lies on the floor.
inline vision::PlacedTag FloorTag(int id, double x_m, double y_m, double size_m = 0.0475) {
  vision::PlacedTag tag{.id = id, .size_m = size_m};
  tag.world_from_tag.translation() = Eigen::Vector3d(x_m, y_m, 0.0);
  return tag;
}

/// Pictures of SmallCamera in a folder, 0000.jpg and on.
class SmallRecording {
 public:
  explicit SmallRecording(const vision::Scene& scene = {}, int robot_tag = 0)
      : camera_(SmallCamera(), {.tag_id = robot_tag, .noise_grey = 1.0}, scene) {}

  /// The robot there in so many pictures; none: the floor alone.
  void Add(const std::optional<vision::RobotMotion>& robot, int pictures = 1) {
    const vision::Frame frame = camera_.Render(robot, vision::PixelFormat::kJpeg, random_);
    for (int i = 0; i < pictures; ++i) Write(frame.bytes);
  }
  void Write(const std::vector<std::uint8_t>& bytes) {
    std::ofstream(folder_ / fmt::format("{:04}.jpg", count_++), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  std::string Path() const { return folder_.Path().string(); }

 private:
  TemporaryFolder folder_;
  vision::SyntheticCamera camera_;
  std::mt19937_64 random_{1};
  int count_ = 0;
};

}  // namespace rift::test
