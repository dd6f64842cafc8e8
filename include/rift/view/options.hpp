#pragma once

namespace rift::view {

/// How a run is shown in a window or a video.
struct ViewOptions {
  int width_px = 1280;           ///< of window and video, even
  int height_px = 720;           ///< of window and video, even
  int fps = 30;                  ///< pictures for each second of the run
  double speed = 1.0;            ///< seconds of the run for each second at the window
  double hold_s = 3.0;           ///< the window closes so long after the run's end, unless paused
  double margin_m = 0.10;        ///< floor that is shown around path and waypoints
  double ground_cell_m = 0.002;  ///< finest sampling of the ground (bumps are 0.02 m wide)

  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;
};

}  // namespace rift::view
