#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

namespace rift::vision {

/// What the bytes of a picture are.
enum class PixelFormat {
  kJpeg,  ///< one compressed picture, so that a tracker can decode just the region it needs
  kGrey,  ///< one byte a pixel, rows from the top, no padding
  kBgr,   ///< three bytes a pixel
  kYuyv,  ///< two bytes a pixel; the even ones are grey
};
constexpr std::array<std::string_view, 4> EnumNames(PixelFormat) {
  return {"jpeg", "grey", "bgr", "yuyv"};
}

/// A picture as a camera gave it.
struct Frame {
  std::uint64_t index = 0;  ///< counts what the camera delivered, dropped ones included
  double captured_s = 0.0;  ///< of the exposure as far as known, on this process's steady clock
  double arrived_s = 0.0;   ///< when it was in memory, on the same clock
  int width_px = 0;
  int height_px = 0;
  PixelFormat format = PixelFormat::kGrey;
  std::vector<std::uint8_t> bytes;
};

/// A rectangle of pixels of a picture.
struct Region {
  int x_px = 0;
  int y_px = 0;
  int width_px = 0;
  int height_px = 0;

  bool empty() const { return width_px <= 0 || height_px <= 0; }
  friend bool operator==(const Region&, const Region&) = default;
};

/// The part of the region that a picture of this size has.
inline Region Clipped(const Region& region, int width_px, int height_px) {
  const int left = std::clamp(region.x_px, 0, width_px);
  const int top = std::clamp(region.y_px, 0, height_px);
  const int right = std::clamp(region.x_px + region.width_px, left, width_px);
  const int bottom = std::clamp(region.y_px + region.height_px, top, height_px);
  return {left, top, right - left, bottom - top};
}

/// Grey values of a region; coordinates are those of the whole picture.
struct GreyPatch {
  Region region;
  std::vector<std::uint8_t> pixels;  ///< rows from the top, no padding

  bool Holds(double x_px, double y_px) const {
    return x_px >= region.x_px && y_px >= region.y_px &&
           x_px <= region.x_px + region.width_px - 1 && y_px <= region.y_px + region.height_px - 1;
  }
  /// Bilinear between pixel middles; NaN outside.
  double At(double x_px, double y_px) const {
    if (!Holds(x_px, y_px)) return NAN;
    const double x = x_px - region.x_px;
    const double y = y_px - region.y_px;
    const int left = std::min(static_cast<int>(x), std::max(region.width_px - 2, 0));
    const int top = std::min(static_cast<int>(y), std::max(region.height_px - 2, 0));
    const int right = region.width_px > 1 ? 1 : 0;
    const std::size_t down = region.height_px > 1 ? region.width_px : 0;
    const std::uint8_t* p = &pixels[static_cast<std::size_t>(top) * region.width_px + left];
    const double fx = x - left;
    const double fy = y - top;
    return (1.0 - fy) * ((1.0 - fx) * p[0] + fx * p[right]) +
           fy * ((1.0 - fx) * p[down] + fx * p[down + right]);
  }
};

}  // namespace rift::vision
