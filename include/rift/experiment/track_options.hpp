#pragma once

#include "rift/vision/calibration/options.hpp"
#include "rift/vision/camera/capture_options.hpp"
#include "rift/vision/tracking/tag_options.hpp"

namespace rift::experiment {

/// The overhead camera as motion capture: the block `track` of an experiment.
struct TrackOptions {
  vision::CaptureOptions capture;
  vision::TagOptions tag;
  vision::CalibrationOptions calibration;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("capture", self.capture, "what is asked of the camera, and when it has failed");
    field("tag", self.tag, "the robot's tag, and when a sighting of it is believed");
    field("calibration", self.calibration, "when a calibration is good, usable or refused");
  }
};

}  // namespace rift::experiment
