#pragma once

#include "rift/vision/calibration.hpp"
#include "rift/vision/capture_options.hpp"
#include "rift/vision/tag_options.hpp"

namespace rift::vision {

/// The overhead camera as motion capture: the block `track` of an experiment.
struct TrackOptions {
  CaptureOptions capture;
  TagOptions tag;
  CalibrationOptions calibration;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("capture", self.capture, "what is asked of the camera, and when it has failed");
    field("tag", self.tag, "the robot's tag, and when a sighting of it is believed");
    field("calibration", self.calibration, "when a calibration is good, usable or refused");
  }
};

}  // namespace rift::vision
