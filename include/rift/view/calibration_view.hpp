#pragma once

#include "rift/vision/calibration/live_views.hpp"

namespace rift::view {

/// What a key does, as cv::waitKeyEx reports it; negative: there was none.
vision::LiveInput LiveInputOf(int key);

/// The window in which a board is held before a camera: the picture with the corners that were
/// found, where to hold the board next, and what is covered. For one thread.
class CalibrationView {
 public:
  /// Throws std::runtime_error with MissingDisplay() where that is not empty.
  CalibrationView();
  ~CalibrationView();
  CalibrationView(const CalibrationView&) = delete;
  CalibrationView& operator=(const CalibrationView&) = delete;

  vision::LiveInput Show(const vision::LiveScene& scene);
};

}  // namespace rift::view
