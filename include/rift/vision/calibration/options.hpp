#pragma once

namespace rift::vision {

/// When a calibration is good, usable or refused.
struct CalibrationOptions {
  double outlier_factor = 3.0;
  double outlier_px = 0.5;
  double same_px = 1.0;
  int least_views = 4;
  int good_views = 10;
  double good_px = 0.5;
  double refuse_px = 4.0;
  double good_floor_m = 0.001;
  double refuse_floor_m = 0.010;
  double camera_height_m = 0.87;
  double good_coverage = 0.75;
  double fisheye_gain = 0.9;
  double bent_gain = 0.7;
  double coloured_share = 0.004;

  /// Calls field(key, member, min, max, help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("outlier_factor", self.outlier_factor, 1.0, 100.0,
          "a view is dropped when its error exceeds so many times the median of all views ...");
    field("outlier_px", self.outlier_px, 0.0, 100.0, "... and this");
    field("same_px", self.same_px, 0.0, 100.0,
          "a view whose corners lie this near to those of another one, RMS, is a copy and ignored");
    field("least_views", self.least_views, 3, 1000, "fewer usable views: refuse");
    field("good_views", self.good_views, 3, 1000, "fewer usable views: not good");
    field("good_px", self.good_px, 0.01, 100.0, "largest RMS error of a good calibration");
    field("refuse_px", self.refuse_px, 0.01, 100.0, "larger RMS error: refuse");
    field("good_floor_m", self.good_floor_m, 0.0, 1.0, "largest floor error of a good calibration");
    field("refuse_floor_m", self.refuse_floor_m, 0.0, 1.0, "larger floor error: refuse");
    field("camera_height_m", self.camera_height_m, 0.05, 100.0,
          "from the floor for which the error is stated (trials: 0.87)");
    field("good_coverage", self.good_coverage, 0.0, 1.0,
          "least coverage in x, y, size and skew of a good calibration");
    field("fisheye_gain", self.fisheye_gain, 0.1, 1.0,
          "the fisheye model is taken when its error is at most so many times the other's");
    field("bent_gain", self.bent_gain, 0.1, 1.0,
          "the board is called bent when letting it bend brings the error below so many times");
    field("coloured_share", self.coloured_share, 0.0, 1.0,
          "a larger share of coloured pixels on the board means that it was drawn over");
  }
};

}  // namespace rift::vision
