#pragma once

namespace rift::vision {

/// How a camera session goes: how its world frame is set and watched, when it ends. Each member is
/// a flag of `rift track`.
struct SessionOptions {
  double tag_height_m = 0.03;
  double world_average_s = 1.0;
  double world_patience_s = 20.0;
  int world_decimate = 1;
  double check_every_s = 10.0;
  int check_decimate = 3;
  double moved_m = 0.005;
  double give_up_s = 0.3;

  /// Calls field(key, member, min, max, help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("tag_height_m", self.tag_height_m, 0.0, 2.0,
          "of the robot's tag above the floor, where its first pose sets the frame");
    field("world_average_s", self.world_average_s, 0.0, 60.0,
          "the first pose is averaged over this");
    field("world_patience_s", self.world_patience_s, 0.1, 3600.0, "how long tags are looked for");
    field("world_decimate", self.world_decimate, 1, 8,
          "AprilTag looks at every n-th pixel for the tags that set the frame (1: best corners)");
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
