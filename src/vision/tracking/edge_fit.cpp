#include "edge_fit.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "edge_line.hpp"
#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {
namespace {

/// Below this a cell is too small for a plateau on both sides of the edge.
constexpr double kLeastCell_px = 2.0;

/// One side of the square in the picture, its normal pointing from the black to the white.
struct Side {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  Eigen::Vector2d along;
  Eigen::Vector2d normal;
  double length_px;
  int cells;

  Side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const TagShape& shape)
      : from(a),
        to(b),
        along((b - a).normalized()),
        length_px((b - a).norm()),
        cells(shape.square) {
    // The corners run counter-clockwise as one sees the tag, in a picture whose y runs down.
    normal = {-along.y(), along.x()};
    if (shape.is_white_square) normal = -normal;
  }
  double Cell_px() const { return length_px / cells; }
};

/// A side that is longer than the patch is none: a lens that folds the picture throws corners any
/// distance away, and so many points have no room in memory. NaN is no length either.
bool IsMeasurable(const Side& side, const GreyPatch& patch) {
  return side.Cell_px() >= kLeastCell_px &&
         side.length_px <= patch.region.width_px + patch.region.height_px;
}

/// Calls visit(point) at about `step_px` along the side, a cell away from its ends.
template <class Visit>
void WalkAlong(const Side& side, double step_px, Visit&& visit) {
  const int count = PointCount(side.length_px, side.cells, step_px);
  for (int i = 0; i < count; ++i) {
    const double s =
        side.Cell_px() + MeasuredLength_px(side.length_px, side.cells) * (i + 0.5) / count;
    visit(Eigen::Vector2d(side.from + s * side.along));
  }
}

/// The steepest rise along the normal within `reach_px` of the point, to half a pixel.
std::optional<Eigen::Vector2d> SteepestRise(const GreyPatch& patch, const Eigen::Vector2d& point,
                                            const Eigen::Vector2d& normal, double reach_px,
                                            double least_contrast) {
  double best = least_contrast * 0.5;
  std::optional<double> where;
  const auto at = [&](double s) {
    return patch.At(point.x() + s * normal.x(), point.y() + s * normal.y());
  };
  const auto steps = static_cast<int>(4.0 * reach_px);
  for (int i = 0; i <= steps; ++i) {
    const double s = 0.5 * i - reach_px;
    const double rise = at(s + 1.0) - at(s - 1.0);
    if (rise > best) {
      best = rise;
      where = s;
    }
  }
  if (!where) return std::nullopt;
  return point + *where * normal;
}

/// The guess moved onto the edges, good to about 0.3 px.
std::optional<TagCorners> Approach(const GreyPatch& patch, const TagCorners& guess,
                                   const TagShape& shape, double least_contrast) {
  std::vector<EdgeLine> lines;
  for (int i = 0; i < 4; ++i) {
    const Side side(guess[i], guess[(i + 1) % 4], shape);
    if (!IsMeasurable(side, patch)) return std::nullopt;
    std::vector<Eigen::Vector2d> points;
    WalkAlong(side, 3.0, [&](const Eigen::Vector2d& point) {
      if (auto edge =
              SteepestRise(patch, point, side.normal, 0.8 * side.Cell_px(), least_contrast)) {
        points.push_back(*edge);
      }
    });
    const auto line = FitLine(points, 0.3);
    if (!line) return std::nullopt;
    lines.push_back(*line);
  }
  TagCorners corners;
  for (int i = 0; i < 4; ++i) {
    const auto corner = Meet(lines[(i + 3) % 4], lines[i]);
    if (!corner) return std::nullopt;
    corners[i] = *corner;
  }
  return corners;
}

/// Grey values along normals of one side, a profile after the other.
struct Profiles {
  std::vector<Eigen::Vector2d> middles;
  std::vector<double> greys;
  double reach_px = 0.0;
  double step_px = 0.0;
  int samples = 0;
  double black = 0.0;
  double white = 0.0;
};

