#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace rift::vision {

/// How a camera is doing, in one word.
enum class CameraState {
  kOpening,
  kRunning,
  kUnplugged,    ///< the device or the stream is gone; final
  kFrozen,       ///< no picture comes, or always the same one
  kBlack,        ///< pictures without light
  kWrongFormat,  ///< no pixel format or size that rift can use; final
  kBusy,         ///< another program has it; final
  kEnded,        ///< the last picture of a recording was read; final
};
constexpr std::array<std::string_view, 8> EnumNames(CameraState) {
  return {"opening", "running", "unplugged", "frozen", "black", "wrong format", "busy", "ended"};
}

/// No picture will come any more.
constexpr bool IsFinal(CameraState state) {
  return state == CameraState::kUnplugged || state == CameraState::kWrongFormat ||
         state == CameraState::kBusy || state == CameraState::kEnded;
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
};

}  // namespace rift::vision
