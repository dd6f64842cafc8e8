#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "rift/vision/camera_model.hpp"
#include "rift/vision/chessboard.hpp"

namespace rift::vision {

struct CalibrationOptions {
  double outlier_factor = 3.0;
  double outlier_px = 0.5;
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

enum class CalibrationVerdict { kGood, kUsable, kRefuse };
constexpr std::array<std::string_view, 3> EnumNames(CalibrationVerdict) {
  return {"good", "usable", "refuse"};
}

inline constexpr double kNotComputed = std::numeric_limits<double>::quiet_NaN();

/// One picture's part in a calibration.
struct ViewResult {
  BoardView view;
  bool used = false;
  std::string dropped;  ///< why not used; empty when it was
  double rms_px = kNotComputed;
  std::vector<Eigen::Vector2d> residuals_px;  ///< seen minus predicted, of each corner
};

/// Shares of what good views span together, 1 is plenty (the measure of ROS's camera_calibration:
/// 0.7 of the picture in x and y, 0.4 in size, 0.5 in skew).
struct Coverage {
  double x = 0.0;
  double y = 0.0;
  double size = 0.0;
  double skew = 0.0;
  double picture = 0.0;  ///< share of an 8 x 6 grid over the picture that holds a corner
};

struct ParameterEstimate {
  std::string name;
  double value = 0.0;
  double deviation = kNotComputed;  ///< standard deviation as the fit states it
};

struct Calibration {
  CameraModel camera;
  Board board;
  CalibrationVerdict verdict = CalibrationVerdict::kRefuse;
  std::vector<std::string> reasons;  ///< why it is not good, one line each
  double rms_px = kNotComputed;
  double plumb_bob_px = kNotComputed;
  double equidistant_px = kNotComputed;
  double flat_px = kNotComputed;        ///< error of some corners on a flat board ...
  double bent_px = kNotComputed;        ///< ... and on one that may bend
  double bend_m = kNotComputed;         ///< how far its corners then leave their plane
  double cross_check_m = kNotComputed;  ///< on the floor, odd views against even ones, RMS
  double floor_error_m = kNotComputed;  ///< that the calibration implies, RMS over the picture
  Coverage coverage;
  std::vector<ParameterEstimate> parameters;
  std::vector<ViewResult> views;
};

/// Fits a camera to pictures of a board. Views without corners, of another size than most or far
/// off the others are left out and named. Never throws for bad pictures: the verdict is "refuse"
/// with the reasons, and without a fit camera.width_px is 0.
/// The floor error: pixels all over the picture are laid on a floor at camera_height_m once with
/// the camera of the odd views and once with that of the even ones, each posed by that floor, as
/// reference tags would do; half their difference (a half of the views has twice the variance, and
/// a difference twice again), and the RMS error of the corners seen from that height.
Calibration Calibrate(const std::vector<BoardView>& views, const Board& board,
                      const CalibrationOptions& options = {});

/// One view alone; how new views are told from those there are (ROS's camera_calibration).
struct ViewPlace {
  double x = 0.0, y = 0.0, size = 0.0, skew = 0.0;
};
ViewPlace PlaceOf(const BoardView& view, const Board& board);
Coverage CoverageOf(const std::vector<ViewResult>& views, const Board& board);

/// Draws where the corners were, their errors, and the bars of coverage and of each view. The name
/// ends in .png or .jpg; throws std::runtime_error when it cannot be written.
void DrawCalibration(const Calibration& calibration, const std::filesystem::path& path);

}  // namespace rift::vision