Profiles Sample(const GreyPatch& patch, const Side& side) {
  Profiles profiles;
  profiles.reach_px = std::clamp(0.45 * side.Cell_px(), 1.0, 3.5);
  profiles.samples = 2 * static_cast<int>(std::ceil(profiles.reach_px / 0.75)) + 1;
  profiles.step_px = 2.0 * profiles.reach_px / (profiles.samples - 1);
  WalkAlong(side, 1.0, [&](const Eigen::Vector2d& point) {
    profiles.middles.push_back(point);
    for (int i = 0; i < profiles.samples; ++i) {
      const double s = i * profiles.step_px - profiles.reach_px;
      profiles.greys.push_back(
          patch.At(point.x() + s * side.normal.x(), point.y() + s * side.normal.y()));
    }
  });
  const double count = static_cast<double>(profiles.middles.size());
  for (std::size_t k = 0; k < profiles.greys.size(); k += profiles.samples) {
    profiles.black += profiles.greys[k] / count;
    profiles.white += profiles.greys[k + profiles.samples - 1] / count;
  }
  return profiles;
}

/// Where each profile's step is, by its area: a step of any symmetric blur from black to white at s
/// has the integral white (reach - s) + black (reach + s).
std::vector<Eigen::Vector2d> EdgePoints(const Profiles& profiles, const Side& side) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t k = 0; k < profiles.middles.size(); ++k) {
    const double* grey = &profiles.greys[k * profiles.samples];
    double integral = 0.5 * (grey[0] + grey[profiles.samples - 1]);
    for (int i = 1; i + 1 < profiles.samples; ++i) integral += grey[i];
    integral *= profiles.step_px;
    const double s = ((profiles.white + profiles.black) * profiles.reach_px - integral) /
                     (profiles.white - profiles.black);
    points.push_back(profiles.middles[k] + s * side.normal);
  }
  return points;
}

/// The rays of the points, in units of a pixel so that sigma limits have their meaning.
std::vector<Eigen::Vector2d> Straightened(const CameraModel& camera,
                                          const std::vector<Eigen::Vector2d>& points) {
  std::vector<Eigen::Vector2d> rays = RaysFromPixels(camera, points);
  for (Eigen::Vector2d& ray : rays) {
    ray = ray.cwiseProduct(Eigen::Vector2d(camera.k(0, 0), camera.k(1, 1)));
  }
  return rays;
}

/// Corner i is where the sides before and after it meet.
bool JoinCorners(const CameraModel& camera, const std::array<EdgeLine, 4>& lines,
                 const EdgeErrors& errors, FittedSquare& square) {
  std::vector<Eigen::Vector3d> points;
  std::array<Eigen::Vector2d, 4> corners_px;
  for (int i = 0; i < 4; ++i) {
    const auto corner = Meet(lines[(i + 3) % 4], lines[i]);
    if (!corner) return false;
    corners_px[i] = *corner;
    square.corners.rays[i] = corner->cwiseQuotient(Eigen::Vector2d(camera.k(0, 0), camera.k(1, 1)));
    points.emplace_back(square.corners.rays[i].x(), square.corners.rays[i].y(), 1.0);
  }
  square.corners.covariance = CovarianceOf(lines, corners_px, errors);
  const std::vector<Eigen::Vector2d> pixels = PixelsFromPoints(camera, points);
  std::copy(pixels.begin(), pixels.end(), square.pixels.begin());
  return true;
}

/// Homography that takes the square [0, n] x [0, n] (x right, y up) to the four rays.
Eigen::Matrix3d RaysFromCells(const std::array<Eigen::Vector2d, 4>& rays, double n) {
  const std::array<Eigen::Vector2d, 4> corners{{{0, 0}, {n, 0}, {n, n}, {0, n}}};
  Eigen::Matrix<double, 8, 8> a = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 1> b;
  for (int i = 0; i < 4; ++i) {
    const Eigen::RowVector3d p = corners[i].homogeneous().transpose();
    a.block<1, 3>(2 * i, 0) = p;
    a.block<1, 3>(2 * i + 1, 3) = p;
    a.block<1, 2>(2 * i, 6) = -rays[i].x() * p.head<2>();
    a.block<1, 2>(2 * i + 1, 6) = -rays[i].y() * p.head<2>();
    b.segment<2>(2 * i) = rays[i];
  }
  const Eigen::Matrix<double, 8, 1> h = a.partialPivLu().solve(b);
  Eigen::Matrix3d homography;
  homography << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), 1.0;
  return homography;
}

