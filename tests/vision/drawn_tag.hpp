#pragma once

#include <cstdint>

#include "rift/vision/camera/frame.hpp"
#include "rift/vision/tracking/tag_detector.hpp"

namespace rift::test {

/// A tag as it is printed, its cells so many pixels each, on paper of its white: `left_px` of it to
/// the left, a cell on the other sides.
inline vision::Frame DrawnTag(const vision::TagCells& cells, int black = 40, int white = 200,
                              int cell_px = 8, int left_px = 8) {
  const int printed_px = cells.shape.cells * cell_px;
  vision::Frame frame{.width_px = left_px + printed_px + cell_px,
                      .height_px = printed_px + 2 * cell_px};
  for (int y = 0; y < frame.height_px; ++y) {
    for (int x = 0; x < frame.width_px; ++x) {
      const int row = (y - cell_px) / cell_px, column = (x - left_px) / cell_px;
      const bool is_inside =
          y >= cell_px && row < cells.shape.cells && x >= left_px && column < cells.shape.cells;
      const bool is_white = !is_inside || cells.is_white[row][column];
      frame.bytes.push_back(static_cast<std::uint8_t>(is_white ? white : black));
    }
  }
  return frame;
}

/// The same with one of its bits wrong.
inline vision::TagCells WithWrongBit(vision::TagCells cells) {
  for (int row = 0; row < cells.shape.cells; ++row) {
    for (int column = 0; column < cells.shape.cells; ++column) {
      if (!cells.is_bit[row][column]) continue;
      cells.is_white[row][column] = !cells.is_white[row][column];
      return cells;
    }
  }
  return cells;
}

}  // namespace rift::test
