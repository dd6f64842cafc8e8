#include "rift/vision/camera/jpeg.hpp"

// jpeglib.h uses FILE and size_t without including them.
#include <cstddef>
#include <cstdio>
// After those.
#include <jerror.h>
#include <jpeglib.h>
#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>
#include <stdexcept>

namespace rift::vision {
namespace {

constexpr std::uint8_t kMark = 0xFF, kStart = 0xD8, kEnd = 0xD9, kScan = 0xDA;

// Frame headers are C0..CF but for C4 (Huffman tables), C8 (reserved) and CC (arithmetic tables).
bool IsFrameHeader(std::uint8_t marker) {
  return (marker & 0xF0) == 0xC0 && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

int Number(std::span<const std::uint8_t> bytes, std::size_t at) {
  return bytes[at] << 8 | bytes[at + 1];
}

bool IsJpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 4 && bytes[0] == kMark && bytes[1] == kStart;
}

/// Visits the segments up to the scan, whose lengths tell where the next one is, so that thumbnails
/// inside them are jumped over. Markers are found as libjpeg's next_marker finds them, so that it
/// sees no other frame header: what stands between segments is skipped, and TEM and RST have no
/// length (ITU T.81 B.1.1.3).
template <class Visit>
std::size_t WalkSegments(std::span<const std::uint8_t> bytes, Visit&& visit) {
  constexpr std::uint8_t kTemporary = 0x01, kRestart = 0xD0, kLastRestart = 0xD7;
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    const std::uint8_t marker = bytes[at + 1];
    const bool is_restart = marker >= kRestart && marker <= kLastRestart;
    if (bytes[at] != kMark || marker == 0 || marker == kMark) {
      ++at;
    } else if (marker == kTemporary || is_restart) {
      at += 2;
    } else if (marker == kStart || marker == kEnd) {
      break;
    } else {
      visit(marker, at);
      at += 2 + static_cast<std::size_t>(Number(bytes, at + 2));
      if (marker == kScan) break;
    }
  }
  return at;
}

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

/// A progressive picture has some ten scans. Each costs a pass over the whole picture, and a few
/// bytes of a file.
void EscapeFromScans(j_common_ptr info) {
  constexpr int kMostScans = 100;
  if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number > kMostScans) Escape(info);
}

}  // namespace

std::optional<JpegSize> SizeOfJpeg(std::span<const std::uint8_t> bytes) {
  std::optional<JpegSize> size;
  if (!IsJpeg(bytes)) return size;
  WalkSegments(bytes, [&](std::uint8_t marker, std::size_t at) {
    if (!IsFrameHeader(marker) || at + 9 > bytes.size()) return;
    size = JpegSize{Number(bytes, at + 7), Number(bytes, at + 5)};
  });
  return size;
}

std::span<const std::uint8_t> ExifOfJpeg(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kApplication1 = 0xE1;
  constexpr std::array<std::uint8_t, 6> kName{'E', 'x', 'i', 'f', 0, 0};
  std::span<const std::uint8_t> found;
  if (!IsJpeg(bytes)) return found;
  WalkSegments(bytes, [&](std::uint8_t marker, std::size_t at) {
    const std::size_t end = std::min(bytes.size(), at + 2 + Number(bytes, at + 2));
    const std::size_t begin = at + 4 + kName.size();
    if (!found.empty() || marker != kApplication1 || begin > end) return;
    if (!std::equal(kName.begin(), kName.end(), bytes.begin() + at + 4)) return;
    found = bytes.subspan(begin, end - begin);
  });
  return found;
}

std::size_t JpegLength(std::span<const std::uint8_t> bytes) {
  if (!IsJpeg(bytes)) return bytes.size();
  for (std::size_t at = WalkSegments(bytes, [](auto...) {}); at + 1 < bytes.size(); ++at) {
    if (bytes[at] == kMark && bytes[at + 1] == kEnd) return at + 2;
  }
  return bytes.size();
}

/// libjpeg's own interface: TurboJPEG's has no way to read a part of a picture.
struct JpegReader::State {
  jpeg_decompress_struct info{};
  Errors errors{};
  jpeg_progress_mgr progress{};
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
  state_->progress.progress_monitor = EscapeFromScans;
  state_->info.progress = &state_->progress;
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

cv::Mat DecodeJpeg(std::span<const std::uint8_t> bytes, bool colour, int eighths) {
  const std::unique_ptr<void, decltype(&tjDestroy)> decoder(tjInitDecompress(), tjDestroy);
  int width = 0, height = 0, subsampling = 0, colours = 0;
  const std::optional<JpegSize> checked = SizeOfJpeg(bytes);  // by those who ask for the picture
  if (!checked ||
      tjDecompressHeader3(decoder.get(), bytes.data(), bytes.size(), &width, &height, &subsampling,
                          &colours) != 0 ||
      width != checked->width_px || height != checked->height_px) {
    return {};
  }
  const tjscalingfactor factor{eighths, 8};
  cv::Mat picture(TJSCALED(height, factor), TJSCALED(width, factor), colour ? CV_8UC3 : CV_8UC1);
  const int failed = tjDecompress2(decoder.get(), bytes.data(), bytes.size(), picture.data,
                                   picture.cols, static_cast<int>(picture.step), picture.rows,
                                   colour ? TJPF_BGR : TJPF_GRAY, TJFLAG_LIMITSCANS);
  const bool is_usable = failed == 0 || tjGetErrorCode(decoder.get()) == TJERR_WARNING;
  return is_usable ? picture : cv::Mat();
}

std::vector<std::uint8_t> WriteJpeg(const cv::Mat1b& picture, int quality, bool colour) {
  constexpr std::uint8_t kNeutralChroma = 128;
  // 4:2:0 halves an even width and height.
  cv::Mat1b luma;
  cv::copyMakeBorder(picture, luma, 0, picture.rows % 2, 0, picture.cols % 2, cv::BORDER_REPLICATE);
  const cv::Mat1b chroma(luma.rows / 2, luma.cols / 2, kNeutralChroma);
  std::array<const unsigned char*, 3> planes{luma.data, chroma.data, chroma.data};
  const std::array<int, 3> strides{luma.cols, chroma.cols, chroma.cols};
  const std::unique_ptr<void, decltype(&tjDestroy)> encoder(tjInitCompress(), tjDestroy);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int failed = tjCompressFromYUVPlanes(
      encoder.get(), planes.data(), picture.cols, strides.data(), picture.rows,
      colour ? TJSAMP_420 : TJSAMP_GRAY, &bytes, &size, quality, 0);
  const std::unique_ptr<unsigned char, decltype(&tjFree)> owner(bytes, tjFree);
  if (failed != 0) throw std::runtime_error(tjGetErrorStr2(encoder.get()));
  return {bytes, bytes + size};
}

}  // namespace rift::vision
