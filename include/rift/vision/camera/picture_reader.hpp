#pragma once

#include <memory>
#include <optional>

#include "rift/vision/camera/frame.hpp"
#include "rift/vision/camera/grey_patch.hpp"

namespace rift::vision {

/// The grey values of a frame, or of a region of it for a fraction of the cost: of a JPEG only what
/// lies above the region's lower edge is read, and only the region is transformed.
class PictureReader {
 public:
  PictureReader();
  ~PictureReader();
  PictureReader(PictureReader&&) noexcept;
  PictureReader& operator=(PictureReader&&) noexcept;

  std::optional<GreyPatch> Read(const Frame& frame);
  /// The region is clipped to the picture. None when the bytes are damaged, too few, or a JPEG of
  /// another size than the frame says.
  std::optional<GreyPatch> Read(const Frame& frame, const Region& region);

 private:
  class Jpeg;
  std::unique_ptr<Jpeg> jpeg_;
};

}  // namespace rift::vision
