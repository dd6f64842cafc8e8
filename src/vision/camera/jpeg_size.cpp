#include "jpeg_size.hpp"

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

// Segments have a length each up to the scan, so that thumbnails inside them are jumped over.
template <class Visit>
std::size_t WalkSegments(std::span<const std::uint8_t> bytes, Visit&& visit) {
  std::size_t at = 2;
  while (at + 4 <= bytes.size() && bytes[at] == kMark) {
    const std::uint8_t marker = bytes[at + 1];
    if (marker == kMark) {  // a fill byte
      ++at;
      continue;
    }
    visit(marker, at);
    at += 2 + static_cast<std::size_t>(Number(bytes, at + 2));
    if (marker == kScan) break;
  }
  return at;
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

std::size_t JpegLength(std::span<const std::uint8_t> bytes) {
  if (!IsJpeg(bytes)) return bytes.size();
  for (std::size_t at = WalkSegments(bytes, [](auto...) {}); at + 1 < bytes.size(); ++at) {
    if (bytes[at] == kMark && bytes[at + 1] == kEnd) return at + 2;
  }
  return bytes.size();
}

}  // namespace rift::vision
