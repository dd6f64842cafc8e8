#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

namespace rift::vision {

/// JPEGs whose rows of blocks can be exchanged one by one: a restart marker ends each, as in the
/// streams of many webcams, so that none depends on the one before. What stands still need not be
/// compressed again for every picture. The only file that sees libjpeg's compressor is
/// jpeg_rows.cpp.
class JpegRows {
 public:
  /// colour: YCbCr 4:2:0 with even chroma, the form that webcams send; otherwise luma alone.
  JpegRows(int width_px, int height_px, int quality, bool colour);
  ~JpegRows();

  using Row = std::vector<std::uint8_t>;
  int RowHeight_px() const { return row_height_px_; }
  int Count() const { return (height_px_ + row_height_px_ - 1) / row_height_px_; }

  /// Rows of blocks of a picture, from a strip of it as wide as it is. The strip starts with a row
  /// of blocks, and ends with one or with the picture.
  std::vector<Row> Encode(const cv::Mat1b& strip);
  /// One picture of all rows from the top; only after a first Encode.
  std::vector<std::uint8_t> Join(const std::vector<const Row*>& rows) const;

 private:
  struct State;

  std::unique_ptr<State> state_;
  int height_px_;
  int row_height_px_;
};

}  // namespace rift::vision
