#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "jpeg_rows.hpp"
#include "rift/vision/camera/frame.hpp"
#include "sensor_noise.hpp"

namespace rift::vision {

/// Compresses pictures of a scene of which little moves. What stands still has been compressed a
/// few times over with other noise, and every row of blocks of every picture is one of those at
/// random; only where something moved is a row compressed anew.
class StillJpeg {
 public:
  StillJpeg(int width_px, int height_px, int quality, bool colour)
      : rows_(width_px, height_px, quality, colour) {}

  /// `picture` is `still` but for the region `moved`; both without noise. `still` is always the
  /// same.
  std::vector<std::uint8_t> Write(const cv::Mat1b& still, const cv::Mat1b& picture,
                                  const Region& moved, const SensorNoise& noise,
                                  std::mt19937_64& generator);

 private:
  using Rows = std::vector<JpegRows::Row>;

  JpegRows rows_;
  std::vector<Rows> pool_;  ///< the still scene, each time with noise of its own
};

}  // namespace rift::vision
