#include "jpeg_rows.hpp"

// jpeglib.h uses FILE and size_t without including them.
#include <cstddef>
#include <cstdio>
// After those.
#include <jpeglib.h>

#include <array>
#include <cassert>
#include <cstdlib>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace rift::vision {
namespace {

constexpr int kBlock_px = 8;
constexpr int kBlocksDown = 2;  // of luma in a row, where chroma has half its lines
constexpr std::uint8_t kMarker = 0xFF;
constexpr std::uint8_t kStartOfFrame = 0xC0;
constexpr std::uint8_t kFirstRestart = 0xD0;
constexpr std::uint8_t kEndOfPicture = 0xD9;
constexpr std::uint8_t kStartOfScan = 0xDA;
constexpr int kRestarts = 8;
constexpr std::uint8_t kEvenChroma = 128;

// All that is given to libjpeg was checked before, so an error is a bug of ours or no memory.
void Throw(j_common_ptr info) {
  std::array<char, JMSG_LENGTH_MAX> text{};
  info->err->format_message(info, text.data());
  throw std::runtime_error(text.data());
}

/// Where the segment that begins with FF `marker` starts; only headers are looked through.
size_t FindSegment(const std::vector<std::uint8_t>& jpeg, std::uint8_t marker) {
  for (size_t at = 2; at + 4 <= jpeg.size();) {
    assert(jpeg[at] == kMarker);
    if (jpeg[at + 1] == marker) return at;
    at += 2 + 256U * jpeg[at + 2] + jpeg[at + 3];
  }
  throw std::logic_error("a JPEG without one of its segments");
}

size_t EndOfHeader(const std::vector<std::uint8_t>& jpeg) {
  const size_t scan = FindSegment(jpeg, kStartOfScan);
  return scan + 2 + 256U * jpeg[scan + 2] + jpeg[scan + 3];
}

/// What lies between restart markers, until the end of the picture.
std::vector<JpegRows::Row> Split(const std::vector<std::uint8_t>& jpeg, size_t from) {
  std::vector<JpegRows::Row> rows;
  const auto pointer = [&](size_t at) { return jpeg.data() + at; };
  for (size_t at = from; at + 1 < jpeg.size(); ++at) {
    const void* found = std::memchr(pointer(at), kMarker, jpeg.size() - 1 - at);
    assert(found != nullptr);
    at = static_cast<size_t>(static_cast<const std::uint8_t*>(found) - jpeg.data());
    const std::uint8_t code = jpeg[at + 1];
    const bool is_restart = code >= kFirstRestart && code < kFirstRestart + kRestarts;
    if (!is_restart && code != kEndOfPicture) continue;  // a stuffed FF of the data
    rows.emplace_back(pointer(from), pointer(at));
    from = at + 2;
    if (code == kEndOfPicture) break;
  }
  return rows;
}

}  // namespace

struct JpegRows::State {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  int width_px = 0;
  bool colour = false;
  int quality = 0;
  unsigned char* buffer = nullptr;
  unsigned long capacity = 0;
  std::vector<std::uint8_t> chroma;
  std::vector<std::uint8_t> header;

  void Configure(int height_px);
  void WriteBlocks(const cv::Mat1b& padded);
  std::vector<std::uint8_t> Compress(const cv::Mat1b& padded, int height_px);
};

void JpegRows::State::Configure(int height_px) {
  info.image_width = static_cast<JDIMENSION>(width_px);
  info.image_height = static_cast<JDIMENSION>(height_px);
  info.input_components = colour ? 3 : 1;
  info.in_color_space = colour ? JCS_YCbCr : JCS_GRAYSCALE;
  jpeg_set_defaults(&info);  // 4:2:0 where there is colour
  jpeg_set_quality(&info, quality, TRUE);
  info.raw_data_in = TRUE;
  info.restart_in_rows = 1;
}

void JpegRows::State::WriteBlocks(const cv::Mat1b& padded) {
  const int lines = colour ? kBlocksDown * kBlock_px : kBlock_px;
  std::vector<JSAMPROW> luma(lines), grey(kBlock_px, chroma.data());
  std::array<JSAMPARRAY, 3> planes{luma.data(), grey.data(), grey.data()};
  for (int y = 0; y < padded.rows; y += lines) {
    for (int i = 0; i < lines; ++i) luma[i] = const_cast<JSAMPROW>(padded[y + i]);
    jpeg_write_raw_data(&info, planes.data(), static_cast<JDIMENSION>(lines));
  }
}

std::vector<std::uint8_t> JpegRows::State::Compress(const cv::Mat1b& padded, int height_px) {
  unsigned char* out = buffer;
  unsigned long size = capacity;
  jpeg_mem_dest(&info, &out, &size);
  Configure(height_px);
  jpeg_start_compress(&info, TRUE);
  WriteBlocks(padded);
  jpeg_finish_compress(&info);
  std::vector<std::uint8_t> jpeg(out, out + size);
  if (out != buffer) {  // it took a larger one and leaves the old one to us
    std::free(buffer);
    buffer = out;
    capacity = size;
  }
  return jpeg;
}

JpegRows::JpegRows(int width_px, int height_px, int quality, bool colour)
    : state_(std::make_unique<State>()),
      height_px_(height_px),
      row_height_px_(colour ? kBlocksDown * kBlock_px : kBlock_px) {
  State& state = *state_;
  state.width_px = width_px;
  state.colour = colour;
  state.quality = quality;
  state.chroma.assign(static_cast<size_t>(width_px) + 2 * kBlock_px, kEvenChroma);
  state.info.err = jpeg_std_error(&state.errors);
  state.errors.error_exit = Throw;
  jpeg_create_compress(&state.info);
}

JpegRows::~JpegRows() {
  jpeg_destroy_compress(&state_->info);
  std::free(state_->buffer);
}

std::vector<JpegRows::Row> JpegRows::Encode(const cv::Mat1b& strip) {
  const auto missing = [&](int size) {
    return (row_height_px_ - size % row_height_px_) % row_height_px_;
  };
  cv::Mat1b padded;
  cv::copyMakeBorder(strip, padded, 0, missing(strip.rows), 0, missing(strip.cols),
                     cv::BORDER_REPLICATE);
  const std::vector<std::uint8_t> jpeg = state_->Compress(padded, strip.rows);
  const size_t body = EndOfHeader(jpeg);
  if (state_->header.empty()) {
    state_->header.assign(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(body));
    // The height of the whole picture stands behind length and precision.
    const size_t at = FindSegment(jpeg, kStartOfFrame) + 5;
    state_->header[at] = static_cast<std::uint8_t>(height_px_ >> 8);
    state_->header[at + 1] = static_cast<std::uint8_t>(height_px_ & 0xFF);
  }
  return Split(jpeg, body);
}

std::vector<std::uint8_t> JpegRows::Join(const std::vector<const Row*>& rows) const {
  assert(!state_->header.empty() && static_cast<int>(rows.size()) == Count());
  size_t size = state_->header.size();
  for (const Row* row : rows) size += row->size() + 2;
  std::vector<std::uint8_t> jpeg;
  jpeg.reserve(size);
  jpeg = state_->header;
  for (size_t i = 0; i < rows.size(); ++i) {
    jpeg.insert(jpeg.end(), rows[i]->begin(), rows[i]->end());
    const bool is_last = i + 1 == rows.size();
    jpeg.push_back(kMarker);
    jpeg.push_back(is_last ? kEndOfPicture
                           : static_cast<std::uint8_t>(kFirstRestart + i % kRestarts));
  }
  return jpeg;
}

}  // namespace rift::vision
