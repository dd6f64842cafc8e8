#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/camera/capture_options.hpp"
#include "rift/vision/camera/frame.hpp"

namespace rift::vision {

/// Pictures as `track` and `drive` take them.
class Capture {
 public:
  virtual ~Capture() = default;
  /// A picture that was not given out before, waiting at most `timeout_s` for it. Of a live camera
  /// the newest one, of a recording the next one.
  virtual std::optional<Frame> Next(double timeout_s) = 0;
  /// Never waits; a camera that went silent is named so within CaptureOptions::silent_s.
  virtual CaptureStatus Status() const = 0;
  virtual bool IsRecording() const = 0;
};

/// Opens and reads a source in a thread of its own, always draining it, so that what piles up in
/// drivers and sockets never ages. A thread that hangs in a driver is left behind: neither Next,
/// Status nor the destructor wait for it.
class CaptureThread : public Capture {
 public:
  using Opener = std::function<std::unique_ptr<CameraSource>()>;

  CaptureThread(Opener open, const CaptureOptions& options);
  ~CaptureThread() override;
  CaptureThread(const CaptureThread&) = delete;
  CaptureThread& operator=(const CaptureThread&) = delete;

  std::optional<Frame> Next(double timeout_s) override;
  CaptureStatus Status() const override;
  bool IsRecording() const override;

 private:
  struct Shared;  // outlives this object while its thread hangs
  std::shared_ptr<Shared> shared_;
};

/// The camera of that name (see KindOf), opened in the thread.
std::unique_ptr<Capture> OpenCapture(const std::string& camera, const CaptureOptions& options);

}  // namespace rift::vision
