#include "flat_painter.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {
namespace {

constexpr double kTransparent = std::numeric_limits<double>::quiet_NaN();
constexpr int kLatticeHalf = 1 << 14;

/// Points around the box, many on each side: the lens bends its outline.
std::vector<Eigen::Vector3d> Outline(const FlatPattern& pattern,
                                     const Eigen::Isometry3d& camera_from_pattern) {
  constexpr int kSteps = 16;
  const Eigen::Vector2d least = pattern.LeastCorner();
  const Eigen::Vector2d size = pattern.GreatestCorner() - least;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    for (const Eigen::Vector2d& share :
         {Eigen::Vector2d(t, 0), Eigen::Vector2d(t, 1), Eigen::Vector2d(0, t), {1, t}}) {
      const Eigen::Vector2d p = least + size.cwiseProduct(share);
      points.push_back(camera_from_pattern * Eigen::Vector3d(p.x(), p.y(), 0.0));
    }
  }
  return points;
}

/// The mean over a pixel whose corners lie at these points of the plane; `under` where it is
/// transparent.
double Mean(const FlatPattern& pattern, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
            const Eigen::Vector2d& c, const Eigen::Vector2d& d, double under, int fine) {
  double sum = 0.0;
  for (int j = 0; j < fine; ++j) {
    const double v = (j + 0.5) / fine;
    const Eigen::Vector2d left = a + v * (c - a);
    const Eigen::Vector2d step = (b + v * (d - b) - left) / fine;
    double x = left.x() + 0.5 * step.x();
    double y = left.y() + 0.5 * step.y();
    for (int i = 0; i < fine; ++i, x += step.x(), y += step.y()) {
      const double grey = pattern.Grey(pattern.Cell(x, y));
      sum += std::isnan(grey) ? under : grey;
    }
  }
  return sum / (fine * fine);
}

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

TagPattern::TagPattern(const TagCells& cells, double size_m, double black_grey, double white_grey)
    : LatticePattern(
          size_m / cells.shape.square,
          Eigen::Vector2d::Constant(-0.5 * cells.shape.cells * size_m / cells.shape.square),
          cells.shape.cells, cells.shape.cells),
      cells_(cells),
      black_grey_(black_grey),
      white_grey_(white_grey) {}

double TagPattern::GreyInside(int column, int row) const {
  return cells_.is_white[cells_.shape.cells - 1 - row][column] ? white_grey_ : black_grey_;
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

RayTiles::RayTiles(const CameraModel& camera)
    : camera_(camera),
      tiles_across_(camera.width_px / kSide + 1),
      tiles_(static_cast<std::size_t>(tiles_across_) * (camera.height_px / kSide + 1)) {}

const Eigen::Vector2d& RayTiles::At(int i, int j) {
  const int tile_x = i / kSide;
  const int tile_y = j / kSide;
  std::vector<Eigen::Vector2d>& tile =
      tiles_[static_cast<std::size_t>(tile_y) * tiles_across_ + tile_x];
  if (tile.empty()) Fill(tile, tile_x, tile_y);
  return tile[static_cast<std::size_t>(j - tile_y * kSide) * kSide + (i - tile_x * kSide)];
}

void RayTiles::Fill(std::vector<Eigen::Vector2d>& tile, int tile_x, int tile_y) const {
  std::vector<Eigen::Vector2d> pixels;
  pixels.reserve(kSide * kSide);
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      pixels.emplace_back(tile_x * kSide + i - 0.5, tile_y * kSide + j - 0.5);
    }
  }
  tile = RaysFromPixels(camera_, pixels);
}

Region Footprint(const CameraModel& camera, const FlatPattern& pattern,
                 const Eigen::Isometry3d& camera_from_pattern) {
  const std::vector<Eigen::Vector3d> outline = Outline(pattern, camera_from_pattern);
  Eigen::Vector2d least = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d greatest = -least;
  for (const Eigen::Vector3d& point : outline) {
    if (point.z() < 1e-3) return {};
  }
  for (const Eigen::Vector2d& pixel : PixelsFromPoints(camera, outline)) {
    least = least.cwiseMin(pixel);
    greatest = greatest.cwiseMax(pixel);
  }
  // Far outside the picture the coordinates may not fit an int.
  least = least.cwiseMax(-2.0).cwiseMin(1e6);
  greatest = greatest.cwiseMax(-2.0).cwiseMin(1e6);
  const int left = static_cast<int>(std::floor(least.x())) - 1;
  const int top = static_cast<int>(std::floor(least.y())) - 1;
  return Clipped({left, top, static_cast<int>(std::ceil(greatest.x())) + 2 - left,
                  static_cast<int>(std::ceil(greatest.y())) + 2 - top},
                 camera.width_px, camera.height_px);
}

void FlatPainter::MeetPlane(const FlatPattern& pattern,
                            const Eigen::Isometry3d& camera_from_pattern, int row,
                            const Region& where, std::vector<Corner>& corners) {
  Eigen::Matrix3d ray_from_plane;
  ray_from_plane << camera_from_pattern.linear().leftCols<2>(), camera_from_pattern.translation();
  const Eigen::Matrix3d plane_from_ray = ray_from_plane.inverse();
  corners.resize(where.width_px + 1);
  for (int i = 0; i <= where.width_px; ++i) {
    const Eigen::Vector2d& ray = rays_.At(where.x_px + i, row);
    const double* m = plane_from_ray.data();
    const double w = m[2] * ray.x() + m[5] * ray.y() + m[8];
    const double x = (m[0] * ray.x() + m[3] * ray.y() + m[6]) / w;
    const double y = (m[1] * ray.x() + m[4] * ray.y() + m[7]) / w;
    corners[i] = {{x, y}, pattern.Cell(x, y)};
  }
}

void FlatPainter::Paint(const FlatPattern& pattern, const PoseOfRow& camera_from_pattern,
                        const Region& where, const Region& canvas_region, cv::Mat1f& canvas,
                        int fine) {
  if (where.empty()) return;
  MeetPlane(pattern, camera_from_pattern(where.y_px - 0.5), where.y_px, where, above_);
  for (int y = where.y_px; y < where.y_px + where.height_px; ++y) {
    MeetPlane(pattern, camera_from_pattern(y + 0.5), y + 1, where, below_);
    float* row = canvas[y - canvas_region.y_px] + (where.x_px - canvas_region.x_px);
    for (int i = 0; i < where.width_px; ++i) {
      const Corner &a = above_[i], &b = above_[i + 1], &c = below_[i], &d = below_[i + 1];
      if (a.cell == b.cell && a.cell == c.cell && a.cell == d.cell) {
        const double grey = pattern.Grey(a.cell);
        if (!std::isnan(grey)) row[i] = static_cast<float>(grey);
      } else {
        row[i] =
            static_cast<float>(Mean(pattern, a.point, b.point, c.point, d.point, row[i], fine));
      }
    }
    std::swap(above_, below_);
  }
}

}  // namespace rift::vision
