#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "rift/vision/calibration/calibration.hpp"
#include "rift/vision/camera/capture_thread.hpp"

namespace rift::vision {

/// How far the views of a board before a camera have come, for the one who holds the board.
struct LiveScene {
  const Frame* frame = nullptr;         ///< the newest picture; none: nothing came yet
  const BoardView* searched = nullptr;  ///< the newest picture that was searched for the board
  const std::vector<BoardView>* taken = nullptr;
  Board board;
  Coverage coverage;  ///< of those that were taken
  NextView next;
  std::string advice;  ///< one line: what keeps the picture from being taken, or how to move on
  bool takes_by_itself = true;
  int good_views = 0;
  double good_coverage = 0.0;
  CaptureStatus status;
};

/// What the one who holds the board asked for since the last moment.
struct LiveInput {
  bool take = false;    ///< the next picture that shows the board, however like another one
  bool undo = false;    ///< the last view that was taken
  bool toggle = false;  ///< whether views are taken by themselves
  bool finish = false;  ///< calibrate with what was taken
};

/// Whoever waits while views come from a camera.
struct LiveListener {
  std::function<bool()> is_stopped;
  /// One line for the user.
  std::function<void(const std::string&)> say;
  /// Called for each new picture and some times a second; none: there is no window.
  std::function<LiveInput(const LiveScene&)> show;
  double give_up_s = 5.0;  ///< ends when the camera is frozen or black for so long
  double hint_s = 6.0;     ///< without a view for so long, what is wrong is said
};

/// Views from a camera before which the board is moved about. Those unlike all before and, of a
/// live camera, held still are taken by themselves, until they cover everything, the user ends it
/// or the recording does. The board is looked for in a thread of its own, so that the window goes
/// on; a recording is searched picture by picture. Throws std::runtime_error when the camera fails
/// before there was any view.
std::vector<BoardView> ViewsFromCamera(Capture& capture, const Board& board,
                                       const CalibrationOptions& options,
                                       const LiveListener& listener);

/// How the board has to be moved from one place to another, in words; "" when it is there.
std::string WayTo(const ViewPlace& now, const ViewPlace& next);

/// Where the outline of a board lies whose place this is: upper left, upper right, lower right and
/// lower left corner in px, with all of the board in the picture where that is possible. A tilted
/// one is drawn as from afar.
std::array<Eigen::Vector2d, 4> OutlineAt(const ViewPlace& place, const Board& board, int width_px,
                                         int height_px);

}  // namespace rift::vision
