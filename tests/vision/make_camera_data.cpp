// Makes data/camera from data/camera/recording.yaml: the pictures, where the tag really was, the
// camera that took them, the reference tags' places, and the sheets to print.
//   rift_make_camera_data FOLDER
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "rift/trajectory/log.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/rendering/print_sheet.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"

namespace {

using namespace rift;
namespace fs = std::filesystem;

constexpr double kReferenceTag_m = 0.04;

struct CameraBlock {
  int width_px = 640, height_px = 480;
  double focal_px = 780.0, height_m = 0.87, tilt_deg = 0.0, turn_deg = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("width_px", self.width_px, 16, 4096, "");
    field("height_px", self.height_px, 16, 4096, "");
    field("focal_px", self.focal_px, 10.0, 1e5, "");
    field("height_m", self.height_m, 0.01, 100.0, "");
    field("tilt_deg", self.tilt_deg, -80.0, 80.0, "");
    field("turn_deg", self.turn_deg, -180.0, 180.0, "");
  }
};

struct PathBlock {
  double start_x_m = 0.0, start_y_m = 0.0, speed_mps = 0.2, swing_m = 0.0, tag_height_m = 0.03;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("start_x_m", self.start_x_m, -10.0, 10.0, "");
    field("start_y_m", self.start_y_m, -10.0, 10.0, "");
    field("speed_mps", self.speed_mps, 0.0, 10.0, "");
    field("swing_m", self.swing_m, 0.0, 1.0, "");
    field("tag_height_m", self.tag_height_m, 0.0, 1.0, "");
  }
};

struct TagBlock {
  int id = 0;
  double x_m = 0.0, y_m = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("id", self.id, 0, 586, "");
    field("x_m", self.x_m, -10.0, 10.0, "");
    field("y_m", self.y_m, -10.0, 10.0, "");
  }
};

struct Recording {
  std::uint64_t seed = 1;
  double fps = 15.0;
  int frames = 30;
  CameraBlock camera;
  PathBlock path;
  vision::SyntheticCameraOptions picture;
  std::vector<TagBlock> tags;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("seed", self.seed, "");
    field("fps", self.fps, 0.1, 1000.0, "");
    field("frames", self.frames, 2, 10000, "");
    field("camera", self.camera, "");
    field("path", self.path, "");
    field("picture", self.picture, "");
    field("tags", self.tags, "");
  }
};

vision::CameraModel CameraOf(const CameraBlock& block) {
  vision::CameraModel camera;
  camera.name = "synthetic";
  camera.width_px = block.width_px;
  camera.height_px = block.height_px;
  camera.k << block.focal_px, 0.0, 0.5 * block.width_px - 3.0, 0.0, block.focal_px,
      0.5 * block.height_px + 5.0, 0.0, 0.0, 1.0;
  camera.distortion = {-0.18, 0.06, 0.0008, -0.0005, 0.0};
  const double rad = std::numbers::pi / 180.0;
  vision::WorldFrame world;
  world.world_from_camera.linear() =
      Eigen::AngleAxisd(block.turn_deg * rad, Eigen::Vector3d::UnitZ()) *
      Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal() *
      Eigen::AngleAxisd(block.tilt_deg * rad, Eigen::Vector3d::UnitX());
  world.world_from_camera.translation() =
      Eigen::Vector3d(0.0, -block.height_m * std::tan(block.tilt_deg * rad), block.height_m);
  world.origin = "as rendered";
  camera.world = world;
  return camera;
}

/// Along x with one swing of a sine across.
vision::RobotMotion MotionAt(const PathBlock& path, double t_s, double whole_s) {
  const double turn = 2.0 * std::numbers::pi / whole_s;
  const double across = path.swing_m * std::sin(turn * t_s);
  const double across_rate = path.swing_m * turn * std::cos(turn * t_s);
  const double across_rate2 = -path.swing_m * turn * turn * std::sin(turn * t_s);
  const double yaw = std::atan2(across_rate, path.speed_mps);
  vision::RobotMotion robot;
  robot.world_from_tag.translation() = Eigen::Vector3d(path.start_x_m + path.speed_mps * t_s,
                                                       path.start_y_m + across, path.tag_height_m);
  robot.world_from_tag.linear() =
      Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  robot.velocity_mps = Eigen::Vector3d(path.speed_mps, across_rate, 0.0);
  robot.yaw_rate_radps =
      across_rate2 * path.speed_mps / (path.speed_mps * path.speed_mps + across_rate * across_rate);
  return robot;
}

void Write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

std::string PlacesYaml(const Recording& recording) {
  std::string text =
      "# Where the reference tags lie: rift track --world data/camera/tags.yaml ...\ntags:\n";
  for (const TagBlock& tag : recording.tags) {
    text += fmt::format("- {{id: {}, x_m: {:g}, y_m: {:g}}}\n", tag.id, tag.x_m, tag.y_m);
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const fs::path folder = argv[1];
  std::ostringstream text;
  text << std::ifstream(folder / "recording.yaml").rdbuf();
  Recording recording;
  yaml::Bind(yaml::Parse(text.str(), "recording.yaml"), recording);

  vision::CameraModel camera = CameraOf(recording.camera);
  vision::Scene scene;
  for (const TagBlock& tag : recording.tags) {
    vision::PlacedTag placed{.id = tag.id, .size_m = kReferenceTag_m};
    placed.world_from_tag.translation() = Eigen::Vector3d(tag.x_m, tag.y_m, 0.0);
    scene.tags.push_back(placed);
  }
  vision::SyntheticCamera renderer(camera, recording.picture, scene);
  std::mt19937_64 generator(recording.seed);
  trajectory::Trajectory truth;
  for (int i = 0; i < recording.frames; ++i) {
    const double t_s = i / recording.fps;
    const vision::RobotMotion robot =
        MotionAt(recording.path, t_s, (recording.frames - 1) / recording.fps);
    const vision::Frame frame = renderer.Render(robot, vision::PixelFormat::kJpeg, generator);
    Write(folder / "frames" / fmt::format("{:03}.jpg", i),
          {frame.bytes.begin(), frame.bytes.end()});
    const Eigen::Matrix3d turn = robot.world_from_tag.linear();
    const Eigen::Vector3d p = robot.world_from_tag.translation();
    truth.poses.push_back({.t_s = std::round(t_s * 1e6) / 1e6,
                           .x_m = p.x(),
                           .y_m = p.y(),
                           .z_m = p.z(),
                           .roll_rad = 0.0,
                           .pitch_rad = 0.0,
                           .yaw_rad = std::atan2(turn(1, 0), turn(0, 0))});
  }
  Write(folder / "truth.csv", trajectory::WriteRift(truth));
  Write(folder / "tags.yaml", PlacesYaml(recording));
  Write(folder / "camera.yaml",
        vision::WriteCamera(
            camera, "# The camera that rendered frames/, with its true place above the floor.\n"));
  Write(folder / "print/tag36h11_0.svg", vision::TagSheet(0, 0.0475));
  Write(folder / "print/chessboard_13x9_25mm.svg", vision::ChessboardSheet({13, 9, 0.025}));
  return 0;
}
