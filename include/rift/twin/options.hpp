#pragma once

#include "rift/simulation/options.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"

namespace rift::twin {

/// A webcam's stream: 1080p MJPEG of 100 to 200 kB a picture.
inline vision::SyntheticCameraOptions WebcamOptions() {
  vision::SyntheticCameraOptions options;
  options.noise_grey = 2.0;
  options.jpeg_quality = 80;
  return options;
}

/// What the twin adds to the simulated robot: a camera that can be looked through, and when it
/// ends.
struct TwinOptions {
  double fps = 30.0;
  double camera_height_m = 0.87;
  double host_share_s = 0.015;
  int http_port = 0;
  double battery_v = 5.0;
  double still_s = 5.0;
  vision::SyntheticCameraOptions camera = WebcamOptions();

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("fps", self.fps, 1.0, 120.0, "pictures a second");
    field("camera_height_m", self.camera_height_m, 0.3, 5.0,
          "above the floor in m (trials: 0.87), above the middle of the waypoints");
    field("host_share_s", self.host_share_s, 0.0, 0.5,
          "the part of simulation.mocap.processing_s that a host spends for real on reading a "
          "picture and finding the tag; the twin holds a picture back for the rest only");
    field("http_port", self.http_port, 0, 65535, "of the stream on 127.0.0.1; 0: a free one");
    field("battery_v", self.battery_v, 0.0, 30.0, "what the robot says of its battery");
    field("still_s", self.still_s, 0.5, 3600.0,
          "the twin ends when the robot has driven and its motors were then off for so long, in s");
    field("camera", self.camera, "what the pictures look like");
  }
};

/// The simulated robot with `rift drive` as its host, which decides on each picture as it comes,
/// stamps it by its capture, keeps of a tag's two poses the one that fits better, and waits until
/// the line stands. What is told of another host (configs/hosts/authors.yaml) is taken out; one
/// with a period of its own tells the time to its driver alone, to which options.host_share_s
/// comes.
simulation::SimulationOptions WithRiftHost(simulation::SimulationOptions simulation,
                                           const TwinOptions& options);

/// The link with rift's own listener (src/firmware) at its end, which reads its line at once and
/// has 512 bytes of buffer and a watchdog of 0.3 s.
simulation::LinkOptions WithFirmware(simulation::LinkOptions link);

/// The simulated robot as the twin runs it, for `simulate` to run the same: rift's own host and
/// listener, and a camera of options.fps pictures a second. A frame has 11 bytes and three
/// decimals, the simulated robot's line about 10 bytes and two decimals; that difference stays.
simulation::SimulationOptions AsTwin(simulation::SimulationOptions simulation,
                                     const TwinOptions& options);

}  // namespace rift::twin
