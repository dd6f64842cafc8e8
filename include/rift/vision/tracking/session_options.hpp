#pragma once

namespace rift::vision {

/// How a camera session goes: how its world frame is set and watched, when it ends. Each member is
/// a flag of `rift track`.
struct SessionOptions {
  double world_average_s = 1.0;
  double world_patience_s = 20.0;
  int world_decimate = 1;
  double world_limit_m = 0.005;
  double world_scale = 0.05;
  double check_every_s = 10.0;
  int check_decimate = 3;
  double moved_m = 0.005;
  double give_up_s = 5.0;

  /// Calls field(key, member, min, max, help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("world_average_s", self.world_average_s, 0.0, 60.0,
          "the first pose is averaged over this");
    field("world_patience_s", self.world_patience_s, 0.1, 3600.0, "how long tags are looked for");
    field("world_decimate", self.world_decimate, 1, 8,
          "AprilTag looks at every n-th pixel for the tags that set the frame (1: best corners)");
    field("world_limit_m", self.world_limit_m, 1e-5, 10.0,
          "a frame whose points lie further off, RMS, is refused, and so is one with a point twice "
          "as far off where the others put it");
    field("world_scale", self.world_scale, 1e-3, 10.0,
          "a frame in which the robot's tag is so much wider or narrower than printed is refused");
    field("check_every_s", self.check_every_s, 0.1, 3600.0,
          "how often the reference tags are held against where they set the frame");
    field("check_decimate", self.check_decimate, 1, 8,
          "every n-th pixel for that check (3: 20 ms of a 1080p picture, 1: 200 ms)");
    field("moved_m", self.moved_m, 1e-4, 1.0, "the camera was moved when they lie further off");
    field("give_up_s", self.give_up_s, 0.0, 3600.0,
          "ends when the camera stays frozen or black for so long after it was named so");
  }
};

}  // namespace rift::vision
