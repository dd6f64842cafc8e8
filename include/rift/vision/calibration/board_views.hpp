#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rift/vision/calibration/chessboard.hpp"
#include "rift/vision/calibration/options.hpp"
#include "rift/vision/camera/capture_thread.hpp"

namespace rift::vision {

/// Whoever waits while views of the board are gathered.
struct ViewListener {
  std::function<bool()> is_stopped;
  /// One line for the user.
  std::function<void(const std::string&)> say;
};

/// The board in each of the pictures, with those that do not show it. Throws std::runtime_error
/// when it is stopped.
std::vector<BoardView> ViewsFromFiles(const std::vector<std::string>& files, const Board& board,
                                      const ViewListener& listener);

/// Views from a camera before which the board is moved about: those unlike all before are taken
/// until they cover everything, the user ends it, or the recording does. Throws std::runtime_error
/// when the camera fails before there was any.
std::vector<BoardView> ViewsFromCamera(Capture& capture, const Board& board,
                                       const CalibrationOptions& options,
                                       const ViewListener& listener);

}  // namespace rift::vision
