#pragma once

namespace rift::view {

struct ViewOptions {
  int width_px = 1280;
  int height_px = 720;
  int fps = 30;
  double speed = 1.0;
  double hold_s = 3.0;
  double margin_m = 0.10;
  double ground_cell_m = 0.002;

  /// Calls field(key, member, min, max, help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("width_px", self.width_px, 640, 7680, "width of window and video, even");
    field("height_px", self.height_px, 360, 4320, "height of window and video, even");
    field("fps", self.fps, 1, 240, "pictures for each second of the run");
    field("speed", self.speed, 0.05, 50.0, "seconds of the run for each second at the window");
    field("hold_s", self.hold_s, 0.0, 3600.0,
          "the window closes so long after the end of the run, unless it is paused");
    field("margin_m", self.margin_m, 0.0, 100.0, "floor that is shown around path and waypoints");
    field("ground_cell_m", self.ground_cell_m, 0.0002, 1.0,
          "finest distance at which the ground is sampled (bumps are 0.02 m wide)");
  }
  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;
};

}  // namespace rift::view
