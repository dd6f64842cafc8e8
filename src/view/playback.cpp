#include "playback.hpp"

#include <algorithm>

namespace rift::view {
namespace {

// X11 key symbols (keysymdef.h); OpenCV's Qt and GTK windows both hand these on.
enum Key { kEscape = 27, kSpace = 32, kLeft = 0xFF51, kUp, kRight, kDown };
constexpr double kSlowest = 1.0 / 32.0;
constexpr double kFastest = 64.0;

}  // namespace

Playback AfterKey(Playback playback, int key) {
  if (key == 'q' || key == 'Q' || key == kEscape) playback.left = true;
  if (key == kSpace) playback.paused = !playback.paused;
  if (key == 'r' || key == 'R') {
    playback.t_s = playback.over_since_s = 0.0;
    playback.paused = false;
  }
  if (key == kUp || key == kRight) playback.speed = std::min(2.0 * playback.speed, kFastest);
  if (key == kDown || key == kLeft) playback.speed = std::max(0.5 * playback.speed, kSlowest);
  return playback;
}

Playback AfterTime(Playback playback, double dt_s, double duration_s) {
  if (playback.paused) return playback;
  if (playback.t_s >= duration_s) playback.over_since_s += dt_s;
  playback.t_s = std::min(playback.t_s + dt_s * playback.speed, duration_s);
  return playback;
}

}  // namespace rift::view
