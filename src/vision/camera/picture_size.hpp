#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace rift::vision {

/// In pixels, of any file: up to 2^32 each way.
struct PictureSize {
  double width_px = 0.0;
  double height_px = 0.0;
};

/// The most that a reader of this picture takes at once, by its head and without decoding: its
/// size, or that of a TIFF's tile where that is larger. Nothing where these bytes are no JPEG, PNG
/// (ISO 15948), BMP, TIFF (6.0), PGM or PPM (Netpbm), or their head is cut short or damaged.
std::optional<PictureSize> StatedSize(std::span<const std::uint8_t> bytes);

}  // namespace rift::vision
