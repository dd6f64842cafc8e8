#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "rift/vision/camera/capture_options.hpp"
#include "rift/vision/camera/frame.hpp"

namespace rift::vision {

/// How a camera is doing, in one word.
enum class CameraState {
  kOpening,
  kRunning,
  kUnplugged,     ///< the device or the stream is gone; final
  kFrozen,        ///< no picture comes, or always the same one
  kBlack,         ///< pictures without light
  kWrongFormat,   ///< no pixel format or size that rift can use; final
  kBusy,          ///< another program has it; final
  kEnded,         ///< the last picture of a recording was read; final
  kRefused,       ///< the server says that it will not give this stream; final
  kReconnecting,  ///< a network camera is gone and is asked again
};
constexpr std::array<std::string_view, 10> EnumNames(CameraState) {
  return {"opening",      "running", "unplugged", "frozen",  "black",
          "wrong format", "busy",    "ended",     "refused", "reconnecting"};
}

/// No picture will come any more.
constexpr bool IsFinal(CameraState state) {
  return state == CameraState::kUnplugged || state == CameraState::kWrongFormat ||
         state == CameraState::kBusy || state == CameraState::kEnded ||
         state == CameraState::kRefused;
}

/// What a source throws when it cannot give pictures; `what()` is one line for people.
class CameraError : public std::runtime_error {
 public:
  CameraError(CameraState camera_state, const std::string& reason)
      : std::runtime_error(reason), state(camera_state) {}
  CameraState state;
};

/// A camera as its capture thread sees it.
struct CaptureStatus {
  CameraState state = CameraState::kOpening;
  std::string reason;           ///< why it is not running, one line; empty while it runs
  double rate_hz = 0.0;         ///< pictures a second, measured over the last second; 0: too few
  double latency_s = 0.0;       ///< from the light to memory, of the newest picture
  std::uint64_t delivered = 0;  ///< pictures that the camera gave
  std::uint64_t dropped = 0;    ///< of those, replaced by a newer one before anybody took them
  std::uint64_t skipped = 0;    ///< beside those: damaged, of another size, or over the budget
  int reconnects = 0;           ///< how often a network camera was asked again
};

/// What a source has met so far.
struct SourceNotes {
  std::uint64_t skipped = 0;  ///< parts, files or pictures that were passed over
  int reconnects = 0;
  std::string interruption;  ///< why no picture comes just now, one line; empty while they do
};

/// Where pictures come from. One thread uses it; only IsPresent may be called from another one.
class CameraSource {
 public:
  virtual ~CameraSource() = default;

  /// Waits for the next picture and fills all of `frame` but its index; false when none came for a
  /// while. Throws CameraError when there will be none. May hang where a driver does.
  virtual bool Read(Frame& frame) = 0;
  /// Asked by the same thread after each Read.
  virtual SourceNotes Notes() const { return {}; }
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
  kImages,   ///< a glob, a folder, or one picture, in the order of the numbers in their names
  kVideo,    ///< any other file
};
SourceKind KindOf(std::string_view name);

/// A camera's name as it is said and written: user and password of an address are left out,
/// `http://***@camera/video`, and of its parameters those that are passwords by their names,
/// `http://camera/video?pwd=***`.
std::string WithoutPassword(const std::string& name);

/// Opens a camera. Throws CameraError (busy, wrong format, unplugged: with the name, what was tried
/// and what to do), std::invalid_argument for a file or pattern that matches nothing.
std::unique_ptr<CameraSource> OpenCamera(const std::string& name, const CaptureOptions& options);

/// The pictures of a folder, of a glob (`run/*.jpg`), or one file, in natural order: frame2 before
/// frame10. Throws std::invalid_argument when there is none.
std::vector<std::string> ImageFiles(const std::string& pattern);

/// What to tell of pictures whose times are neither given nor counted by their names, one line;
/// none of any other camera. Throws as ImageFiles does.
std::optional<std::string> GuessedTimes(const std::string& camera, const CaptureOptions& options);

}  // namespace rift::vision
