#pragma once

#include <string>

#include "rift/vision/calibration/chessboard.hpp"
#include "rift/vision/tracking/tag_family.hpp"

namespace rift::vision {

/// Sheets to be printed, as SVG in millimetres on A4 or, where that is too small, A3 on its side,
/// with a ruler of 100 mm that shows whether a printer has scaled them.

/// A tag whose black square (tagStandard41h12: white square) has sides of size_m, with its border
/// and a thin outline to cut along. Throws std::invalid_argument for an id that the family lacks,
/// or a size that no sheet holds.
std::string TagSheet(int id, double size_m, TagFamily family = TagFamily::k36h11);

/// Throws std::invalid_argument for a board that no sheet holds.
std::string ChessboardSheet(const Board& board);

}  // namespace rift::vision
