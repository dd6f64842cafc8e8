#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {

/// The AprilTag families that are read (apriltag.org). The name tells bits and the least number of
/// them by which two tags differ.
enum class TagFamily {
  k36h11,          ///< the authors'
  k25h9,           ///< fewer ids, larger cells
  k16h5,           ///< fewer and larger still; noise hits one of its codes by chance
  kStandard41h12,  ///< 2115 ids; bits outside of the square that is detected as well
};

constexpr std::array<std::string_view, 4> EnumNames(TagFamily) {
  return {"tag36h11", "tag25h9", "tag16h5", "tagStandard41h12"};
}

/// How a family is laid out, in cells.
struct TagShape {
  int ids;     ///< 0 to ids - 1
  int cells;   ///< along a side of all that is printed, a white border included
  int square;  ///< along a side of the square whose corners are detected and which has size_m
  int bits;
  /// The square is white with black around it; otherwise black with white around it.
  bool is_white_square;

  /// Of printed cells before the square begins, on each side.
  constexpr int Around() const { return (cells - square) / 2; }
};

constexpr TagShape ShapeOf(TagFamily family) {
  constexpr std::array<TagShape, 4> kShapes{{{587, 10, 8, 36, false},
                                             {35, 9, 7, 25, false},
                                             {30, 8, 6, 16, false},
                                             {2115, 9, 5, 41, true}}};
  return kShapes[static_cast<std::size_t>(family)];
}

static_assert(ShapeOf(TagFamily::kStandard41h12).ids - 1 == kLastTagId);

constexpr std::string_view NameOf(TagFamily family) {
  return EnumNames(family)[static_cast<std::size_t>(family)];
}

/// Throws std::invalid_argument, with the family's range, for an id that it does not have.
void RequireTagId(int id, TagFamily family);

}  // namespace rift::vision
