#pragma once

#include <opencv2/core.hpp>
#include <random>

namespace rift::vision {

/// Normal noise for whole pictures at the cost of two additions a pixel: a long table made once,
/// of which every row of every picture takes a stretch from a random place.
class SensorNoise {
 public:
  explicit SensorNoise(double sigma_grey);
  /// Adds to every pixel, within 0 to 255.
  void AddTo(cv::Mat1b& picture, std::mt19937_64& generator) const;

 private:
  cv::Mat1b brighter_;  ///< one row each; the noise is their difference
  cv::Mat1b darker_;
};

}  // namespace rift::vision
