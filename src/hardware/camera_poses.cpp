#include "rift/hardware/camera_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <exception>
#include <utility>

namespace rift::hardware {
namespace {

constexpr double kPictureWait_s = 0.05;

/// world_from_robot = Rz(yaw) Ry(pitch) Rx(roll).
trial::PoseMeasurement MeasurementOf(const vision::Sighting& sighting) {
  assert(sighting.in_world);
  const Eigen::Matrix3d turn = sighting.map_from_tag.linear();
  const Eigen::Vector3d place = sighting.map_from_tag.translation();
  return {.captured_s = sighting.captured_s,
          .world_from_robot = {place.x(), place.y(), std::atan2(turn(1, 0), turn(0, 0))},
          .z_m = place.z(),
          .roll_rad = std::atan2(turn(2, 1), turn(2, 2)),
          .pitch_rad = -std::asin(std::clamp(turn(2, 0), -1.0, 1.0))};
}

/// A tag that moves never looks so alike twice; a clock drawn into a repeated picture leaves it as
/// it is.
bool IsSamePicture(const vision::TagCorners& a, const vision::TagCorners& b) {
  constexpr double kSame_px = 0.004;
  for (size_t i = 0; i < a.size(); ++i) {
    if ((a[i] - b[i]).cwiseAbs().maxCoeff() > kSame_px) return false;
  }
  return true;
}

/// No sensor is that quiet; a tracker may find other corners in the same bytes.
bool AreSameBytes(const vision::Frame& a, const vision::Frame& b) {
  return !a.bytes.empty() && a.bytes == b.bytes;
}

// A live camera that was silent may come back; one that never spoke will not.
std::optional<std::string> FaultOf(const vision::CaptureStatus& status) {
  const bool never_spoke = status.state == vision::CameraState::kFrozen && status.delivered == 0;
  // A stream that broke off may come back too, but elsewhere in time: no robot waits for that.
  const bool broke_off = status.state == vision::CameraState::kReconnecting;
  if (!vision::IsFinal(status.state) && !never_spoke && !broke_off) return std::nullopt;
  return fmt::format("the camera is {}: {}",
                     vision::EnumNames(status.state)[static_cast<size_t>(status.state)],
                     status.reason);
}

}  // namespace

CameraPoses::CameraPoses(std::unique_ptr<vision::Capture> capture, FindTag find_tag, Clock& clock)
    : capture_(std::move(capture)),
      find_tag_(std::move(find_tag)),
      clock_(clock),
      thread_([this](const std::stop_token& stop) { Run(stop); }) {}

// Whatever ends the thread is told, since without poses the robot must stop.
void CameraPoses::Run(const std::stop_token& stop) {
  try {
    while (!stop.stop_requested()) TakePicture();
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    news_.fault = error.what();
  }
}

void CameraPoses::TakePicture() {
  std::optional<vision::Frame> taken = capture_->Next(kPictureWait_s);
  if (!taken) {
    std::optional<std::string> fault = FaultOf(capture_->Status());
    const std::lock_guard lock(mutex_);
    news_.fault = std::move(fault);
    return;
  }
  vision::TrackResult found = find_tag_(*taken);
  const double ready_s = clock_.Now_s();
  auto frame = std::make_shared<const vision::Frame>(std::move(*taken));
  const std::lock_guard lock(mutex_);
  const bool repeats = found.sighting && view_.found.sighting &&
                       (AreSameBytes(*frame, *view_.frame) ||
                        IsSamePicture(found.sighting->corners, view_.found.sighting->corners));
  if (!repeats) {
    news_.repeats_since_s.reset();
  } else if (!news_.repeats_since_s) {
    news_.repeats_since_s = view_.frame->captured_s;
  }
  news_.looked_s = frame->captured_s;
  // Of two tags with the robot's id nobody knows which one to steer: no pose is news then.
  if (found.sighting && found.sighting->state == vision::TrackState::kTracked) {
    news_.newest = PoseSample{MeasurementOf(*found.sighting), frame->arrived_s, ready_s};
  }
  view_ = {std::move(frame), std::move(found)};
}

PoseNews CameraPoses::Newest() {
  const std::lock_guard lock(mutex_);
  return news_;
}

CameraPoses::View CameraPoses::Seen() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

}  // namespace rift::hardware
