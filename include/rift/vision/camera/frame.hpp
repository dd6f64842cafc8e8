#pragma once

#include <array>
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
  double captured_s =
      0.0;  ///< steady clock of this process: when the light fell in, as far as known
  double arrived_s = 0.0;  ///< steady clock of this process: when it was in memory
  int width_px = 0;
  int height_px = 0;
  PixelFormat format = PixelFormat::kGrey;
  std::vector<std::uint8_t> bytes;
};

}  // namespace rift::vision
