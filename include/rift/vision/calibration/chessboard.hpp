#pragma once

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

#include "rift/vision/camera/frame.hpp"

namespace rift::vision {

/// A printed chessboard, counted in its inner corners.
struct Board {
  int columns = 13;
  int rows = 9;
  double square_m = 0.025;

  int Corners() const { return columns * rows; }
  /// Throws std::invalid_argument for fewer than 3 x 3 corners or a square of no length.
  void Check() const;
};

/// How a corner list was found.
enum class BoardMethod {
  kNone,     ///< it was not
  kSector,   ///< OpenCV's findChessboardCornersSB (Duda and Frese 2018), refined by cornerSubPix
  kClassic,  ///< findChessboardCorners, refined the same way
};

/// One picture of the board.
struct BoardView {
  std::string name;
  int width_px = 0;
  int height_px = 0;
  BoardMethod method = BoardMethod::kNone;
  /// Row by row, the first of them nearest the picture's upper left, pixel middles at integers.
  std::vector<Eigen::Vector2d> corners;
  double coloured = 0.0;  ///< share of the board's pixels that are neither black, grey nor white
  std::string problem;    ///< why there are no corners; empty otherwise
};

/// How long a picture without a board is looked at.
enum class BoardSearch {
  kThorough,  ///< at several widths by both methods: photographs are few
  kQuick,     ///< one look by each, a fifth of the time: a live camera has the next picture ready
};

/// Looks for the whole board in a picture; a large one is searched at 960 px width. A picture that
/// cannot be decoded or does not show it gives a view that says so.
BoardView FindBoard(const Frame& frame, const Board& board, const std::string& name,
                    BoardSearch search = BoardSearch::kThorough);
BoardView FindBoard(const std::string& path, const Board& board);

/// Where one view has the board, to compare views with (ROS's camera_calibration): shares of the
/// picture, 0 to 1.
struct ViewPlace {
  double x = 0.0, y = 0.0, size = 0.0, skew = 0.0;
};

/// What picture to take next: where the board is missing most.
struct NextView {
  ViewPlace place;   ///< of the board's middle, its size and skew there
  std::string text;  ///< one line for people: position, distance, tilt; "" when nothing is missing
};

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

}  // namespace rift::vision
