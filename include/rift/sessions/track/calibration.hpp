#pragma once

#include <functional>
#include <string>

#include "rift/experiment/options.hpp"
#include "rift/vision/calibration/calibration.hpp"
#include "rift/vision/calibration/chessboard.hpp"

namespace rift::sessions {

/// A camera to be calibrated: from photographs, or live.
struct CalibrationJob {
  std::string images;  ///< folder or pattern; empty: `camera` takes them
  std::string camera;
  vision::Board board;
  experiment::TrackOptions options;
  double give_up_s = 0.0;  ///< see vision::SessionOptions
  bool view = false;       ///< shows where to hold the board next
};

/// Throws std::invalid_argument for pictures that make no calibration.
vision::Calibration Calibrate(const CalibrationJob& job, const std::function<bool()>& is_stopped,
                              const std::function<void(const std::string&)>& say);

}  // namespace rift::sessions
