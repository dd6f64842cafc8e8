#include "jpeg_writer.hpp"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <array>
#include <stdexcept>

namespace rift::vision {

struct JpegWriter::State {
  tjhandle handle = tjInitCompress();
  unsigned char* buffer = nullptr;
  unsigned long capacity = 0;

  ~State() {
    tjFree(buffer);
    if (handle != nullptr) tjDestroy(handle);
  }
};

JpegWriter::JpegWriter(int quality, bool colour)
    : state_(std::make_unique<State>()), quality_(quality), colour_(colour) {}

JpegWriter::~JpegWriter() = default;

std::vector<std::uint8_t> JpegWriter::Write(const cv::Mat1b& grey) {
  const int form = colour_ ? TJSAMP_420 : TJSAMP_GRAY;
  const int chroma_width = (grey.cols + 1) / 2;
  if (colour_) chroma_.assign(static_cast<std::size_t>(chroma_width) * ((grey.rows + 1) / 2), 128);
  const std::array<const unsigned char*, 3> planes{grey.data, chroma_.data(), chroma_.data()};
  const std::array<int, 3> strides{static_cast<int>(grey.step), chroma_width, chroma_width};
  unsigned long size = state_->capacity;
  const int failed = tjCompressFromYUVPlanes(
      state_->handle, const_cast<const unsigned char**>(planes.data()), grey.cols, strides.data(),
      grey.rows, form, &state_->buffer, &size, quality_, 0);
  if (failed != 0) {
    throw std::runtime_error(fmt::format("a picture of {} x {} does not compress: {}", grey.cols,
                                         grey.rows, tjGetErrorStr2(state_->handle)));
  }
  // The buffer grows as needed, and what it grew to is at least this.
  state_->capacity = std::max(state_->capacity, size);
  return {state_->buffer, state_->buffer + size};
}

}  // namespace rift::vision
