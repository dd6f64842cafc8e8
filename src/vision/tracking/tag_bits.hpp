#pragma once

#include "edge_fit.hpp"

namespace rift::vision {

/// What the picture says inside a fitted square.
struct ReadBits {
  int wrong = 0;        ///< of the 64 cells of the black square
  double margin = 0.0;  ///< mean distance of the 36 bits from the threshold, in grey values
};

/// Compares the cells at the square with those that the tag should have. Far cheaper than decoding,
/// so that every sighting carries the proof that it is this tag, the right way round.
ReadBits CompareBits(const CameraModel& camera, const GreyPatch& patch, const FittedSquare& square,
                     const TagCells& expected);

}  // namespace rift::vision
