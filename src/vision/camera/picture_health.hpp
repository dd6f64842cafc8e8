#pragma once

#include <optional>
#include <string>

#include "rift/vision/camera/camera_state.hpp"
#include "rift/vision/camera/capture_options.hpp"
#include "rift/vision/camera/frame.hpp"

namespace rift::vision {

/// Tells pictures of a working camera from those of one that repeats itself or sees no light.
class PictureHealth {
 public:
  explicit PictureHealth(const CaptureOptions& options) : options_(options) {}

  /// kRunning, kFrozen or kBlack; Reason() says why. Throws CameraError (wrong format) for a
  /// picture that cannot be decoded when it is looked at.
  CameraState Look(const Frame& frame);
  std::string Reason() const;

 private:
  void LookForLight(const Frame& frame);

  CaptureOptions options_;
  std::optional<std::uint64_t> hash_;
  double same_since_s_ = 0.0;
  double same_for_s_ = 0.0;
  double looked_s_ = -1e9;
  double brightness_ = 255.0;
  int undecodable_ = 0;
};

}  // namespace rift::vision
