#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rift/vision/calibration/calibration.hpp"

namespace rift::vision {

/// The corners of the views as OpenCV wants them, all of one picture size.
struct FitInput {
  std::vector<const BoardView*> views;
  Board board;

  cv::Size Size() const { return {views.front()->width_px, views.front()->height_px}; }
  std::vector<std::vector<cv::Point3f>> BoardPoints() const;
  std::vector<std::vector<cv::Point2f>> Pixels() const;
};

/// A camera fitted to some views, with what is left of each corner.
struct LensFit {
  CameraModel camera;
  std::vector<ParameterEstimate> parameters;
  std::vector<std::vector<Eigen::Vector2d>> residuals_px;  ///< of each view

  double ViewRms_px(std::size_t view) const;
};

/// Nothing when the fit does not converge (OpenCV's fisheye fit throws on views it dislikes).
std::optional<LensFit> FitLens(const FitInput& input, Lens lens);

/// The same with corners that may leave the board's plane (Strobl and Hirzinger 2011).
struct BentFit {
  double flat_px = kNotComputed;  ///< RMS of the same corners on a flat board
  double rms_px = kNotComputed;
  double bend_m = kNotComputed;  ///< from the lowest to the highest corner
};
BentFit FitBentBoard(const FitInput& input);

/// RMS over the picture of how far two cameras place the same pixels apart on a floor this far
/// away, both posed by that floor. NaN when the second cannot be posed.
double FloorDifference_m(const CameraModel& a, const CameraModel& b, double height_m);

}  // namespace rift::vision
