#include "drive_camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "enum_name.hpp"
#include "files.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/tracking/world_frame.hpp"

namespace rift::commands {
namespace {

constexpr double kPictureWait_s = 0.1;
constexpr double kMoved_m = 0.005;  // the authors placed their robot by hand within 70 mm

vision::Frame FirstPicture(vision::Capture& capture, const std::string& camera) {
  while (true) {
    if (std::optional<vision::Frame> frame = capture.Next(kPictureWait_s)) return std::move(*frame);
    const vision::CaptureStatus status = capture.Status();
    if (vision::IsFinal(status.state) || status.state == vision::CameraState::kFrozen) {
      throw std::runtime_error(
          fmt::format("the camera {} is {}: {}", camera, NameOf(status.state), status.reason));
    }
  }
}

void CheckSize(const vision::Frame& frame, const std::string& camera, vision::CameraModel& model) {
  if (model.width_px == 0) {  // the authors' calibration files do not tell
    model.width_px = frame.width_px;
    model.height_px = frame.height_px;
  }
  if (frame.width_px == model.width_px && frame.height_px == model.height_px) return;
  throw std::invalid_argument(
      fmt::format("the camera {} gives {}x{} pixels and its calibration is for {}x{}: set "
                  "track.capture.width_px and height_px, or calibrate anew",
                  camera, frame.width_px, frame.height_px, model.width_px, model.height_px));
}

}  // namespace

vision::CameraModel ReadDriveCamera(const std::string& calibration) {
  vision::CameraModel model = vision::ReadCamera(ReadFile(calibration), calibration);
  if (model.world) return model;
  throw std::invalid_argument(fmt::format(
      "{}: the calibration has no world frame, so nobody knows where on the floor the waypoints "
      "are: lay reference tags on the floor and let rift track write it",
      calibration));
}

DriveCamera OpenDriveCamera(const std::string& camera, vision::CameraModel model,
                            const experiment::Experiment& experiment) {
  const vision::TagOptions& tag = experiment.track.tag;
  DriveCamera opened{.capture = vision::OpenCapture(camera, experiment.track.capture),
                     .model = std::move(model)};
  const vision::Frame first = FirstPicture(*opened.capture, camera);
  if (opened.capture->IsRecording()) {
    throw std::invalid_argument(fmt::format(
        "{} is a recording, and a robot is driven by what is seen now: name a device such as "
        "/dev/video0, or a stream such as http://camera/video",
        camera));
  }
  CheckSize(first, camera, opened.model);
  const std::vector<vision::TagDetection> seen =
      vision::FindTags(first, tag.acquire_decimate, tag.max_hamming);
  opened.moved_by_m = vision::MovedBy_m(opened.model, seen);
  opened.robots_tags = static_cast<int>(std::count_if(
      seen.begin(), seen.end(), [&tag](const auto& found) { return found.id == tag.id; }));
  if (opened.robots_tags > 1) {
    throw std::runtime_error(
        fmt::format("{} tags with the robot's id {} are in the picture: take "
                    "away all but the robot's",
                    opened.robots_tags, tag.id));
  }
  return opened;
}

std::vector<std::string> WarningsOf(const DriveCamera& camera) {
  std::vector<std::string> warnings;
  if (camera.moved_by_m && *camera.moved_by_m > kMoved_m) {
    warnings.push_back(fmt::format(
        "warning: the reference tags lie {:.1f} mm from where they set the world frame: the camera "
        "was moved; set the frame again",
        1e3 * *camera.moved_by_m));
  }
  if (camera.robots_tags == 0) {
    warnings.emplace_back("the robot's tag is not in the picture yet: put the robot on its place");
  }
  return warnings;
}

}  // namespace rift::commands
