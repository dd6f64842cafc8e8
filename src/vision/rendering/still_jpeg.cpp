#include "still_jpeg.hpp"

#include <algorithm>

namespace rift::vision {
namespace {

/// 68 rows of blocks at 1080p: 8^68 pictures of the floor, at 8 times the bytes of one.
constexpr std::size_t kPool = 8;

cv::Mat1b Noisy(const cv::Mat1b& strip, const SensorNoise& noise, std::mt19937_64& generator) {
  cv::Mat1b noisy = strip.clone();
  noise.AddTo(noisy, generator);
  return noisy;
}

}  // namespace

std::vector<std::uint8_t> StillJpeg::Write(const cv::Mat1b& still, const cv::Mat1b& picture,
                                           const Region& moved, const SensorNoise& noise,
                                           std::mt19937_64& generator) {
  // One at a time, so that the first picture costs no more than it must.
  if (pool_.size() < kPool) pool_.push_back(rows_.Encode(Noisy(still, noise, generator)));
  std::vector<const JpegRows::Row*> rows;
  for (int i = 0; i < rows_.Count(); ++i) rows.push_back(&pool_[generator() % pool_.size()][i]);
  if (moved.empty()) return rows_.Join(rows);
  const int first = moved.y_px / rows_.RowHeight_px();
  const int end = (moved.y_px + moved.height_px - 1) / rows_.RowHeight_px() + 1;
  const cv::Mat1b strip = picture.rowRange(first * rows_.RowHeight_px(),
                                           std::min(end * rows_.RowHeight_px(), picture.rows));
  const Rows anew = rows_.Encode(Noisy(strip, noise, generator));
  for (int i = first; i < end; ++i) rows[i] = &anew[i - first];
  return rows_.Join(rows);
}

}  // namespace rift::vision
