#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "rift/statistics/not_computed.hpp"
#include "rift/vision/calibration/chessboard.hpp"
#include "rift/vision/calibration/options.hpp"
#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {

enum class CalibrationVerdict { kGood, kUsable, kRefuse };
constexpr std::array<std::string_view, 3> EnumNames(CalibrationVerdict) {
  return {"good", "usable", "refuse"};
}

using statistics::kNotComputed;

/// One picture's part in a calibration.
struct ViewResult {
  BoardView view;
  bool used = false;
  std::string dropped;   ///< why not used; empty when it was
  bool is_copy = false;  ///< not used since it shows the same as an earlier view
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
  NextView next;  ///< what would improve it most; its text is empty when nothing is missing
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

ViewPlace PlaceOf(const BoardView& view, const Board& board);
Coverage CoverageOf(const std::vector<ViewResult>& views, const Board& board);

/// The view unlike all others that raises the coverage most. `enough`: the coverage in x, y, size
/// and skew from which nothing is missing (CalibrationOptions::good_coverage).
NextView NextViewFor(const std::vector<ViewResult>& views, const Board& board, double enough);

/// Draws where the corners were, their errors, and the bars of coverage and of each view. The name
/// ends in .png or .jpg; throws std::runtime_error when it cannot be written.
void DrawCalibration(const Calibration& calibration, const std::filesystem::path& path);

}  // namespace rift::vision
