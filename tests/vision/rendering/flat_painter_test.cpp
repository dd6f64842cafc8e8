#include "vision/rendering/flat_painter.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rift::vision {
namespace {

/// A centimetre of a plane one metre before it is a pixel; its middle is the corner of four.
CameraModel Camera() {
  CameraModel camera{.width_px = 64, .height_px = 48};
  camera.k << 100.0, 0.0, 31.5, 0.0, 100.0, 23.5, 0.0, 0.0, 1.0;
  camera.distortion = {0.0, 0.0, 0.0, 0.0};
  return camera;
}

Eigen::Isometry3d At(double x_m, double y_m, double z_m = 1.0) {
  return Eigen::Isometry3d(Eigen::Translation3d(x_m, y_m, z_m));
}

/// What the pattern makes of a canvas of 200 grey values.
cv::Mat1f Painted(const FlatPattern& pattern, const Eigen::Isometry3d& pose,
                  int fine = FlatPainter::kFine) {
  const CameraModel camera = Camera();
  cv::Mat1f canvas(48, 64, 200.0F);
  FlatPainter(camera).Paint(
      pattern, [&](double) { return pose; }, Footprint(camera, pattern, pose), {0, 0, 64, 48},
      canvas, fine);
  return canvas;
}

TEST_CASE("A disc darkens as many pixels as it covers, about its middle") {
  const cv::Mat1f canvas = Painted(DiscPattern(0.1, 50.0), At(0.03, -0.02));
  double dark = 0.0, x = 0.0, y = 0.0;
  for (int row = 0; row < 48; ++row) {
    for (int column = 0; column < 64; ++column) {
      const double share = (200.0 - canvas(row, column)) / 150.0;
      CHECK((share >= 0.0 && share <= 1.0));
      dark += share;
      x += share * column;
      y += share * row;
    }
  }
  CHECK(dark == Approx(M_PI * 100.0).epsilon(0.003));
  CHECK(x / dark == Approx(34.5).margin(0.01));
  CHECK(y / dark == Approx(21.5).margin(0.01));
}

TEST_CASE("A pixel on an edge is the mean of its points, of either side or of what lies under it") {
  // Cells of 8 px with black at the first; a board of one square's margin about 3 by 3 corners.
  const BoardPattern board({.columns = 3, .rows = 3, .square_m = 0.08}, 20.0, 220.0);
  CHECK(board.LeastCorner() == Eigen::Vector2d(-0.16, -0.16));
  CHECK((board.GreatestCorner() - Eigen::Vector2d(0.32, 0.32)).norm() < 1e-12);
  // Its origin, the first inner corner, a quarter of a pixel right and half a pixel below the
  // upper left corner of pixel (24, 20).
  const cv::Mat1f canvas = Painted(board, At(-0.08 + 0.0025, -0.04 + 0.005));
  CHECK(canvas(20, 20) == Approx(0.5 * 20.0 + 0.5 * 220.0));  // above: black, below: white
  CHECK(canvas(16, 24) == Approx(0.25 * 20.0 + 0.75 * 220.0));
  CHECK(canvas(18, 20) == 20.0F);
  CHECK(canvas(18, 28) == 220.0F);
  CHECK(canvas(24, 20) == 220.0F);
  CHECK(canvas(24, 28) == 20.0F);
  CHECK(canvas(20, 24) ==
        Approx(0.5 * (0.25 * 20.0 + 0.75 * 220.0) + 0.5 * (0.25 * 220.0 + 0.75 * 20.0)));
  // Its left edge lies 16 px left of that, over the canvas.
  CHECK(canvas(18, 8) == Approx(0.25 * 200.0 + 0.75 * 220.0));
  CHECK(canvas(18, 7) == 200.0F);
  CHECK(canvas(18, 9) == 220.0F);
}

TEST_CASE("A board is margin, then squares of which those at its corners are black, then nothing") {
  const BoardPattern board({.columns = 3, .rows = 4, .square_m = 1.0}, 20.0, 220.0);
  const auto grey = [&](double x, double y) { return board.Grey(board.Cell(x, y)); };
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 4; ++column) {
      CHECK(grey(column - 0.5, row - 0.5) == ((row + column) % 2 == 0 ? 20.0 : 220.0));
    }
  }
  for (const auto& [x, y] : {std::pair{-1.5, -0.5}, {3.5, 0.5}, {0.5, -1.5}, {0.5, 4.5}}) {
    CHECK(grey(x, y) == 220.0);
  }
  for (const auto& [x, y] :
       {std::pair{-2.1, 0.0}, {4.1, 0.0}, {0.0, -2.1}, {0.0, 5.1}, {1e9, -1e9}}) {
    CHECK(std::isnan(grey(x, y)));
  }
}

TEST_CASE("A tag's cells stand as they are printed, rows from the top, its middle at nought") {
  for (const TagFamily family : {TagFamily::k36h11, TagFamily::kStandard41h12}) {
    const TagCells cells = CellsOfTag(5, family);
    const TagPattern tag(cells, 0.01 * cells.shape.square, 20.0, 220.0);  // cells of 0.01
    const int count = cells.shape.cells;
    int wrong = 0;
    for (int row = 0; row < count; ++row) {
      for (int column = 0; column < count; ++column) {
        const double x = 0.01 * (column + 0.5 - 0.5 * count), y = 0.01 * (0.5 * count - row - 0.5);
        wrong += tag.Grey(tag.Cell(x, y)) != (cells.is_white[row][column] ? 220.0 : 20.0);
      }
    }
    CHECK(wrong == 0);
    CHECK(tag.LeastCorner().x() == Approx(-0.005 * count));
    CHECK(tag.GreatestCorner().y() == Approx(0.005 * count));
  }
}

TEST_CASE("A footprint holds the pattern with a pixel to spare, within the picture") {
  const CameraModel camera = Camera();
  const DiscPattern disc(0.1, 50.0);
  // From 21.5 to 41.5 px in x, from 13.5 to 33.5 in y.
  CHECK(Footprint(camera, disc, At(0.0, 0.0)) == Region{20, 12, 24, 24});
  CHECK(Footprint(camera, disc, At(-0.3, 0.0)) == Region{0, 12, 14, 24});
  CHECK(Footprint(camera, disc, At(0.0, 0.22)) == Region{20, 34, 24, 14});
  CHECK(Footprint(camera, disc, At(5.0, 0.0)).empty());
  CHECK(Footprint(camera, disc, At(-5.0, 0.0)).empty());
  CHECK(Footprint(camera, disc, At(0.0, 0.0, -1.0)).empty());
  Eigen::Isometry3d upright = At(0.0, 0.0, 0.05);  // partly behind the camera
  upright.linear() = Eigen::AngleAxisd(M_PI / 2.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
  CHECK(Footprint(camera, disc, upright).empty());
}

TEST_CASE("Each row of a picture has the pose of its own moment") {
  const CameraModel camera = Camera();
  const DiscPattern disc(0.05, 50.0);
  cv::Mat1f canvas(48, 64, 200.0F);
  FlatPainter(camera).Paint(
      disc, [](double row) { return At(row < 23.5 ? -0.1 : 0.1, 0.0); }, {0, 0, 64, 48},
      {0, 0, 64, 48}, canvas);
  CHECK(canvas(20, 21) == 50.0F);
  CHECK(canvas(20, 42) == 200.0F);
  CHECK(canvas(26, 42) == 50.0F);
  CHECK(canvas(26, 21) == 200.0F);
}

}  // namespace
}  // namespace rift::vision
