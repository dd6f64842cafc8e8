#include "edge_fit.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "rift/statistics/descriptive.hpp"
#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {
namespace {

/// normal . p = offset, with a unit normal.
struct EdgeLine {
  Eigen::Vector2d normal;
  double offset = 0.0;
  double rms = 0.0;  ///< distance of the points that were kept

  double Distance(const Eigen::Vector2d& point) const { return normal.dot(point) - offset; }
};

/// The line with the least squared distances, after points further than 3 sigma (by the median, at
/// least `least_sigma`) are left out. None when fewer than half of the points are left.
std::optional<EdgeLine> FitLine(const std::vector<Eigen::Vector2d>& points, double least_sigma);

/// Where they meet; none when they are all but parallel.
std::optional<Eigen::Vector2d> Meet(const EdgeLine& a, const EdgeLine& b);

constexpr int kRounds = 3;

EdgeLine LeastSquares(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d d = p - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const double along = 0.5 * std::atan2(2.0 * xy, xx - yy);
  EdgeLine line{{-std::sin(along), std::cos(along)}, 0.0, 0.0};
  line.offset = line.normal.dot(mean);
  double sum = 0.0;
  for (const Eigen::Vector2d& p : points) sum += line.Distance(p) * line.Distance(p);
  line.rms = std::sqrt(sum / static_cast<double>(points.size()));
  return line;
}

double MedianDistance(const EdgeLine& line, const std::vector<Eigen::Vector2d>& points) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const Eigen::Vector2d& p : points) distances.push_back(std::abs(line.Distance(p)));
  return statistics::Median(std::move(distances));
}

std::optional<EdgeLine> FitLine(const std::vector<Eigen::Vector2d>& points, double least_sigma) {
  if (points.size() < 4) return std::nullopt;
  std::vector<Eigen::Vector2d> kept = points;
  EdgeLine line = LeastSquares(kept);
  for (int round = 0; round < kRounds; ++round) {
    const double limit = 3.0 * std::max(least_sigma, statistics::kSigmaOfMedianDeviation *
                                                         MedianDistance(line, points));
    kept.clear();
    std::copy_if(points.begin(), points.end(), std::back_inserter(kept),
                 [&](const Eigen::Vector2d& p) { return std::abs(line.Distance(p)) <= limit; });
    if (2 * kept.size() < points.size()) return std::nullopt;
    line = LeastSquares(kept);
    if (kept.size() == points.size()) break;
  }
  return line;
}

std::optional<Eigen::Vector2d> Meet(const EdgeLine& a, const EdgeLine& b) {
  Eigen::Matrix2d normals;
  normals << a.normal.transpose(), b.normal.transpose();
  if (std::abs(normals.determinant()) < 0.1) return std::nullopt;
  return normals.inverse() * Eigen::Vector2d(a.offset, b.offset);
}

constexpr int kCells = 8;  // along a side of the black square
/// Below this a cell is too small for a plateau on both sides of the edge.
constexpr double kLeastCell_px = 2.0;

/// One side of the square in the picture, its normal pointing out of the black.
struct Side {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  Eigen::Vector2d along;
  Eigen::Vector2d normal;
  double length_px;

  Side(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
      : from(a), to(b), along((b - a).normalized()), length_px((b - a).norm()) {
    // The corners run counter-clockwise as one sees the tag, in a picture whose y runs down.
    normal = {-along.y(), along.x()};
  }
  double Cell_px() const { return length_px / kCells; }
};

/// Calls visit(point) at about `step_px` along the side, a cell away from its ends.
template <class Visit>
void WalkAlong(const Side& side, double step_px, Visit&& visit) {
  const double margin_px = side.Cell_px();
  const int count = std::max(6, static_cast<int>((side.length_px - 2 * margin_px) / step_px));
  for (int i = 0; i < count; ++i) {
    const double s = margin_px + (side.length_px - 2 * margin_px) * (i + 0.5) / count;
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
  for (double s = -reach_px; s <= reach_px; s += 0.5) {
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
                                   double least_contrast) {
  std::vector<EdgeLine> lines;
  for (int i = 0; i < 4; ++i) {
    const Side side(guess[i], guess[(i + 1) % 4]);
    if (side.Cell_px() < kLeastCell_px) return std::nullopt;
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
                 FittedSquare& square) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 4; ++i) {
    const auto corner = Meet(lines[(i + 3) % 4], lines[i]);
    if (!corner) return false;
    square.rays[i] = corner->cwiseQuotient(Eigen::Vector2d(camera.k(0, 0), camera.k(1, 1)));
    points.emplace_back(square.rays[i].x(), square.rays[i].y(), 1.0);
  }
  const std::vector<Eigen::Vector2d> pixels = PixelsFromPoints(camera, points);
  std::copy(pixels.begin(), pixels.end(), square.pixels.begin());
  return true;
}

/// Homography that takes the square [0, 8] x [0, 8] (x right, y up) to the four rays.
Eigen::Matrix3d RaysFromCells(const std::array<Eigen::Vector2d, 4>& rays) {
  const std::array<Eigen::Vector2d, 4> corners{
      {{0, 0}, {kCells, 0}, {kCells, kCells}, {0, kCells}}};
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

/// Middles of the cells, rows from the top of the tag.
std::vector<Eigen::Vector2d> CellPixels(const CameraModel& camera, const FittedSquare& square) {
  const Eigen::Matrix3d rays_from_cells = RaysFromCells(square.rays);
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      points.push_back(rays_from_cells * Eigen::Vector3d(column + 0.5, kCells - row - 0.5, 1.0));
    }
  }
  return PixelsFromPoints(camera, points);
}

bool IsBit(int row, int column) {
  return row > 0 && column > 0 && row < kCells - 1 && column < kCells - 1;
}

}  // namespace

std::optional<FittedSquare> FitSquare(const CameraModel& camera, const GreyPatch& patch,
                                      const TagCorners& guess, double least_contrast) {
  const std::optional<TagCorners> near = Approach(patch, guess, least_contrast);
  if (!near) return std::nullopt;
  FittedSquare square;
  std::array<EdgeLine, 4> lines;
  for (int i = 0; i < 4; ++i) {
    const Side side((*near)[i], (*near)[(i + 1) % 4]);
    if (side.Cell_px() < kLeastCell_px) return std::nullopt;
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
  if (!JoinCorners(camera, lines, square)) return std::nullopt;
  return square;
}

ReadBits CompareBits(const CameraModel& camera, const GreyPatch& patch, const FittedSquare& square,
                     const TagCells& expected) {
  const std::vector<Eigen::Vector2d> pixels = CellPixels(camera, square);
  const double threshold = 0.5 * (square.black_grey + square.white_grey);
  ReadBits read;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const Eigen::Vector2d& pixel = pixels[row * kCells + column];
      const double excess = patch.At(pixel.x(), pixel.y()) - threshold;
      const bool right = expected[row + 1][column + 1] ? excess > 0.0 : excess < 0.0;
      if (!right) ++read.wrong;
      if (IsBit(row, column)) read.margin += std::abs(excess) / 36.0;
    }
  }
  return read;
}

}  // namespace rift::vision
