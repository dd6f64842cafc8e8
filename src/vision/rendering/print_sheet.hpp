#pragma once

#include <string>

#include "rift/vision/calibration/chessboard.hpp"

namespace rift::vision {

/// Sheets to be printed, as SVG in millimetres on A4 or, where that is too small, A3 on its side,
/// with a ruler of 100 mm that shows whether a printer has scaled them.

/// A tag36h11 whose black square has sides of size_m, with its white border and a thin outline to
/// cut along. Throws std::invalid_argument for an id that the family lacks, or a size that no sheet
/// holds.
std::string TagSheet(int id, double size_m);

/// Throws std::invalid_argument for a board that no sheet holds.
std::string ChessboardSheet(const Board& board);

}  // namespace rift::vision
