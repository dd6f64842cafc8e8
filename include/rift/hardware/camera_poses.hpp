#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "rift/hardware/pose_source.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/vision/camera/capture_thread.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"

namespace rift::hardware {

/// The overhead camera as the source of poses. A thread of its own takes the newest picture and
/// finds the tag in it, so that nothing ever waits for a picture. The pose is that of the tag, as
/// the simulated motion capture gives it (MocapOptions::tag_ahead_m) and as the authors' logs hold
/// it: simulator, robot and logs speak of the same point.
class CameraPoses : public PoseSource {
 public:
  /// What the camera saw last, for people.
  struct View {
    std::shared_ptr<const vision::Frame> frame;  ///< none before the first
    vision::TrackResult found;
  };

  /// What finds the tag in a picture, such as TagTracker::Track. Its poses must be in the world.
  using FindTag = std::function<vision::TrackResult(const vision::Frame&)>;

  /// `clock` must be the frames' (SteadyClock) and outlive this.
  CameraPoses(std::unique_ptr<vision::Capture> capture, FindTag find_tag, Clock& clock);
  CameraPoses(const CameraPoses&) = delete;
  CameraPoses& operator=(const CameraPoses&) = delete;

  PoseNews Newest() override;
  View Seen() const;
  vision::CaptureStatus Status() const { return capture_->Status(); }

 private:
  void Run(const std::stop_token& stop);
  void TakePicture();

  std::unique_ptr<vision::Capture> capture_;
  FindTag find_tag_;
  Clock& clock_;
  mutable std::mutex mutex_;  // guards what follows
  PoseNews news_;
  View view_;
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace rift::hardware
