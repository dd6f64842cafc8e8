#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "rift/vision/camera/camera_state.hpp"
#include "rift/vision/camera/capture_options.hpp"
#include "rift/vision/camera/frame.hpp"

namespace rift::vision {

/// Where pictures come from. One thread uses it; only IsPresent may be called from another one.
class CameraSource {
 public:
  virtual ~CameraSource() = default;

  /// Waits for the next picture and fills all of `frame` but its index; false when none came for a
  /// while. Throws CameraError when there will be none. May hang where a driver does.
  virtual bool Read(Frame& frame) = 0;
  /// False once a device is known to be gone, even while Read hangs in its driver.
  virtual bool IsPresent() const { return true; }
  /// A recording waits for its reader, loses nothing and has its own clock.
  virtual bool IsRecording() const { return false; }
};

/// What the words after --camera mean.
enum class SourceKind {
  kDevice,   ///< /dev/video0
  kStream,   ///< http://, https://: MJPEG in parts, its JPEGs untouched
  kNetwork,  ///< rtsp:// and whatever else FFmpeg opens
  kImages,   ///< a glob, a folder, or one picture, in the order of the names
  kVideo,    ///< any other file
};
SourceKind KindOf(std::string_view name);

/// Seconds of the clock that frames are stamped with (steady_clock).
double SteadyNow_s();

/// Opens a camera. Throws CameraError (busy, wrong format, unplugged: with the name, what was tried
/// and what to do), std::invalid_argument for a file or pattern that matches nothing.
std::unique_ptr<CameraSource> OpenCamera(const std::string& name, const CaptureOptions& options);

}  // namespace rift::vision
