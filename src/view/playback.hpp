#pragma once

namespace rift::view {

/// Where a window is in its film.
struct Playback {
  double t_s = 0.0;  ///< of the film
  double speed = 1.0;
  bool paused = false;
  bool left = false;          ///< the user is done
  double over_since_s = 0.0;  ///< at the window, how long the end has been shown
};

/// After a key as cv::waitKeyEx reports it; -1 is no key.
Playback AfterKey(Playback playback, int key);
/// After `dt_s` seconds at the window.
Playback AfterTime(Playback playback, double dt_s, double duration_s);

}  // namespace rift::view
