#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "rift/vision/camera/grey_patch.hpp"

namespace rift::vision {

/// libjpeg's decompressor; the only file that sees its types is jpeg_reader.cpp. TurboJPEG's own
/// interface has no way to read a part of a picture.
class JpegReader {
 public:
  JpegReader();
  ~JpegReader();

  /// The luma of the region, which lies inside a picture of the given size. None when the data are
  /// damaged as far as they were read, or are a picture of another size.
  std::optional<GreyPatch> Read(const std::vector<std::uint8_t>& bytes, int width_px, int height_px,
                                const Region& region);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rift::vision
