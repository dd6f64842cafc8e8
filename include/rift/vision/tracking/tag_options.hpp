#pragma once

namespace rift::vision {

/// Which tag is followed, and when a sighting of it is believed.
struct TagOptions {
  int id = 0;
  double size_m = 0.0475;
  int max_hamming = 1;
  double min_margin = 20.0;
  int least_contrast = 30;
  int acquire_decimate = 3;
  int region_decimate = 2;
  double region_margin = 0.55;
  int recheck_every = 150;
  double lost_after_s = 0.25;
  double corner_sigma_px = 0.02;
  double lens_sigma_px = 0.1;
  double tilt_sigma_rad = 0.25;
  double max_fit_px = 0.6;

  /// Calls field(key, member, min, max, help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("id", self.id, 0, 586, "the robot's tag of the family tag36h11 (authors: 0)");
    field("size_m", self.size_m, 0.005, 1.0,
          "side of the black square in m, the white border left out (authors: 0.0475)");
    field("max_hamming", self.max_hamming, 0, 2, "wrong bits of 36 that are put up with");
    field("min_margin", self.min_margin, 0.0, 127.0,
          "least mean distance of a bit's grey value from the threshold");
    field("least_contrast", self.least_contrast, 5, 200,
          "grey values from the tag's black to its white at least; AprilTag's own 5 is below a "
          "webcam's noise and makes a search nine times as long");
    field("acquire_decimate", self.acquire_decimate, 1, 8,
          "AprilTag looks at every n-th pixel of a whole picture (3: tags down to 30 px)");
    field("region_decimate", self.region_decimate, 1, 8, "the same where the tag is expected");
    field("region_margin", self.region_margin, 0.2, 4.0,
          "how far around the expected tag is read, in sides of the tag");
    field("recheck_every", self.recheck_every, 0, 1'000'000,
          "tracked frames between searches of the whole picture for a second tag of this id; 0: "
          "never");
    field("lost_after_s", self.lost_after_s, 0.0, 10.0,
          "no prediction from a sighting older than this");
    field("corner_sigma_px", self.corner_sigma_px, 0.001, 5.0,
          "scatter of a corner along each axis (rendered truth: 0.015 to 0.02 px); the covariance "
          "scales with its square");
    field("lens_sigma_px", self.lens_sigma_px, 0.001, 5.0,
          "what the calibration may be wrong by within one tag: weighs the corners against the "
          "floor's normal where two poses fit");
    field("tilt_sigma_rad", self.tilt_sigma_rad, 0.01, 3.2,
          "how far the tag may lean from the floor's normal (the trials' ramp: 0.24)");
    field("max_fit_px", self.max_fit_px, 0.05, 10.0,
          "largest RMS distance of edge points or corners from the fitted square");
  }
};

}  // namespace rift::vision
