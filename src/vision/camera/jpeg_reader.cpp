#include "jpeg_reader.hpp"

// jpeglib.h uses FILE and size_t without including them.
#include <cstddef>
#include <cstdio>
// After those.
#include <jerror.h>
#include <jpeglib.h>

#include <csetjmp>
#include <cstring>

namespace rift::vision {
namespace {

struct Errors {
  jpeg_error_mgr manager;  ///< first, so that libjpeg's pointer to it is a pointer to this
  std::jmp_buf escape;
  bool damaged = false;
};

void Escape(j_common_ptr info) { std::longjmp(reinterpret_cast<Errors*>(info->err)->escape, 1); }

/// A level below zero is a warning: the data are corrupt, and libjpeg goes on with grey blocks.
/// Many webcams put stray bytes before a marker, which costs nothing.
void NoteDamage(j_common_ptr info, int level) {
  if (level < 0 && info->err->msg_code != JWRN_EXTRANEOUS_DATA) {
    reinterpret_cast<Errors*>(info->err)->damaged = true;
  }
}

}  // namespace

struct JpegReader::State {
  jpeg_decompress_struct info{};
  Errors errors{};
  std::vector<std::uint8_t> rows;

  bool ReadHeader(const std::vector<std::uint8_t>& bytes, int width_px, int height_px);
  /// Fills `rows` with the region's lines, each from `left` on, `stride` wide.
  bool ReadRows(const Region& region, JDIMENSION* left, JDIMENSION* stride);
  bool Read(const std::vector<std::uint8_t>& bytes, int width_px, int height_px,
            const Region& region, JDIMENSION* left, JDIMENSION* stride);
};

bool JpegReader::State::ReadHeader(const std::vector<std::uint8_t>& bytes, int width_px,
                                   int height_px) {
  jpeg_mem_src(&info, bytes.data(), bytes.size());
  jpeg_read_header(&info, TRUE);
  return static_cast<int>(info.image_width) == width_px &&
         static_cast<int>(info.image_height) == height_px;
}

bool JpegReader::State::ReadRows(const Region& region, JDIMENSION* left, JDIMENSION* stride) {
  info.out_color_space = JCS_GRAYSCALE;
  jpeg_start_decompress(&info);
  *left = static_cast<JDIMENSION>(region.x_px);
  *stride = static_cast<JDIMENSION>(region.width_px);
  if (*stride < info.output_width) jpeg_crop_scanline(&info, left, stride);
  if (region.y_px > 0) jpeg_skip_scanlines(&info, static_cast<JDIMENSION>(region.y_px));
  rows.resize(static_cast<std::size_t>(*stride) * region.height_px);
  for (int y = 0; y < region.height_px; ++y) {
    JSAMPROW row = rows.data() + static_cast<std::size_t>(y) * *stride;
    if (jpeg_read_scanlines(&info, &row, 1) != 1) return false;
  }
  return !errors.damaged;
}

/// Between setjmp and any longjmp no object is made that has a destructor.
bool JpegReader::State::Read(const std::vector<std::uint8_t>& bytes, int width_px, int height_px,
                             const Region& region, JDIMENSION* left, JDIMENSION* stride) {
  errors.damaged = false;
  if (setjmp(errors.escape) != 0) {
    jpeg_abort_decompress(&info);
    return false;
  }
  const bool whole = ReadHeader(bytes, width_px, height_px) && ReadRows(region, left, stride);
  jpeg_abort_decompress(&info);
  return whole;
}

JpegReader::JpegReader() : state_(std::make_unique<State>()) {
  state_->info.err = jpeg_std_error(&state_->errors.manager);
  state_->errors.manager.error_exit = Escape;
  state_->errors.manager.emit_message = NoteDamage;
  jpeg_create_decompress(&state_->info);
}

JpegReader::~JpegReader() { jpeg_destroy_decompress(&state_->info); }

std::optional<GreyPatch> JpegReader::Read(const std::vector<std::uint8_t>& bytes, int width_px,
                                          int height_px, const Region& region) {
  if (bytes.empty() || region.empty()) return std::nullopt;
  JDIMENSION left = 0;
  JDIMENSION stride = 0;
  if (!state_->Read(bytes, width_px, height_px, region, &left, &stride)) return std::nullopt;
  GreyPatch patch{region, {}};
  if (static_cast<int>(stride) == region.width_px) {
    patch.pixels.swap(state_->rows);
    return patch;
  }
  // Cropping starts at a whole block of the JPEG, up to 15 pixels further left.
  patch.pixels.resize(static_cast<std::size_t>(region.width_px) * region.height_px);
  const std::size_t shift = static_cast<std::size_t>(region.x_px) - left;
  for (int y = 0; y < region.height_px; ++y) {
    std::memcpy(&patch.pixels[static_cast<std::size_t>(y) * region.width_px],
                &state_->rows[static_cast<std::size_t>(y) * stride + shift], region.width_px);
  }
  return patch;
}

}  // namespace rift::vision
