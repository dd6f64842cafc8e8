#include "rift/vision/module/module.hpp"

#include "rift/module/display.hpp"
#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/camera/picture_reader.hpp"
#include "rift/vision/tracking/track_window.hpp"

namespace rift::vision {
namespace {

class SteadyTracker : public PoseTracker {
 public:
  SteadyTracker(const CameraModel& camera, const TagOptions& options)
      : tracker_(camera, options, SteadyNow_s) {}
  TrackResult Track(const Frame& frame) override { return tracker_.Track(frame); }
  void Forget() override { tracker_.Forget(); }

 private:
  TagTracker tracker_;
};

class SyntheticPictures : public PictureMaker {
 public:
  SyntheticPictures(const CameraModel& camera, const SyntheticCameraOptions& options)
      : camera_(camera, options) {}
  std::vector<std::uint8_t> Jpeg(const RobotMotion& robot, std::mt19937_64& generator) override {
    return camera_.Render(robot, PixelFormat::kJpeg, generator).bytes;
  }

 private:
  SyntheticCamera camera_;
};

class OpenCvVision : public Vision {
 public:
  std::unique_ptr<Capture> OpenCapture(const std::string& camera,
                                       const CaptureOptions& options) override {
    return std::make_unique<CaptureThread>(
        [camera, options] { return OpenCamera(camera, options); }, options);
  }
  std::unique_ptr<PoseTracker> MakeTracker(const CameraModel& camera,
                                           const TagOptions& options) override {
    return std::make_unique<SteadyTracker>(camera, options);
  }
  std::vector<TagDetection> FindTags(const Frame& frame, int decimate, int max_hamming) override {
    const auto grey = PictureReader().Read(frame);
    if (!grey) return {};
    return TagDetector(decimate, max_hamming).Detect(*grey);
  }
  std::vector<std::string> ImageFiles(const std::string& pattern) override {
    return vision::ImageFiles(pattern);
  }
  BoardView FindBoard(const std::string& path, const Board& board) override {
    return vision::FindBoard(path, board);
  }
  BoardView FindBoard(const Frame& frame, const Board& board, const std::string& name) override {
    return vision::FindBoard(frame, board, name);
  }
  ViewPlace PlaceOf(const BoardView& view, const Board& board) override {
    return vision::PlaceOf(view, board);
  }
  Coverage CoverageOf(const std::vector<ViewResult>& views, const Board& board) override {
    return vision::CoverageOf(views, board);
  }
  Calibration Calibrate(const std::vector<BoardView>& views, const Board& board,
                        const CalibrationOptions& options) override {
    return vision::Calibrate(views, board, options);
  }
  void DrawCalibration(const Calibration& calibration, const std::filesystem::path& path) override {
    vision::DrawCalibration(calibration, path);
  }
  WorldFrame WorldFromPoints(const CameraModel& camera, const std::vector<WorldPoint>& points,
                             const std::string& origin) override {
    return vision::WorldFromPoints(camera, points, origin);
  }
  WorldFrame WorldFromTags(const CameraModel& camera, const std::vector<ReferenceMark>& tags,
                           const std::vector<TagDetection>& seen) override {
    return vision::WorldFromTags(camera, tags, seen);
  }
  WorldFrame WorldFromFirstPose(const std::vector<Eigen::Isometry3d>& camera_from_tag,
                                double tag_height_m) override {
    return vision::WorldFromFirstPose(camera_from_tag, tag_height_m);
  }
  std::optional<double> MovedBy_m(const CameraModel& camera,
                                  const std::vector<TagDetection>& seen) override {
    return vision::MovedBy_m(camera, seen);
  }
  std::optional<Eigen::Vector2d> MapFromPixel(const CameraModel& camera,
                                              const Eigen::Vector2d& pixel, double z_m) override {
    return vision::MapFromPixel(camera, pixel, z_m);
  }
  std::unique_ptr<PictureMaker> MakePictures(const CameraModel& camera,
                                             const SyntheticCameraOptions& options) override {
    return std::make_unique<SyntheticPictures>(camera, options);
  }
  std::string MissingDisplay() override { return module::MissingDisplay(); }
  std::unique_ptr<TrackWindow> OpenWindow(const std::string& title) override {
    return vision::OpenTrackWindow(title);
  }
};

}  // namespace

std::unique_ptr<Vision> LoadVision() { return std::make_unique<OpenCvVision>(); }

}  // namespace rift::vision
