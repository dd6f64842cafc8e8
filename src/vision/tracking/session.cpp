#include "rift/vision/tracking/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/camera/steady_now.hpp"
#include "rift/vision/tracking/world_frame.hpp"

namespace rift::vision {
namespace {

constexpr double kPictureWait_s = 0.1;

CaptureOptions AtSizeOf(const CameraModel& camera, CaptureOptions options) {
  if (camera.width_px > 0) options.width_px = camera.width_px;
  if (camera.height_px > 0) options.height_px = camera.height_px;
  return options;
}

}  // namespace

CameraSession::CameraSession(std::string name, CameraModel camera, CaptureOptions capture,
                             const TagOptions& tag)
    : name_(std::move(name)),
      camera_(std::move(camera)),
      options_(AtSizeOf(camera_, std::move(capture))),
      tag_(tag),
      capture_(OpenCapture(name_, options_)) {}

std::optional<Frame> CameraSession::FirstPicture(const std::function<bool()>& go_on) {
  const std::string name = WithoutPassword(name_);
  std::optional<Frame> frame;
  while (!(frame = capture_->Next(kPictureWait_s))) {
    if (!go_on()) return std::nullopt;
    const CaptureStatus status = capture_->Status();
    if (!IsFinal(status.state) && status.state != CameraState::kFrozen) continue;
    throw std::runtime_error(fmt::format(
        "the camera {} is {}: {}", name,
        EnumNames(status.state)[static_cast<std::size_t>(status.state)], status.reason));
  }
  if (camera_.width_px == 0 || camera_.height_px == 0) {
    camera_.width_px = frame->width_px;
    camera_.height_px = frame->height_px;
    if (const auto why = WhyNoLens(camera_)) {
      throw std::invalid_argument(fmt::format(
          "the camera {} gives {}x{} pixels, for which its calibration does not say whether it was "
          "made: {}",
          name, frame->width_px, frame->height_px, *why));
    }
  }
  RequireSize(*frame);
  return frame;
}

void CameraSession::RequireSize(const Frame& frame) const {
  if (frame.width_px == camera_.width_px && frame.height_px == camera_.height_px) return;
  throw std::invalid_argument(fmt::format(
      "the camera {} gives {}x{} pixels and its calibration is for {}x{}: set the camera to that "
      "size, or calibrate anew",
      WithoutPassword(name_), frame.width_px, frame.height_px, camera_.width_px,
      camera_.height_px));
}

Look CameraSession::LookAt(const Frame& frame, int decimate) const {
  const std::vector<TagDetection> seen = FindTags(frame, decimate, tag_);
  const auto robots = std::count_if(seen.begin(), seen.end(),
                                    [&](const auto& found) { return found.id == tag_.id; });
  return {.robot_tags = static_cast<int>(robots), .moved_m = MovedBy_m(camera_, seen)};
}

void CameraSession::Restart() {
  if (capture_->IsRecording()) capture_ = OpenCapture(name_, options_);
}

TagTracker CameraSession::MakeTracker(const std::vector<int>& further_ids) const {
  return {camera_, tag_, SteadyNow_s, further_ids};
}

std::optional<std::string> MovedWarning(const std::optional<double>& moved_m, double limit_m) {
  if (!moved_m || *moved_m <= limit_m) return std::nullopt;
  return fmt::format(
      "the camera was moved: the reference tags lie {:.1f} mm off; set the world frame again",
      1e3 * *moved_m);
}

std::optional<std::string> UnseenReferences(const CameraModel& camera, const Look& look) {
  if (!camera.world || camera.world->marks.empty() || look.moved_m) return std::nullopt;
  return fmt::format(
      "none of the {} reference tags that set the world frame is in the picture, so that nothing "
      "tells whether the camera was moved since: lay them where they lay, or set the frame again",
      camera.world->marks.size());
}

}  // namespace rift::vision
