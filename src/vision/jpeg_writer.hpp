#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

namespace rift::vision {

/// TurboJPEG's compressor; the only file that sees its types is jpeg_writer.cpp.
class JpegWriter {
 public:
  /// colour: YCbCr 4:2:0 with even chroma, the form that webcams send; otherwise luma alone.
  JpegWriter(int quality, bool colour);
  ~JpegWriter();
  std::vector<std::uint8_t> Write(const cv::Mat1b& grey);

 private:
  struct State;
  std::unique_ptr<State> state_;
  int quality_;
  bool colour_;
  std::vector<std::uint8_t> chroma_;
};

}  // namespace rift::vision
