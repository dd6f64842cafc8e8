#include <fmt/format.h>

#include <stdexcept>

#include "rift/vision/calibration/chessboard.hpp"

namespace rift::vision {

void Board::Check() const {
  if (columns < 3 || rows < 3 || columns > 100 || rows > 100) {
    throw std::invalid_argument(
        fmt::format("a board of {} x {} inner corners: there must be 3 to 100 both ways (squares "
                    "less one)",
                    columns, rows));
  }
  if (!(square_m > 0.0) || square_m > 10.0) {
    throw std::invalid_argument(
        fmt::format("squares of {} m: the side of one square in metres is needed", square_m));
  }
}

}  // namespace rift::vision
