#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/camera/frame.hpp"
#include "rift/vision/tracking/tag_family.hpp"

namespace rift::vision {

/// A printed tag with its border. Tag frame: the middle, x right and y up as one reads
/// it, z out of the paper.
struct PlacedTag {
  int id = 0;
  double size_m = 0.0475;  ///< side of the square that is detected
  Eigen::Isometry3d world_from_tag = Eigen::Isometry3d::Identity();
  TagFamily family = TagFamily::k36h11;
};

/// A printed chessboard with a white margin one square wide. Board frame: the first inner corner,
/// x along the columns, y along the rows (down the paper as OpenCV counts them), z into the paper.
struct PlacedBoard {
  int columns = 13;  ///< inner corners along x
  int rows = 9;      ///< inner corners along y
  double square_m = 0.025;
  Eigen::Isometry3d world_from_board = Eigen::Isometry3d::Identity();
};

/// What stands still on the floor, z = 0 of the world. Later ones lie on top.
struct Scene {
  std::vector<PlacedTag> tags;
  std::vector<PlacedBoard> boards;
};

/// The robot at the middle of the exposure, as its tag moves then.
struct RobotMotion {
  Eigen::Isometry3d world_from_tag = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< in the world
  double yaw_rate_radps = 0.0;                             ///< about the world's z
};

/// What the camera makes of the light, and what robot and floor look like.
struct SyntheticCameraOptions {
  TagFamily tag_family = TagFamily::k36h11;  ///< no key of its own: that of TagOptions
  int tag_id = 0;
  double tag_size_m = 0.0475;
  double body_radius_m = 0.0484;
  double body_height_m = 0.030;
  double floor_grey = 165.0;
  double grain_grey = 4.0;
  double falloff = 0.25;
  double black_grey = 28.0;
  double white_grey = 215.0;
  double body_grey = 45.0;
  double exposure = 1.0;
  double blur_px = 0.8;
  double noise_grey = 3.0;
  double shutter_s = 0.0;
  double readout_s = 0.0;
  int jpeg_quality = 90;
  bool jpeg_colour = true;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("tag_id", self.tag_id, 0, kLastTagId, "the robot's tag, of the family track.tag.family");
    field("tag_size_m", self.tag_size_m, 0.005, 1.0,
          "side of its black square in m (tagStandard41h12: of the white one)");
    field("body_radius_m", self.body_radius_m, 0.0, 0.5,
          "the dark disc under the tag in m (authors' world: 0.0484); 0: none");
    field("body_height_m", self.body_height_m, 0.0, 0.2,
          "from the disc's lower rim to the tag in m");
    field("floor_grey", self.floor_grey, 0.0, 255.0, "floor in the middle of the picture");
    field("grain_grey", self.grain_grey, 0.0, 60.0, "scatter of the floor, as of paper");
    field("falloff", self.falloff, 0.0, 0.9, "share of the light that the picture's corners lack");
    field("black_grey", self.black_grey, 0.0, 255.0, "printed black");
    field("white_grey", self.white_grey, 0.0, 255.0, "paper white");
    field("body_grey", self.body_grey, 0.0, 255.0, "the robot's body");
    field("exposure", self.exposure, 0.01, 20.0, "all grey values are multiplied by this");
    field("blur_px", self.blur_px, 0.0, 10.0, "sigma of the lens's Gaussian blur");
    field("noise_grey", self.noise_grey, 0.0, 30.0, "sigma of the sensor's noise");
    field("shutter_s", self.shutter_s, 0.0, 0.2, "exposure time, which blurs motion; 0: none");
    field("readout_s", self.readout_s, 0.0, 0.2,
          "rolling shutter: from the first row's exposure to the last's; 0: global");
    field("jpeg_quality", self.jpeg_quality, 1, 100, "of the compressed frames");
    field("jpeg_colour", self.jpeg_colour,
          "compressed frames are YCbCr 4:2:0 as webcams send them; otherwise grey alone");
  }
};

/// Renders what a camera with this model sees, exactly to about 0.001 px: each shape's edges are
/// traced through perspective and lens, then blurred, then noise is added. Only the robot is drawn
/// anew for each frame.
class SyntheticCamera {
 public:
  /// camera.world says where it hangs; std::invalid_argument without it or without a size.
  SyntheticCamera(const CameraModel& camera, const SyntheticCameraOptions& options,
                  const Scene& scene = {});
  ~SyntheticCamera();
  SyntheticCamera(SyntheticCamera&&) noexcept;
  SyntheticCamera& operator=(SyntheticCamera&&) noexcept;

  /// One picture; without a robot, the floor alone. Index and times of the frame are left at zero.
  /// The same state of the generator gives the same bytes.
  Frame Render(const std::optional<RobotMotion>& robot, PixelFormat format,
               std::mt19937_64& generator);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rift::vision
