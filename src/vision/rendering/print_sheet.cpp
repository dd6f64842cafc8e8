#include "rift/vision/rendering/print_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "rift/vision/tracking/tag_detector.hpp"

namespace rift::vision {
namespace {

constexpr double kMargin_mm = 8.0;  // that printers leave white
constexpr double kCaption_mm = 14.0;
constexpr double kRuler_mm = 100.0;

struct Paper {
  double width_mm, height_mm;
};
constexpr Paper kA4{210.0, 297.0}, kA3OnItsSide{420.0, 297.0};

/// The smallest sheet with room for the picture above its caption.
Paper PaperFor(double width_mm, double height_mm, const std::string& what) {
  for (const Paper& paper : {kA4, kA3OnItsSide}) {
    const bool fits = width_mm + 2.0 * kMargin_mm <= paper.width_mm &&
                      height_mm + 2.0 * kMargin_mm + kCaption_mm <= paper.height_mm;
    if (fits) return paper;
  }
  throw std::invalid_argument(
      fmt::format("{} of {:g} x {:g} mm does not go on A3", what, width_mm, height_mm));
}

std::string Rectangle(double x_mm, double y_mm, double width_mm, double height_mm) {
  return fmt::format("<rect x=\"{:.4f}\" y=\"{:.4f}\" width=\"{:.4f}\" height=\"{:.4f}\"/>\n", x_mm,
                     y_mm, width_mm, height_mm);
}

std::string Line(double y_mm, const std::string& text) {
  return fmt::format(
      "<text x=\"{}\" y=\"{}\" font-family=\"sans-serif\" font-size=\"3.2\">{}</text>\n",
      kMargin_mm, y_mm, text);
}

std::string Ruler(const Paper& paper, const std::string& caption) {
  const double y_mm = paper.height_mm - kMargin_mm;
  const std::string ruler = fmt::format(
      "<path d=\"M{0} {1}h{2}M{0} {3}v3M{4} {3}v3\" stroke=\"black\" stroke-width=\"0.2\" "
      "fill=\"none\"/>\n",
      kMargin_mm, y_mm, kRuler_mm, y_mm - 1.5, kMargin_mm + kRuler_mm);
  return Line(y_mm - 7.0, caption) +
         Line(y_mm - 3.0,
              fmt::format("This line: {} mm. Print at 100 %, matt, and glue it flat.", kRuler_mm)) +
         ruler;
}

std::string Sheet(const Paper& paper, const std::string& content, const std::string& caption) {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" height=\"{1}mm\" "
             "viewBox=\"0 0 {0} {1}\">\n<path d=\"M0 0h{0}v{1}h-{0}z\" fill=\"white\"/>\n"
             "<g shape-rendering=\"crispEdges\">\n",
             paper.width_mm, paper.height_mm) +
         content + "</g>\n" + Ruler(paper, caption) + "</svg>\n";
}

}  // namespace

std::string TagSheet(int id, double size_m, TagFamily family) {
  const TagCells tag = CellsOfTag(id, family);
  const TagCells::Grid& cells = tag.is_white;
  const int count = tag.shape.cells;
  const double cell_mm = 1e3 * size_m / tag.shape.square;
  const double side_mm = count * cell_mm;
  const Paper paper = PaperFor(side_mm, side_mm, "a tag with its border");
  const double left_mm = 0.5 * (paper.width_mm - side_mm);
  const double top_mm = std::min(30.0, paper.height_mm - kMargin_mm - kCaption_mm - side_mm);
  std::string svg;
  for (int row = 0; row < count; ++row) {
    for (int column = 0; column < count;) {
      int end = column;
      while (end < count && cells[row][end] == cells[row][column]) ++end;
      if (!cells[row][column]) {  // runs in one piece: no hairlines between cells
        svg += Rectangle(left_mm + column * cell_mm, top_mm + row * cell_mm,
                         (end - column) * cell_mm, cell_mm);
      }
      column = end;
    }
  }
  svg += fmt::format(
      "<path d=\"M{0} {1}h{2}v{2}h-{2}z\" stroke=\"#999\" stroke-width=\"0.2\" fill=\"none\"/>\n",
      left_mm, top_mm, side_mm);
  return Sheet(
      paper, svg,
      fmt::format("{} id {}, {} square {:g} mm; cut along the grey line; the robot's front is to "
                  "the right",
                  NameOf(family), id, tag.shape.is_white_square ? "white" : "black", 1e3 * size_m));
}

std::string ChessboardSheet(const Board& board) {
  board.Check();
  const double square_mm = 1e3 * board.square_m;
  const double width_mm = (board.columns + 1) * square_mm;
  const double height_mm = (board.rows + 1) * square_mm;
  const Paper paper = PaperFor(width_mm, height_mm, "a chessboard");
  const double left_mm = 0.5 * (paper.width_mm - width_mm), top_mm = kMargin_mm;
  std::string svg;
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = row % 2; column <= board.columns; column += 2) {
      svg +=
          Rectangle(left_mm + column * square_mm, top_mm + row * square_mm, square_mm, square_mm);
    }
  }
  return Sheet(paper, svg,
               fmt::format("chessboard of {} x {} inner corners, squares of {:g} mm", board.columns,
                           board.rows, square_mm));
}

}  // namespace rift::vision
