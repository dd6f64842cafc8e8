#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/camera/frame.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"
#include "rift/vision/tracking/tag_detector.hpp"

namespace rift::vision {

/// Something flat and printed: a plane cut into cells, each of one grey value or transparent.
class FlatPattern {
 public:
  virtual ~FlatPattern() = default;
  /// Which cell the point is in. Cells are convex, but for the one around everything.
  virtual int Cell(double x_m, double y_m) const = 0;
  /// NaN where it is transparent.
  virtual double Grey(int cell) const = 0;
  /// The corners of a box around all that is not transparent.
  virtual Eigen::Vector2d LeastCorner() const = 0;
  virtual Eigen::Vector2d GreatestCorner() const = 0;
};

class DiscPattern : public FlatPattern {
 public:
  DiscPattern(double radius_m, double grey) : radius_m_(radius_m), grey_(grey) {}
  int Cell(double x_m, double y_m) const override;
  double Grey(int cell) const override;
  Eigen::Vector2d LeastCorner() const override { return {-radius_m_, -radius_m_}; }
  Eigen::Vector2d GreatestCorner() const override { return {radius_m_, radius_m_}; }

 private:
  double radius_m_;
  double grey_;
};

/// Cells of an infinite square lattice, so that a pixel with only the tip of a corner in it differs
/// from one beside the pattern.
class LatticePattern : public FlatPattern {
 public:
  LatticePattern(double cell_m, const Eigen::Vector2d& least, int columns, int rows)
      : cell_m_(cell_m), least_(least), columns_(columns), rows_(rows) {}
  int Cell(double x_m, double y_m) const override;
  double Grey(int cell) const override;
  Eigen::Vector2d LeastCorner() const override { return least_; }
  Eigen::Vector2d GreatestCorner() const override {
    return least_ + cell_m_ * Eigen::Vector2d(columns_, rows_);
  }

 private:
  /// Of a cell inside, counted from the least corner.
  virtual double GreyInside(int column, int row) const = 0;

  double cell_m_;
  Eigen::Vector2d least_;
  int columns_;
  int rows_;
};

class TagPattern : public LatticePattern {
 public:
  TagPattern(const TagCells& cells, double size_m, double black_grey, double white_grey);

 private:
  double GreyInside(int column, int row) const override;

  TagCells cells_;
  double black_grey_;
  double white_grey_;
};

class BoardPattern : public LatticePattern {
 public:
  BoardPattern(const PlacedBoard& board, double black_grey, double white_grey);

 private:
  double GreyInside(int column, int row) const override;

  int columns_;
  int rows_;
  double black_grey_;
  double white_grey_;
};

/// The ray through every corner between pixels, worked out tile by tile when first asked for: the
/// corner (i, j) is the upper left of pixel (i, j), so i runs to the width and j to the height.
class RayTiles {
 public:
  explicit RayTiles(const CameraModel& camera);
  const Eigen::Vector2d& At(int i, int j);

 private:
  static constexpr int kSide = 32;

  void Fill(std::vector<Eigen::Vector2d>& tile, int tile_x, int tile_y) const;

  CameraModel camera_;
  int tiles_across_;
  std::vector<std::vector<Eigen::Vector2d>> tiles_;
};

/// Where a pattern is while the given row of the picture is exposed.
using PoseOfRow = std::function<Eigen::Isometry3d(double row)>;

/// The pixels that may show the pattern, clipped to the picture; empty when it is behind the
/// camera.
Region Footprint(const CameraModel& camera, const FlatPattern& pattern,
                 const Eigen::Isometry3d& camera_from_pattern);

/// Paints patterns over a canvas of floats that shows `canvas_region` of the picture. A pixel is
/// the mean over its square: exact where one cell covers it, of `fine` x `fine` points where an
/// edge runs through.
class FlatPainter {
 public:
  static constexpr int kFine = 8;

  explicit FlatPainter(const CameraModel& camera) : rays_(camera) {}
  void Paint(const FlatPattern& pattern, const PoseOfRow& camera_from_pattern, const Region& where,
             const Region& canvas_region, cv::Mat1f& canvas, int fine = kFine);

 private:
  struct Corner {
    Eigen::Vector2d point;  ///< on the pattern's plane
    int cell;
  };
  void MeetPlane(const FlatPattern& pattern, const Eigen::Isometry3d& camera_from_pattern, int row,
                 const Region& where, std::vector<Corner>& corners);

  RayTiles rays_;
  std::vector<Corner> above_;
  std::vector<Corner> below_;
};

}  // namespace rift::vision