/// Middles of the cells, rows from the top of the tag: those of the square and of `more` around it.
std::vector<Eigen::Vector2d> CellPixels(const CameraModel& camera, const FittedSquare& square,
                                        int cells, int more) {
  const Eigen::Matrix3d rays_from_cells = RaysFromCells(square.corners.rays, cells);
  std::vector<Eigen::Vector3d> points;
  for (int row = -more; row < cells + more; ++row) {
    for (int column = -more; column < cells + more; ++column) {
      points.push_back(rays_from_cells * Eigen::Vector3d(column + 0.5, cells - row - 0.5, 1.0));
    }
  }
  return PixelsFromPoints(camera, points);
}

/// Sub-pixel corners from corners that are good to about 0.3 px.
std::optional<FittedSquare> FitOnce(const CameraModel& camera, const GreyPatch& patch,
                                    const TagCorners& near, const TagShape& shape,
                                    double least_contrast, const EdgeErrors& errors) {
  FittedSquare square;
  std::array<EdgeLine, 4> lines;
  for (int i = 0; i < 4; ++i) {
    const Side side(near[i], near[(i + 1) % 4], shape);
    if (!IsMeasurable(side, patch)) return std::nullopt;
    const Profiles profiles = Sample(patch, side);
    // NaN, from outside the patch, fails here too.
    if (!(profiles.white - profiles.black > least_contrast)) return std::nullopt;
    const auto line = FitLine(Straightened(camera, EdgePoints(profiles, side)), 0.05);
    if (!line) return std::nullopt;
    lines[i] = *line;
    square.black_grey += 0.25 * profiles.black;
    square.white_grey += 0.25 * profiles.white;
    square.rms_px = std::hypot(square.rms_px, 0.5 * line->rms);
  }
  if (!JoinCorners(camera, lines, errors, square)) return std::nullopt;
  return square;
}

}  // namespace

std::optional<FittedSquare> FitSquare(const CameraModel& camera, const GreyPatch& patch,
                                      const TagCorners& guess, const TagShape& shape,
                                      double least_contrast, const EdgeErrors& errors) {
  const std::optional<TagCorners> near = Approach(patch, guess, shape, least_contrast);
  if (!near) return std::nullopt;
  std::optional<FittedSquare> square = FitOnce(camera, patch, *near, shape, least_contrast, errors);
  if (!square) return std::nullopt;
  // The ends of a short profile are not quite black and white, and the less so the further the
  // profile's middle is from the edge: 0.015 px on all of a 27 px tag.
  return FitOnce(camera, patch, square->pixels, shape, least_contrast, errors);
}

ReadBits CompareBits(const CameraModel& camera, const GreyPatch& patch, const FittedSquare& square,
                     const TagCells& expected) {
  const TagShape& shape = expected.shape;
  // Around a black square is nothing but paper; around a white one are its bits.
  const int more = shape.is_white_square ? shape.Around() : 0;
  const int first = shape.Around() - more, end = shape.cells - first;
  const std::vector<Eigen::Vector2d> pixels = CellPixels(camera, square, shape.square, more);
  const double threshold = 0.5 * (square.black_grey + square.white_grey);
  ReadBits read;
  auto pixel = pixels.begin();
  for (int row = first; row < end; ++row) {
    for (int column = first; column < end; ++column, ++pixel) {
      const double excess = patch.At(pixel->x(), pixel->y()) - threshold;
      const bool right = expected.is_white[row][column] ? excess > 0.0 : excess < 0.0;
      if (!right) ++read.wrong;
      // Beyond the patch there is nothing to read, and NaN would pass for any margin.
      const bool is_read = expected.is_bit[row][column] && std::isfinite(excess);
      if (is_read) read.margin += std::abs(excess) / shape.bits;
    }
  }
  return read;
}

}  // namespace rift::vision
