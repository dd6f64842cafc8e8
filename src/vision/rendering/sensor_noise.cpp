#include "sensor_noise.hpp"

#include <opencv2/core.hpp>

namespace rift::vision {
namespace {

constexpr int kTableLength = 1 << 20;
constexpr std::uint64_t kTableSeed = 0x5eed;

}  // namespace

SensorNoise::SensorNoise(double sigma_grey) {
  if (sigma_grey <= 0.0) return;
  cv::Mat1f table(1, kTableLength);
  cv::RNG(kTableSeed).fill(table, cv::RNG::NORMAL, 0.0, sigma_grey);
  table.convertTo(brighter_, CV_8U);
  cv::Mat1f(-table).convertTo(darker_, CV_8U);
}

void SensorNoise::AddTo(cv::Mat1b& picture, std::mt19937_64& generator) const {
  if (brighter_.empty()) return;
  const auto places = static_cast<std::uint64_t>(kTableLength - picture.cols);
  for (int y = 0; y < picture.rows; ++y) {
    const cv::Rect part(static_cast<int>(generator() % places), 0, picture.cols, 1);
    cv::Mat row = picture.row(y);
    cv::add(row, brighter_(part), row);
    cv::subtract(row, darker_(part), row);
  }
}

}  // namespace rift::vision
