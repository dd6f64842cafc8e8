#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "edge_line.hpp"
#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/camera/frame.hpp"
#include "rift/vision/tracking/tag_detector.hpp"
#include "rift/vision/tracking/tag_pose.hpp"

namespace rift::vision {

/// The square that a tag is detected by, measured along its four edges.
struct FittedSquare {
  TagCorners pixels;  ///< where the corners are in the picture
  MeasuredCorners
      corners;  ///< the same without the lens, with what the edges' scatter says of them
  double black_grey = 0.0;
  double white_grey = 0.0;
  double rms_px = 0.0;  ///< of the edge points about their lines
};

/// Sub-pixel corners from a guess that is off by up to half a cell of a tag of that shape: on each
/// side the steps between black and white are located along its normal, freed of the lens, and
/// joined by a line; the corners are where the lines meet. A straight edge is straight only without
/// the lens, which is worth a third of the error. `errors` are added to the corners' scatter. None
/// where an edge is missing, too short, leaves the patch or has less than `least_contrast` grey
/// values.
std::optional<FittedSquare> FitSquare(const CameraModel& camera, const GreyPatch& patch,
                                      const TagCorners& guess, const TagShape& shape,
                                      double least_contrast, const EdgeErrors& errors);

/// What the picture says inside a fitted square.
struct ReadBits {
  /// Of the cells of the black square, of all where the square is white; those beyond the patch
  /// too.
  int wrong = 0;
  double margin = 0.0;  ///< mean distance of the bits from the threshold, in grey values
};

/// Compares the cells at the square with those that the tag should have. Far cheaper than decoding,
/// so that every sighting is verified to be this tag, the right way round.
ReadBits CompareBits(const CameraModel& camera, const GreyPatch& patch, const FittedSquare& square,
                     const TagCells& expected);

}  // namespace rift::vision
