#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "rift/vision/calibration/calibration.hpp"
#include "rift/vision/camera/capture_options.hpp"
#include "rift/vision/camera/capture_thread.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"
#include "rift/vision/tracking/track_scene.hpp"
#include "rift/vision/tracking/world_frame.hpp"

namespace rift::vision {

/// TagTracker behind the module.
class PoseTracker {
 public:
  virtual ~PoseTracker() = default;
  virtual TrackResult Track(const Frame& frame) = 0;
  virtual void Forget() = 0;
};

/// SyntheticCamera behind the module: a stream's pictures of one scene, compressed.
class PictureMaker {
 public:
  virtual ~PictureMaker() = default;
  virtual std::vector<std::uint8_t> Jpeg(const RobotMotion& robot, std::mt19937_64& generator) = 0;
};

/// All of the camera side, in a module of its own, since OpenCV's libraries would cost every start
/// of rift 0.1 s. Each function is documented where the class or function of its name is.
class Vision {
 public:
  virtual ~Vision() = default;

  virtual std::unique_ptr<Capture> OpenCapture(const std::string& camera,
                                               const CaptureOptions& options) = 0;
  virtual std::unique_ptr<PoseTracker> MakeTracker(const CameraModel& camera,
                                                   const TagOptions& options) = 0;
  /// Every tag of the family in a picture; see TagDetector for the decimation.
  virtual std::vector<TagDetection> FindTags(const Frame& frame, int decimate, int max_hamming) = 0;

  virtual std::vector<std::string> ImageFiles(const std::string& pattern) = 0;
  virtual BoardView FindBoard(const std::string& path, const Board& board) = 0;
  virtual BoardView FindBoard(const Frame& frame, const Board& board, const std::string& name) = 0;
  virtual ViewPlace PlaceOf(const BoardView& view, const Board& board) = 0;
  virtual Coverage CoverageOf(const std::vector<ViewResult>& views, const Board& board) = 0;
  virtual Calibration Calibrate(const std::vector<BoardView>& views, const Board& board,
                                const CalibrationOptions& options) = 0;
  virtual void DrawCalibration(const Calibration& calibration,
                               const std::filesystem::path& path) = 0;

  virtual WorldFrame WorldFromPoints(const CameraModel& camera,
                                     const std::vector<WorldPoint>& points,
                                     const std::string& origin) = 0;
  virtual WorldFrame WorldFromTags(const CameraModel& camera,
                                   const std::vector<ReferenceMark>& tags,
                                   const std::vector<TagDetection>& seen) = 0;
  virtual WorldFrame WorldFromFirstPose(const std::vector<Eigen::Isometry3d>& camera_from_tag,
                                        double tag_height_m) = 0;
  virtual std::optional<double> MovedBy_m(const CameraModel& camera,
                                          const std::vector<TagDetection>& seen) = 0;
  virtual std::optional<Eigen::Vector2d> MapFromPixel(const CameraModel& camera,
                                                      const Eigen::Vector2d& pixel, double z_m) = 0;

  virtual std::unique_ptr<PictureMaker> MakePictures(const CameraModel& camera,
                                                     const SyntheticCameraOptions& options) = 0;

  /// Why no window can be opened here, in one line for people; empty when one can.
  virtual std::string MissingDisplay() = 0;
  virtual std::unique_ptr<TrackWindow> OpenWindow(const std::string& title) = 0;
};

std::unique_ptr<Vision> LoadVision();

}  // namespace rift::vision
