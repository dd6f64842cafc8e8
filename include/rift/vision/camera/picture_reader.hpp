#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "rift/vision/camera/frame.hpp"
#include "rift/vision/camera/jpeg.hpp"

namespace rift::vision {

/// The whole picture in blue, green, red; empty when it cannot be decoded.
cv::Mat BgrOf(const Frame& frame);

/// A small grey version of it, where that is cheaper; empty when it cannot be decoded.
cv::Mat SmallGreyOf(const Frame& frame);

/// The grey values of a frame, or of a region of it for a fraction of the cost: of a JPEG only what
/// lies above the region's lower edge is read, and only the region is transformed.
class PictureReader {
 public:
  std::optional<GreyPatch> Read(const Frame& frame);
  /// The region is clipped to the picture. None when the bytes are damaged, too few, or a JPEG of
  /// another size than the frame says.
  std::optional<GreyPatch> Read(const Frame& frame, const Region& region);

 private:
  JpegReader jpeg_;
};

}  // namespace rift::vision
