#include "flat_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rift::vision {
namespace {

constexpr double kTransparent = std::numeric_limits<double>::quiet_NaN();
constexpr int kLatticeHalf = 1 << 14;

/// A tag is ten cells wide, its black square eight.
constexpr int kTagCells = 10;
constexpr int kBlackCells = 8;

}  // namespace

int DiscPattern::Cell(double x_m, double y_m) const {
  return x_m * x_m + y_m * y_m < radius_m_ * radius_m_ ? 1 : 0;
}

double DiscPattern::Grey(int cell) const { return cell == 1 ? grey_ : kTransparent; }

int LatticePattern::Cell(double x_m, double y_m) const {
  const double limit = kLatticeHalf - 1;
  const double column = std::clamp(std::floor((x_m - least_.x()) / cell_m_), -limit, limit);
  const double row = std::clamp(std::floor((y_m - least_.y()) / cell_m_), -limit, limit);
  return (static_cast<int>(row) + kLatticeHalf) * (2 * kLatticeHalf) + static_cast<int>(column) +
         kLatticeHalf;
}

double LatticePattern::Grey(int cell) const {
  const int column = cell % (2 * kLatticeHalf) - kLatticeHalf;
  const int row = cell / (2 * kLatticeHalf) - kLatticeHalf;
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return kTransparent;
  return GreyInside(column, row);
}

TagPattern::TagPattern(int id, double size_m, double black_grey, double white_grey)
    : LatticePattern(size_m / kBlackCells,
                     Eigen::Vector2d::Constant(-0.5 * kTagCells * size_m / kBlackCells), kTagCells,
                     kTagCells),
      cells_(CellsOfTag(id)),
      black_grey_(black_grey),
      white_grey_(white_grey) {}

double TagPattern::GreyInside(int column, int row) const {
  return cells_[kTagCells - 1 - row][column] ? white_grey_ : black_grey_;
}

BoardPattern::BoardPattern(const PlacedBoard& board, double black_grey, double white_grey)
    : LatticePattern(board.square_m, Eigen::Vector2d::Constant(-2.0 * board.square_m),
                     board.columns + 3, board.rows + 3),
      columns_(board.columns + 1),
      rows_(board.rows + 1),
      black_grey_(black_grey),
      white_grey_(white_grey) {}

double BoardPattern::GreyInside(int column, int row) const {
  const bool margin = column < 1 || row < 1 || column > columns_ || row > rows_;
  return margin || (column + row) % 2 != 0 ? white_grey_ : black_grey_;
}

}  // namespace rift::vision
