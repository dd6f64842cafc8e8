#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace rift::vision {

struct JpegSize {
  int width_px = 0;
  int height_px = 0;
};

/// The size that a JPEG's frame header states (ITU T.81 B.2.2), without decoding; nothing when
/// these bytes are no JPEG.
std::optional<JpegSize> SizeOfJpeg(std::span<const std::uint8_t> bytes);

/// How many of the bytes belong to the picture: drivers hand out their whole buffer, and what
/// follows the end marker is left over from older pictures.
std::size_t JpegLength(std::span<const std::uint8_t> bytes);

}  // namespace rift::vision
